#include "xfem/elasticity/stiffness.hpp"

#include <cholmod.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "common/error.hpp"

namespace xfem {
namespace {

/// Upper triangle of the stiffness without the fixed dofs, compressed columns with ascending rows.
struct UpperTriangle {
  std::vector<int> dof;         ///< reduced -> global
  std::vector<int> start, row;  ///< columns
  std::vector<double> value;
};

UpperTriangle assemble(const Mesh& mesh, const std::vector<ElementGradients>& gradients,
                       const Eigen::Matrix3d& elasticity, const std::array<int, 3>& fixed_dofs) {
  const int nodes = static_cast<int>(mesh.nodes.size());
  UpperTriangle k;
  std::vector<int> reduced(2 * nodes, -1);
  for (int dof = 0; dof < 2 * nodes; ++dof) {
    if (std::find(fixed_dofs.begin(), fixed_dofs.end(), dof) != fixed_dofs.end()) continue;
    reduced[dof] = static_cast<int>(k.dof.size());
    k.dof.push_back(dof);
  }

  k.start.push_back(0);
  std::vector<int> around;
  for (const int dof : k.dof) {
    const int node = dof / 2;
    around.clear();
    for (int j = mesh.element_offset[node]; j < mesh.element_offset[node + 1]; ++j) {
      for (const int other : mesh.triangles[mesh.node_elements[j]]) around.push_back(other);
    }
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    for (const int other : around) {
      for (const int i : {2 * other, 2 * other + 1}) {
        if (i <= dof && reduced[i] >= 0) k.row.push_back(reduced[i]);
      }
    }
    k.start.push_back(static_cast<int>(k.row.size()));
  }

  k.value.assign(k.row.size(), 0.0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Matrix<double, 3, 6> b = strain_matrix(gradients[t]);
    const Eigen::Matrix<double, 3, 6> db = mesh.areas[t] * elasticity * b;
    for (int q = 0; q < 6; ++q) {
      const int column = reduced[2 * mesh.triangles[t][q / 2] + q % 2];
      if (column < 0) continue;
      for (int p = 0; p < 6; ++p) {
        const int row = reduced[2 * mesh.triangles[t][p / 2] + p % 2];
        if (row < 0 || row > column) continue;
        const auto begin = k.row.begin() + k.start[column];
        const auto end = k.row.begin() + k.start[column + 1];
        const auto place = std::lower_bound(begin, end, row) - k.row.begin();
        k.value[place] += b(0, p) * db(0, q) + b(1, p) * db(1, q) + b(2, p) * db(2, q);
      }
    }
  }
  return k;
}

/// Owns CHOLMOD's workspace and factor while the numbers are copied out.
struct Cholmod {
  cholmod_common common;
  cholmod_factor* factor = nullptr;

  Cholmod() {
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SIMPLICIAL;
    common.final_ll = 0;
    common.print = 0;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_AMD;
    common.postorder = 1;
  }
  ~Cholmod() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;
};

/// Solves L D L' x = x for `Width` interleaved right-hand sides. Each column's operations are the same for any width;
/// where all of them are zero, nothing is subtracted, so that a few forces cost only the rows that they reach.
template <int Width>
void substitute(const std::vector<int>& start, const std::vector<int>& row, const std::vector<double>& value,
                const std::vector<double>& pivot, double* x) {
  const int n = static_cast<int>(pivot.size());
  std::array<double, Width> own;  // a local copy, so that the compiler keeps the Width values in one register
  for (int j = 0; j < n; ++j) {
    bool zero = true;
    for (int c = 0; c < Width; ++c) {
      own[c] = x[j * Width + c];
      zero = zero && own[c] == 0;
    }
    if (zero) continue;
    for (int k = start[j]; k < start[j + 1]; ++k) {
      const double l = value[k];
      double* target = x + row[k] * Width;
      for (int c = 0; c < Width; ++c) target[c] -= l * own[c];
    }
  }
  for (int j = n - 1; j >= 0; --j) {
    for (int c = 0; c < Width; ++c) own[c] = x[j * Width + c] / pivot[j];
    for (int k = start[j]; k < start[j + 1]; ++k) {
      const double l = value[k];
      const double* source = x + row[k] * Width;
      for (int c = 0; c < Width; ++c) own[c] -= l * source[c];
    }
    for (int c = 0; c < Width; ++c) x[j * Width + c] = own[c];
  }
}

}  // namespace

std::vector<ElementGradients> element_gradients(const Mesh& mesh) {
  std::vector<ElementGradients> result(mesh.triangles.size());
  for (std::size_t t = 0; t < result.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Vec2 edge = mesh.nodes[mesh.triangles[t][(k + 2) % 3]] - mesh.nodes[mesh.triangles[t][(k + 1) % 3]];
      result[t].gradient[k] = common::perpendicular(edge) / (2 * mesh.areas[t]);
    }
  }
  return result;
}

