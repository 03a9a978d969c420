#include "tests/robustness/xfem/full_system.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "common/geometry/polygon.hpp"

namespace growth_walks {

using namespace xfem;

namespace {

/// One dof's row: internal minus external forces, the external ones, the diagonal entry, the sum of |K_ij x_j|.
struct Rows {
  explicit Rows(Eigen::Index size)
      : unbalanced(Eigen::VectorXd::Zero(size)),
        external(Eigen::VectorXd::Zero(size)),
        diagonal(Eigen::VectorXd::Zero(size)),
        terms(Eigen::VectorXd::Zero(size)) {}
  Eigen::VectorXd unbalanced, external, diagonal, terms;
};

void add_part(Rows& rows, const Eigen::Matrix3d& d, double area, std::span<const Shape> shapes,
              const Eigen::VectorXd& x) {
  Eigen::Vector3d strain = Eigen::Vector3d::Zero();
  Eigen::Vector3d absolute = Eigen::Vector3d::Zero();
  for (const Shape& shape : shapes) {
    const double u = x[shape.row], v = x[shape.row + 1];
    const double gx = shape.gradient.x(), gy = shape.gradient.y();
    strain += Eigen::Vector3d(gx * u, gy * v, gy * u + gx * v);
    absolute += Eigen::Vector3d(std::abs(gx * u), std::abs(gy * v), std::abs(gy * u) + std::abs(gx * v));
  }
  const Eigen::Vector3d stress = d * strain;
  const Eigen::Vector3d terms = d * absolute;
  for (const Shape& shape : shapes) {
    const double gx = shape.gradient.x(), gy = shape.gradient.y();
    const Vec2 force = area * Vec2(gx * stress[0] + gy * stress[2], gy * stress[1] + gx * stress[2]);
    rows.unbalanced.segment<2>(shape.row) += force;
    rows.terms[shape.row] += area * (std::abs(gx) * terms[0] + std::abs(gy) * terms[2]);
    rows.terms[shape.row + 1] += area * (std::abs(gy) * terms[1] + std::abs(gx) * terms[2]);
    rows.diagonal[shape.row] += area * (gx * gx * d(0, 0) + gy * gy * d(2, 2));
    rows.diagonal[shape.row + 1] += area * (gy * gy * d(1, 1) + gx * gx * d(2, 2));
  }
}

}  // namespace

void for_each_part(const IntactModel& model, const Enrichment& enrichment,
                   const std::function<void(double, std::span<const Shape>)>& visit) {
  const Mesh& mesh = model.mesh();
  std::vector<const CutElement*> cut(mesh.triangles.size(), nullptr);
  for (const CutElement& element : enrichment.cut) cut[element.element] = &element;
  std::vector<Shape> shapes;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& gradient = model.gradients()[t].gradient;
    const std::size_t parts = cut[t] != nullptr ? cut[t]->parts.size() : 1;
    for (std::size_t p = 0; p < parts; ++p) {
      shapes.clear();
      for (int k = 0; k < 3; ++k) shapes.push_back({gradient[k], 2 * static_cast<Eigen::Index>(mesh.triangles[t][k])});
      if (cut[t] != nullptr) {
        for (const CutElement::Term& term : cut[t]->terms) {
          const double jump = enrichment.jump(term, cut[t]->parts[p]);
          if (jump != 0) shapes.push_back({jump * gradient[term.local], model.dofs() + 2 * term.function});
        }
      }
      visit(cut[t] != nullptr ? cut[t]->parts[p].area : mesh.areas[t], shapes);
    }
  }
}

