#include "xfem/elasticity/factor.hpp"

#include <amd.h>

#include <algorithm>
#include <string>

#include "common/error.hpp"

namespace xfem {
namespace {

using Block = std::array<double, 4>;  // row by row

/// Neighbours of every node, ascending, without the node itself.
struct Graph {
  std::vector<int> start, neighbour;

  explicit Graph(const Mesh& mesh) {
    const int nodes = static_cast<int>(mesh.nodes.size());
    neighbour.reserve(7 * mesh.nodes.size());
    start.reserve(mesh.nodes.size() + 1);
    start.push_back(0);
    for (int node = 0; node < nodes; ++node) {
      for (int j = mesh.element_offset[node]; j < mesh.element_offset[node + 1]; ++j) {
        for (const int other : mesh.triangles[mesh.node_elements[j]]) {
          if (other != node) neighbour.push_back(other);
        }
      }
      const auto first = neighbour.begin() + start.back();
      std::sort(first, neighbour.end());
      neighbour.erase(std::unique(first, neighbour.end()), neighbour.end());
      start.push_back(static_cast<int>(neighbour.size()));
    }
  }
};

/// Where the blocks of L stand, in ranks (positions in the order of elimination).
struct Pattern {
  std::vector<int> start, row;

  Pattern(const Graph& graph, const std::vector<int>& node, const std::vector<int>& rank) {
    const int n = static_cast<int>(node.size());
    std::vector<int> mark(n, -1), first_child(n, -1), sibling(n, -1);
    start.push_back(0);
    for (int j = 0; j < n; ++j) {
      const auto add = [&](int i) {
        if (i <= j || mark[i] == j) return;
        mark[i] = j;
        row.push_back(i);
      };
      for (int k = graph.start[node[j]]; k < graph.start[node[j] + 1]; ++k) add(rank[graph.neighbour[k]]);
      for (int child = first_child[j]; child >= 0; child = sibling[child]) {
        for (int k = start[child]; k < start[child + 1]; ++k) add(row[k]);
      }
      std::sort(row.begin() + start[j], row.end());
      start.push_back(static_cast<int>(row.size()));
      if (start[j] == start[j + 1]) continue;
      const int parent = row[start[j]];
      sibling[j] = first_child[parent];
      first_child[parent] = j;
    }
  }
};

/// a -= b c.
void subtract_product(Block& a, const double* b, const Block& c) {
  a[0] -= b[0] * c[0] + b[1] * c[2];
  a[1] -= b[0] * c[1] + b[1] * c[3];
  a[2] -= b[2] * c[0] + b[3] * c[2];
  a[3] -= b[2] * c[1] + b[3] * c[3];
}

}  // namespace

Factor::Factor(const Mesh& mesh, const std::vector<ElementGradients>& gradients, const Eigen::Matrix3d& elasticity,
               const std::array<int, 3>& fixed_dofs)
    : fixed_dofs_(fixed_dofs), node_(mesh.nodes.size()) {
  const int n = static_cast<int>(node_.size());
  const Graph graph(mesh);
  if (amd_order(n, graph.start.data(), graph.neighbour.data(), node_.data(), nullptr, nullptr) < AMD_OK) {
    throw common::numerical_failure("elasticity: the " + std::to_string(n) + " nodes could not be ordered");
  }
  std::vector<int> rank(n);
  for (int j = 0; j < n; ++j) rank[node_[j]] = j;
  Pattern pattern(graph, node_, rank);
  std::vector<double> is_free(2 * static_cast<std::size_t>(n), 1.0);
  for (const int dof : fixed_dofs) is_free[dof] = 0;

  value_.resize(4 * pattern.row.size());
  inverse_.resize(4 * static_cast<std::size_t>(n));
  std::vector<Block> work(n, Block{}), pivot(n);
  // For every column the next of its rows, and for every row the columns that have it next.
  std::vector<int> next(pattern.start.begin(), pattern.start.end() - 1), first_with(n, -1), other_with(n, -1);
  const double d00 = elasticity(0, 0), d01 = elasticity(0, 1), d11 = elasticity(1, 1), d22 = elasticity(2, 2);
  for (int j = 0; j < n; ++j) {
    const int node = node_[j];
    for (int e = mesh.element_offset[node]; e < mesh.element_offset[node + 1]; ++e) {
      const int t = mesh.node_elements[e];
      const auto& triangle = mesh.triangles[t];
      const auto& gradient = gradients[t].gradient;
      const int local = triangle[0] == node ? 0 : triangle[1] == node ? 1 : 2;
      const double gx = mesh.areas[t] * gradient[local].x(), gy = mesh.areas[t] * gradient[local].y();
      for (int k = 0; k < 3; ++k) {
        const int i = rank[triangle[k]];
        if (i < j) continue;
        const double x = gradient[k].x(), y = gradient[k].y();
        Block& block = work[i];
        block[0] += d00 * x * gx + d22 * y * gy;
        block[1] += d01 * x * gy + d22 * y * gx;
        block[2] += d01 * y * gx + d22 * x * gy;
        block[3] += d11 * y * gy + d22 * x * gx;
      }
    }
    const double free_x = is_free[2 * node], free_y = is_free[2 * node + 1];
    const auto hold = [&](int i) {
      const double row_x = is_free[2 * node_[i]], row_y = is_free[2 * node_[i] + 1];
      Block& block = work[i];
      block = {block[0] * (row_x * free_x), block[1] * (row_x * free_y), block[2] * (row_y * free_x),
               block[3] * (row_y * free_y)};
    };
    hold(j);
    for (int p = pattern.start[j]; p < pattern.start[j + 1]; ++p) hold(pattern.row[p]);
    work[j][0] += 1 - free_x;
    work[j][3] += 1 - free_y;

    for (int k = first_with[j]; k >= 0;) {
      const int at = next[k];
      const double* l = &value_[4 * static_cast<std::size_t>(at)];
      const Block& d = pivot[k];
      const Block dl{d[0] * l[0] + d[1] * l[1], d[0] * l[2] + d[1] * l[3], d[2] * l[0] + d[3] * l[1],
                     d[2] * l[2] + d[3] * l[3]};  // D L_jk'
      const int end = pattern.start[k + 1];
      for (int p = at; p < end; ++p) {
        subtract_product(work[pattern.row[p]], &value_[4 * static_cast<std::size_t>(p)], dl);
      }
      const int following = other_with[k];
      if (++next[k] < end) {
        const int row = pattern.row[next[k]];
        other_with[k] = first_with[row];
        first_with[row] = k;
      }
      k = following;
    }

    pivot[j] = work[j];
    work[j] = {};
    const Block& d = pivot[j];
    const double determinant = d[0] * d[3] - d[1] * d[2];
    if (!(d[0] > 0 && determinant > 0)) {
      throw common::numerical_failure("elasticity: the stiffness of " + std::to_string(n) +
                                      " nodes is not positive definite at node " + std::to_string(node));
    }
    const Block inverse{d[3] / determinant, -d[1] / determinant, -d[2] / determinant, d[0] / determinant};
    std::copy(inverse.begin(), inverse.end(), inverse_.begin() + 4 * static_cast<std::size_t>(j));
    for (int p = pattern.start[j]; p < pattern.start[j + 1]; ++p) {
      Block& w = work[pattern.row[p]];
      double* l = &value_[4 * static_cast<std::size_t>(p)];
      l[0] = w[0] * inverse[0] + w[1] * inverse[2];
      l[1] = w[0] * inverse[1] + w[1] * inverse[3];
      l[2] = w[2] * inverse[0] + w[3] * inverse[2];
      l[3] = w[2] * inverse[1] + w[3] * inverse[3];
      w = {};
    }
    if (pattern.start[j] < pattern.start[j + 1]) {
      const int row = pattern.row[pattern.start[j]];
      other_with[j] = first_with[row];
      first_with[row] = j;
    }
  }
  column_ = std::move(pattern.start);
  row_ = std::move(pattern.row);
  for (int& row : row_) row = node_[row];
}

template <int Width>
void Factor::solve_side_by_side(double* x) const {
  using Lanes = Eigen::Array<double, Width, 1>;
  const auto of_node = [x](int node, int component) {
    return Eigen::Map<Lanes>(x + (2 * static_cast<std::size_t>(node) + component) * Width);
  };
  const int n = static_cast<int>(node_.size());
  for (const int dof : fixed_dofs_) of_node(dof / 2, dof % 2).setZero();
  for (int j = 0; j < n; ++j) {
    const Lanes u = of_node(node_[j], 0), v = of_node(node_[j], 1);
    if ((u == 0).all() && (v == 0).all()) continue;
    for (int p = column_[j]; p < column_[j + 1]; ++p) {
      const double* l = &value_[4 * static_cast<std::size_t>(p)];
      of_node(row_[p], 0) -= l[0] * u + l[1] * v;
      of_node(row_[p], 1) -= l[2] * u + l[3] * v;
    }
  }
  for (int j = n - 1; j >= 0; --j) {
    const double* d = &inverse_[4 * static_cast<std::size_t>(j)];
    const Lanes a = of_node(node_[j], 0), b = of_node(node_[j], 1);
    Lanes u = d[0] * a + d[1] * b, v = d[2] * a + d[3] * b;
    for (int p = column_[j]; p < column_[j + 1]; ++p) {
      const double* l = &value_[4 * static_cast<std::size_t>(p)];
      const Lanes s = of_node(row_[p], 0), t = of_node(row_[p], 1);
      u -= l[0] * s + l[2] * t;
      v -= l[1] * s + l[3] * t;
    }
    of_node(node_[j], 0) = u;
    of_node(node_[j], 1) = v;
  }
}

template void Factor::solve_side_by_side<1>(double*) const;
template void Factor::solve_side_by_side<2>(double*) const;
template void Factor::solve_side_by_side<4>(double*) const;
template void Factor::solve_side_by_side<8>(double*) const;

Eigen::MatrixXd Factor::solve(const Eigen::MatrixXd& forces) const {
  Eigen::MatrixXd result(forces.rows(), forces.cols());
  std::vector<double> x;
  const auto columns = [&]<int Width>(Eigen::Index first) {
    x.resize(static_cast<std::size_t>(forces.rows()) * Width);
    for (Eigen::Index i = 0; i < forces.rows(); ++i) {
      for (int c = 0; c < Width; ++c) x[i * Width + c] = forces(i, first + c);
    }
    solve_side_by_side<Width>(x.data());
    for (Eigen::Index i = 0; i < forces.rows(); ++i) {
      for (int c = 0; c < Width; ++c) result(i, first + c) = x[i * Width + c];
    }
    return first + Width;
  };
  for (Eigen::Index first = 0; first < forces.cols();) {
    const Eigen::Index left = forces.cols() - first;
    first = left >= 8   ? columns.template operator()<8>(first)
            : left >= 4 ? columns.template operator()<4>(first)
            : left >= 2 ? columns.template operator()<2>(first)
                        : columns.template operator()<1>(first);
  }
  return result;
}

}  // namespace xfem
