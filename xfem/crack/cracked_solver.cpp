#include "xfem/crack/cracked_solver.hpp"

#include <algorithm>
#include <cmath>

#include "xfem/crack/dense_spd.hpp"
#include "xfem/crack/edge_loads.hpp"
#include "xfem/crack/face_contact.hpp"

namespace xfem {
namespace {

/// B_I^T D B_J of two shape functions with the given gradients [Pa/m^2].
Eigen::Matrix2d stiffness_block(const Eigen::Matrix3d& d, const Vec2& i, const Vec2& j) {
  Eigen::Matrix<double, 3, 2> bi, bj;
  bi << i.x(), 0, 0, i.y(), i.y(), i.x();
  bj << j.x(), 0, 0, j.y(), j.y(), j.x();
  return bi.transpose() * (d * bj);
}

}  // namespace

CrackedSolver::CrackedSolver(const IntactModel& model, std::span<const Load> loads, double patch)
    : model_(&model), loads_(loads.begin(), loads.end()), patch_(patch) {
  u0_ = model.solve(model.nodal_forces(loads, patch));
}

CrackedSolver::CrackedSolver(const IntactModel& model, Eigen::VectorXd forces) : model_(&model) {
  u0_ = model.solve(forces);
}

const CrackedSolver::Column& CrackedSolver::column(const EnrichmentFunction& function, std::vector<Block> stiffness) {
  Column& entry = columns_[{function.crack, function.node}];
  if (entry.response[0].size() > 0 && entry.stiffness == stiffness) return entry;
  entry.stiffness = std::move(stiffness);
  for (int component = 0; component < 2; ++component) {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(model_->dofs());
    for (const auto& [node, block] : entry.stiffness) {
      force[2 * node] = block(0, component);
      force[2 * node + 1] = block(1, component);
    }
    entry.response[component] = model_->solve(force);
  }
  return entry;
}

CrackedState CrackedSolver::solve(std::span<const Crack> cracks) {
  const Mesh& mesh = model_->mesh();
  const Eigen::Matrix3d d = model_->constants().matrix();
  CrackedState state;
  state.enrichment = enrich(mesh, cracks);
  const Enrichment& enrichment = state.enrichment;
  const int functions = static_cast<int>(enrichment.functions.size());
  const int size = 2 * functions;
  state.u = u0_;
  state.q = Eigen::VectorXd::Zero(size);
  if (size == 0) {
    state.stress = cracked_stresses(*model_, enrichment, state.u, state.q);
    return state;
  }

  DenseSymmetric schur(size);
  std::vector<std::map<int, Eigen::Matrix2d>> coupling(functions);
  for (const CutElement& element : enrichment.cut) {
    const auto& triangle = mesh.triangles[element.element];
    const auto& gradient = model_->gradients()[element.element].gradient;
    for (const CutElement::Term& f : element.terms) {
      double weight = 0;
      for (const ElementPart& part : element.parts) weight += part.area * enrichment.jump(f, part);
      for (int k = 0; k < 3; ++k) {
        const auto [entry, is_new] = coupling[f.function].emplace(triangle[k], Eigen::Matrix2d::Zero());
        entry->second += weight * stiffness_block(d, gradient[k], gradient[f.local]);
      }
      for (const CutElement::Term& g : element.terms) {
        if (f.function > g.function) continue;
        double both = 0;
        for (const ElementPart& part : element.parts) {
          both += part.area * enrichment.jump(f, part) * enrichment.jump(g, part);
        }
        if (both == 0) continue;
        const Eigen::Matrix2d block = both * stiffness_block(d, gradient[f.local], gradient[g.local]);
        for (int a = 0; a < 2; ++a) {
          for (int b = 0; b < 2; ++b) {
            if (2 * f.function + a <= 2 * g.function + b)
              schur.at(2 * f.function + a, 2 * g.function + b) += block(a, b);
          }
        }
      }
    }
  }

  std::vector<const Column*> columns(functions);
  for (int f = 0; f < functions; ++f) {
    columns[f] = &column(enrichment.functions[f], {coupling[f].begin(), coupling[f].end()});
  }
  Eigen::VectorXd right = enriched_forces(*model_, enrichment, loads_, patch_);
  for (int f = 0; f < functions; ++f) {
    for (int a = 0; a < 2; ++a) {
      const int row = 2 * f + a;
      for (const auto& [node, block] : columns[f]->stiffness) {
        right[row] -= block(0, a) * u0_[2 * node] + block(1, a) * u0_[2 * node + 1];
      }
      for (int column = row; column < size; ++column) {
        const Eigen::VectorXd& response = columns[column / 2]->response[column % 2];
        double sum = 0;
        for (const auto& [node, block] : columns[f]->stiffness) {
          sum += block(0, a) * response[2 * node] + block(1, a) * response[2 * node + 1];
        }
        schur.at(row, column) -= sum;
      }
    }
  }

  const std::vector<FaceSegment> faces = face_segments(mesh, model_->gradients(), enrichment);
  const double penalty = kFacePenalty * model_->constants().young_modulus / mesh.size;
  std::optional<FaceContact> contact = solve_face_contact(schur, right, faces, penalty);
  state.solved = contact.has_value();
  if (contact) {
    state.q = std::move(contact->q);
    state.closed_segments = contact->closed_segments;
  }
  for (int column = 0; column < size; ++column) {
    const Eigen::VectorXd& response = columns[column / 2]->response[column % 2];
    const double factor = state.q[column];
    for (Eigen::Index i = 0; i < state.u.size(); ++i) state.u[i] -= factor * response[i];
  }
  state.stress = cracked_stresses(*model_, enrichment, state.u, state.q);
  return state;
}

Eigen::VectorXd enriched_forces(const IntactModel& model, const Enrichment& enrichment, std::span<const Load> loads,
                                double patch) {
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(2 * static_cast<Eigen::Index>(enrichment.functions.size()));
  if (loads.empty()) return forces;
  const Mesh& mesh = model.mesh();
  const BodyForce body = inertia_relief(mesh, loads, patch);
  for (const CutElement& element : enrichment.cut) {
    const auto& triangle = mesh.triangles[element.element];
    const Vec2 center = mesh.centroid(element.element);
    for (const CutElement::Term& term : element.terms) {
      const Vec2& gradient = model.gradients()[element.element].gradient[term.local];
      Vec2 sum = Vec2::Zero();
      for (const ElementPart& part : element.parts) {
        const double jump = enrichment.jump(term, part);
        if (jump == 0) continue;
        sum += jump * integrate_body_force(part.outline, part.area, gradient, center, body);
      }
      // A load on the cut edge of a mouth: only beyond the mouth, as seen from the function's node, is H - H_J not 0.
      const CrackSegment& segment = enrichment.segments[element.segments[term.slot]];
      for (const CrackPoint* end : {&segment.first, &segment.last}) {
        const int node = triangle[term.local];
        if ((end->edge[0] != node && end->edge[1] != node) || !on_boundary(mesh, *end)) continue;
        const double jump = -2.0 * enrichment.functions[term.function].side;
        sum += jump * force_beyond_mouth(mesh, *end, node, loads, patch);
      }
      forces[2 * term.function] += sum.x();
      forces[2 * term.function + 1] += sum.y();
    }
  }
  return forces;
}

std::vector<Stress> cracked_stresses(const IntactModel& model, const Enrichment& enrichment, const Eigen::VectorXd& u,
                                     const Eigen::VectorXd& q) {
  std::vector<Stress> stress = model.stresses(u);
  const Eigen::Matrix3d d = model.constants().matrix();
  for (const CutElement& element : enrichment.cut) {
    Eigen::Vector3d strain = Eigen::Vector3d::Zero();
    for (const CutElement::Term& term : element.terms) {
      const Vec2& g = model.gradients()[element.element].gradient[term.local];
      double mean = 0;
      for (const ElementPart& part : element.parts) mean += part.area * enrichment.jump(term, part);
      mean /= model.mesh().areas[element.element];
      const double x = mean * q[2 * term.function];
      const double y = mean * q[2 * term.function + 1];
      strain += Eigen::Vector3d(g.x() * x, g.y() * y, g.y() * x + g.x() * y);
    }
    const Eigen::Vector3d tension = d * strain;
    Stress& target = stress[element.element];
    target.xx -= tension[0];
    target.yy -= tension[1];
    target.xy -= tension[2];
  }
  return stress;
}

}  // namespace xfem
