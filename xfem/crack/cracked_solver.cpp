#include "xfem/crack/cracked_solver.hpp"

#include <algorithm>
#include <cmath>

#include "xfem/crack/dense_spd.hpp"
#include "xfem/crack/edge_loads.hpp"

namespace xfem {
namespace {

/// Far more than the line search needs: what would still change then are openings of rounding size.
constexpr int kContactIterations = 50;

/// B_I^T D B_J of two shape functions with the given gradients [Pa/m^2].
Eigen::Matrix2d stiffness_block(const Eigen::Matrix3d& d, const Vec2& i, const Vec2& j) {
  Eigen::Matrix<double, 3, 2> bi, bj;
  bi << i.x(), 0, 0, i.y(), i.y(), i.x();
  bj << j.x(), 0, 0, j.y(), j.y(), j.x();
  return bi.transpose() * (d * bj);
}

/// Adds the closed faces' penalty k l v v^T.
void add_penalty(DenseSymmetric& matrix, const FaceSegment& face, double stiffness) {
  for (const auto& [f, wf] : face.jumps) {
    for (const auto& [g, wg] : face.jumps) {
      for (int a = 0; a < 2; ++a) {
        for (int b = 0; b < 2; ++b) {
          const int row = 2 * f + a;
          const int column = 2 * g + b;
          if (row > column) continue;
          matrix.at(row, column) += stiffness * face.length * wf * face.normal[a] * wg * face.normal[b];
        }
      }
    }
  }
}

/// A q for a matrix of which only the upper triangle is stored.
Eigen::VectorXd product(const DenseSymmetric& matrix, const Eigen::VectorXd& q) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(matrix.size);
  for (int i = 0; i < matrix.size; ++i) {
    result[i] += matrix.at(i, i) * q[i];
    for (int j = i + 1; j < matrix.size; ++j) {
      result[i] += matrix.at(i, j) * q[j];
      result[j] += matrix.at(i, j) * q[i];
    }
  }
  return result;
}

double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Where on the way from q to q + step the energy 1/2 q S q - right q + 1/2 k sum l min(0, opening)^2 is least, as a
/// fraction in [0, 1]. Its derivative is piecewise linear and grows; it changes slope where a segment closes or opens.
double least_energy(const DenseSymmetric& schur, const Eigen::VectorXd& right, const std::vector<FaceSegment>& faces,
                    double penalty, const Eigen::VectorXd& q, const Eigen::VectorXd& step) {
  const double constant = dot(step, product(schur, q)) - dot(step, right);
  const double linear = dot(step, product(schur, step));
  std::vector<double> from, rate, bends{1.0};
  for (const FaceSegment& face : faces) {
    from.push_back(opening(face, q));
    rate.push_back(opening(face, step));
    const double bend = rate.back() != 0 ? -from.back() / rate.back() : 0;
    if (bend > 0 && bend < 1) bends.push_back(bend);
  }
  std::sort(bends.begin(), bends.end());
  const auto derivative = [&](double t) {
    double sum = constant + linear * t;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      sum += penalty * faces[i].length * std::min(0.0, from[i] + rate[i] * t) * rate[i];
    }
    return sum;
  };
  double low = 0;
  double at_low = derivative(low);
  for (const double bend : bends) {
    const double at_bend = derivative(bend);
    if (at_bend >= 0) return at_low < 0 ? low + (bend - low) * (at_low / (at_low - at_bend)) : low;
    low = bend;
    at_low = at_bend;
  }
  return 1;
}

/// Enriched dofs under contact of the crack faces; false if the system is singular. Active set: segments that would
/// overlap are closed, closed ones that would open are released. Left alone such a set may run in circles, so each
/// new solution is approached only as far as the energy falls, which ends after finitely many steps.
bool solve_with_contact(const DenseSymmetric& schur, const Eigen::VectorXd& right,
                        const std::vector<FaceSegment>& faces, double penalty, CrackedState& state) {
  const auto overlapping = [&](const Eigen::VectorXd& q) {
    std::vector<bool> closed;
    for (const FaceSegment& face : faces) closed.push_back(opening(face, q) < 0);
    return closed;
  };
  Eigen::VectorXd reached = Eigen::VectorXd::Zero(schur.size);
  std::vector<bool> closed(faces.size(), false);
  for (int iteration = 0; iteration < kContactIterations; ++iteration) {
    DenseSymmetric system = schur;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (closed[i]) add_penalty(system, faces[i], penalty);
    }
    const std::optional<Eigen::VectorXd> q = solve_spd(std::move(system), right);
    if (!q) return false;
    state.q = *q;
    state.closed_segments = static_cast<int>(std::count(closed.begin(), closed.end(), true));
    if (overlapping(*q) == closed) break;
    const Eigen::VectorXd step = *q - reached;
    reached += least_energy(schur, right, faces, penalty, reached, step) * step;
    closed = overlapping(reached);
  }
  return true;
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
  state.solved = solve_with_contact(schur, right, faces, penalty, state);
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