Residual residual_of(const IntactModel& model, std::span<const Load> loads, double patch,
                     const common::Polygon& outline, const CrackedState& state) {
  const Mesh& mesh = model.mesh();
  const Enrichment& enrichment = state.enrichment;
  const Eigen::Index standard = model.dofs();
  Eigen::VectorXd x(standard + state.q.size());
  x << state.u, state.q;
  Rows rows(x.size());
  rows.external << model.nodal_forces(loads, patch), EdgeLoads(model, loads, patch).forces(enrichment);
  rows.unbalanced = -rows.external;

  const Eigen::Matrix3d d = model.constants().matrix();
  for_each_part(model, enrichment,
                [&](double area, std::span<const Shape> shapes) { add_part(rows, d, area, shapes, x); });
  const double penalty = kFacePenalty * model.constants().young_modulus / mesh.size;
  const std::vector<FaceSegment> faces = face_segments(mesh, model.gradients(), enrichment);
  /// Adds a traction on a face against its opening or slip, and the stiffness that it comes from.
  const auto add_traction = [&](const FaceSegment& face, const Vec2& direction, double traction) {
    double terms = 0;
    for (const auto& [function, weight] : face.jumps) {
      terms += std::abs(weight) * state.q.segment<2>(2 * function).cwiseAbs().dot(direction.cwiseAbs());
    }
    for (const auto& [function, weight] : face.jumps) {
      const Vec2 lever = face.length * weight * direction;
      const Eigen::Index row = standard + 2 * function;
      rows.unbalanced.segment<2>(row) += traction * lever;
      rows.terms.segment<2>(row) += penalty * terms * lever.cwiseAbs();
      rows.diagonal.segment<2>(row) += penalty * weight * lever.cwiseProduct(direction);
    }
  };
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const double overlap = std::min(0.0, opening(faces[i], state.q));
    if (overlap == 0) continue;
    add_traction(faces[i], faces[i].normal, penalty * overlap);
    if (state.face_shear.empty()) continue;
    add_traction(faces[i], Vec2(faces[i].normal.y(), -faces[i].normal.x()), state.face_shear[i]);
  }

  Residual residual;
  double largest = 0, force = 0, terms = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double scale = 1 / std::sqrt(rows.diagonal[i]);
    largest = std::max(largest, scale * std::abs(rows.unbalanced[i]));
    force = std::max(force, scale * std::abs(rows.external[i]));
    terms = std::max(terms, scale * rows.terms[i]);
    residual.is_finite =
        residual.is_finite && std::isfinite(x[i]) && std::isfinite(rows.unbalanced[i]) && rows.diagonal[i] > 0;
  }
  residual.scaled = largest / (force + terms);
  residual.over_load = largest / force;
  residual.amplification = 1 + terms / force;
  const Stress mean = mean_stress(mesh, state.stress);
  const Stress virial = virial_stress(loads, outline, patch);
  double sum = 0;
  for (const Load& load : loads) sum += load.force.norm();
  const double unit = sum * common::diameter(outline) / common::area(outline);
  residual.virial =
      std::max({std::abs(mean.xx - virial.xx), std::abs(mean.yy - virial.yy), std::abs(mean.xy - virial.xy)}) / unit;
  residual.is_finite = residual.is_finite && std::isfinite(residual.virial);
  return residual;
}

Eigen::SparseMatrix<double> scaled_stiffness(const IntactModel& model, const Enrichment& enrichment) {
  const Eigen::Index size = model.dofs() + 2 * static_cast<Eigen::Index>(enrichment.functions.size());
  const Eigen::Matrix3d d = model.constants().matrix();
  std::vector<Eigen::Triplet<double>> entries;
  for_each_part(model, enrichment, [&](double area, std::span<const Shape> shapes) {
    const auto strain = [](const Shape& shape) {
      Eigen::Matrix<double, 3, 2> b;
      b << shape.gradient.x(), 0, 0, shape.gradient.y(), shape.gradient.y(), shape.gradient.x();
      return b;
    };
    for (const Shape& i : shapes) {
      for (const Shape& j : shapes) {
        const Eigen::Matrix2d block = area * strain(i).transpose() * d * strain(j);
        for (int a = 0; a < 2; ++a) {
          for (int b = 0; b < 2; ++b) entries.emplace_back(i.row + a, j.row + b, block(a, b));
        }
      }
    }
  });
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * matrix * scale.asDiagonal();
}

double smallest_eigenvalue(const IntactModel& model, const Enrichment& enrichment) {
  Eigen::SparseMatrix<double> matrix = scaled_stiffness(model, enrichment);
  std::vector<bool> held(matrix.rows(), false);
  for (const int dof : model.fixed_dofs()) held[dof] = true;
  matrix.prune(
      [&](Eigen::Index row, Eigen::Index column, double) { return row == column || (!held[row] && !held[column]); });
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  if (factor.info() != Eigen::Success) return 0;
  // Inverse iteration; held dofs and what is unrelated to the weakest motion fade out.
  Eigen::VectorXd x(matrix.rows());
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = held[i] ? 0.0 : 1.0 + 0.1 * static_cast<double>(i % 7);
  double smallest = 0;
  for (int iteration = 0; iteration < 4; ++iteration) {
    x /= x.norm();
    x = factor.solve(x);
    smallest = 1 / x.norm();
  }
  return smallest;
}

}  // namespace growth_walks