Eigen::Matrix<double, 3, 6> strain_matrix(const ElementGradients& gradients) {
  Eigen::Matrix<double, 3, 6> b = Eigen::Matrix<double, 3, 6>::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vec2& g = gradients.gradient[k];
    b(0, 2 * k) = g.x();
    b(1, 2 * k + 1) = g.y();
    b(2, 2 * k) = g.y();
    b(2, 2 * k + 1) = g.x();
  }
  return b;
}

std::array<int, 3> determinate_supports(const Mesh& mesh) {
  const std::vector<int> loop = boundary_loop(mesh);
  Vec2 center = Vec2::Zero();
  for (const int node : loop) center += mesh.nodes[node] / static_cast<double>(loop.size());
  const auto farthest = [&](const Vec2& from) {
    // The margin makes equal distances fall on the first node whatever the rounding.
    int result = loop.front();
    double largest = 0;
    for (const int node : loop) {
      const double distance = (mesh.nodes[node] - from).squaredNorm();
      if (distance > largest * (1 + 1e-9)) {
        largest = distance;
        result = node;
      }
    }
    return result;
  };
  const int first = farthest(center);
  const int second = farthest(mesh.nodes[first]);
  const Vec2 line = mesh.nodes[second] - mesh.nodes[first];
  std::array<int, 3> result{2 * first, 2 * first + 1, 2 * second + (std::abs(line.x()) >= std::abs(line.y()) ? 1 : 0)};
  std::sort(result.begin(), result.end());
  return result;
}

Factor::Factor(const Mesh& mesh, const std::vector<ElementGradients>& gradients, const Eigen::Matrix3d& elasticity,
               const std::array<int, 3>& fixed_dofs) {
  UpperTriangle k = assemble(mesh, gradients, elasticity, fixed_dofs);
  const std::size_t n = k.dof.size();
  cholmod_sparse matrix{};
  matrix.nrow = matrix.ncol = n;
  matrix.nzmax = k.row.size();
  matrix.p = k.start.data();
  matrix.i = k.row.data();
  matrix.x = k.value.data();
  matrix.stype = 1;
  matrix.itype = CHOLMOD_INT;
  matrix.xtype = CHOLMOD_REAL;
  matrix.dtype = CHOLMOD_DOUBLE;
  matrix.sorted = 1;
  matrix.packed = 1;

  Cholmod cholmod;
  cholmod.factor = cholmod_analyze(&matrix, &cholmod.common);
  if (cholmod.factor != nullptr) cholmod_factorize(&matrix, cholmod.factor, &cholmod.common);
  const cholmod_factor* factor = cholmod.factor;
  if (factor == nullptr || cholmod.common.status != CHOLMOD_OK || factor->minor != n || factor->is_ll != 0) {
    throw common::numerical_failure("elasticity: the stiffness of " + std::to_string(n) +
                                    " free dofs is not positive definite (CHOLMOD status " +
                                    std::to_string(cholmod.common.status) + ")");
  }
  const int* permutation = static_cast<const int*>(factor->Perm);
  const int* start = static_cast<const int*>(factor->p);
  const int* count = static_cast<const int*>(factor->nz);
  const int* row = static_cast<const int*>(factor->i);
  const double* value = static_cast<const double*>(factor->x);
  column_.push_back(0);
  for (std::size_t j = 0; j < n; ++j) {
    dof_.push_back(k.dof[permutation[j]]);
    pivot_.push_back(value[start[j]]);
    if (!(pivot_.back() > 0)) {
      throw common::numerical_failure("elasticity: pivot " + std::to_string(j) + " of the stiffness is not positive");
    }
    row_.insert(row_.end(), row + start[j] + 1, row + start[j] + count[j]);
    value_.insert(value_.end(), value + start[j] + 1, value + start[j] + count[j]);
    column_.push_back(static_cast<int>(row_.size()));
  }
}

Eigen::MatrixXd Factor::solve(const Eigen::MatrixXd& forces) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(forces.rows(), forces.cols());
  std::vector<double> x(dof_.size() * std::min<Eigen::Index>(4, forces.cols()));
  for (Eigen::Index first = 0; first < forces.cols();) {
    const Eigen::Index left = forces.cols() - first;
    const int width = left >= 4 ? 4 : left >= 2 ? 2 : 1;
    for (std::size_t j = 0; j < dof_.size(); ++j) {
      for (int c = 0; c < width; ++c) x[j * width + c] = forces(dof_[j], first + c);
    }
    if (width == 4) {
      substitute<4>(column_, row_, value_, pivot_, x.data());
    } else if (width == 2) {
      substitute<2>(column_, row_, value_, pivot_, x.data());
    } else {
      substitute<1>(column_, row_, value_, pivot_, x.data());
    }
    for (std::size_t j = 0; j < dof_.size(); ++j) {
      for (int c = 0; c < width; ++c) result(dof_[j], first + c) = x[j * width + c];
    }
    first += width;
  }
  return result;
}

}  // namespace xfem
