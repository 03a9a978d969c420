#include "xfem/crack/cracked_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "xfem/crack/dense_spd.hpp"
#include "xfem/crack/face_contact.hpp"
#include "xfem/crack/separation.hpp"

namespace xfem {
namespace {

using Block4 = std::array<double, 4>;

/// Adds weight * B_I^T D B_J of two shape functions with the given gradients [N/m^2 for unit thickness].
void add_stiffness(Block4& block, double weight, const Eigen::Matrix3d& d, const Vec2& i, const Vec2& j) {
  block[0] += weight * (i.x() * d(0, 0) * j.x() + i.y() * d(2, 2) * j.y());
  block[1] += weight * (i.x() * d(0, 1) * j.y() + i.y() * d(2, 2) * j.x());
  block[2] += weight * (i.y() * d(1, 0) * j.x() + i.x() * d(2, 2) * j.y());
  block[3] += weight * (i.y() * d(1, 1) * j.y() + i.x() * d(2, 2) * j.x());
}

/// Block of a node in a list that is kept in ascending order of nodes.
template <typename Blocks>
Block4& block_of(Blocks& blocks, int node) {
  auto place = blocks.begin();
  while (place != blocks.end() && place->node < node) ++place;
  if (place == blocks.end() || place->node != node) place = blocks.insert(place, {node, {0, 0, 0, 0}});
  return place->value;
}

}  // namespace

CrackedSolver::CrackedSolver(const IntactModel& model, std::span<const Load> loads, double patch, double face_friction)
    : model_(&model), loads_(loads.begin(), loads.end()), patch_(patch), face_friction_(face_friction) {
  u0_ = model.solve(model.nodal_forces(loads, patch));
}

CrackedSolver::CrackedSolver(const IntactModel& model, Eigen::VectorXd forces, double face_friction)
    : model_(&model), face_friction_(face_friction) {
  u0_ = model.solve(forces);
}

/// Slot that holds the columns of W of a function for this column of Kua.
int CrackedSolver::slot_of(const EnrichmentFunction& function, const Blocks& stiffness) {
  const std::size_t nodes = model_->mesh().nodes.size();
  const std::size_t key = static_cast<std::size_t>(function.crack) * nodes + function.node;
  if (key >= slots_.size()) slots_.resize((static_cast<std::size_t>(function.crack) + 1) * nodes, -1);
  int slot = slots_[key];
  if (slot >= 0 && columns_[slot].stiffness == stiffness) return slot;
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  constexpr Block4 kUnknownBlock{kUnknown, kUnknown, kUnknown, kUnknown};
  if (slot < 0) {
    slot = slots_[key] = static_cast<int>(columns_.size());
    columns_.emplace_back();
  } else {
    for (Column& other : columns_) {
      if (static_cast<std::size_t>(slot) < other.product.size()) other.product[slot] = kUnknownBlock;
    }
  }
  Column& column = columns_[slot];
  column.stiffness = stiffness;
  column.product.assign(columns_.size(), kUnknownBlock);
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(model_->dofs(), 2);
  for (const auto& [node, block] : stiffness) {
    forces(2 * node, 0) = block[0];
    forces(2 * node, 1) = block[1];
    forces(2 * node + 1, 0) = block[2];
    forces(2 * node + 1, 1) = block[3];
  }
  column.response = model_->solve(forces);
  return slot;
}

/// Kau of the function in slot `row` times W of the one in slot `column`.
const std::array<double, 4>& CrackedSolver::product(int row, int column) {
  std::vector<Block4>& known = columns_[row].product;
  if (known.size() < columns_.size()) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    known.resize(columns_.size(), {kUnknown, kUnknown, kUnknown, kUnknown});
  }
  Block4& result = known[column];
  if (!std::isnan(result[0])) return result;
  result = {0, 0, 0, 0};
  const double* first = columns_[column].response.data();
  const double* second = first + columns_[column].response.rows();
  for (const auto& [node, block] : columns_[row].stiffness) {
    const int x = 2 * node;
    const int y = x + 1;
    result[0] += block[0] * first[x] + block[2] * first[y];
    result[1] += block[0] * second[x] + block[2] * second[y];
    result[2] += block[1] * first[x] + block[3] * first[y];
    result[3] += block[1] * second[x] + block[3] * second[y];
  }
  return result;
}

CrackedState CrackedSolver::solve(std::span<const Crack> cracks, double smallest_support) {
  const Mesh& mesh = model_->mesh();
  const Eigen::Matrix3d d = model_->constants().matrix();
  CrackedState state;
  state.enrichment = enrich(mesh, cracks, smallest_support);
  const Enrichment& enrichment = state.enrichment;
  const int functions = static_cast<int>(enrichment.functions.size());
  const int size = 2 * functions;
  state.u = u0_;
  state.q = Eigen::VectorXd::Zero(size);
  if (is_separated(mesh, cracks, enrichment)) {
    state.solved = false;
    state.defect = "the cracks cut it off";
    return state;
  }
  if (size == 0) {
    state.stress = model_->stresses(state.u);
    return state;
  }

  DenseSymmetric schur(size);
  std::vector<Blocks> coupling(functions);
  for (const CutElement& element : enrichment.cut) {
    const auto& triangle = mesh.triangles[element.element];
    const auto& gradient = model_->gradients()[element.element].gradient;
    for (const CutElement::Term& f : element.terms) {
      double weight = 0;
      for (const ElementPart& part : element.parts) weight += part.area * enrichment.jump(f, part);
      for (int k = 0; k < 3; ++k) {
        add_stiffness(block_of(coupling[f.function], triangle[k]), weight, d, gradient[k], gradient[f.local]);
      }
      for (const CutElement::Term& g : element.terms) {
        if (f.function > g.function) continue;
        double both = 0;
        for (const ElementPart& part : element.parts) {
          both += part.area * enrichment.jump(f, part) * enrichment.jump(g, part);
        }
        if (both == 0) continue;
        Block4 block{0, 0, 0, 0};
        add_stiffness(block, both, d, gradient[f.local], gradient[g.local]);
        double* upper = &schur.at(2 * f.function, 2 * g.function);
        upper[0] += block[0];
        upper[1] += block[1];
        upper[size] += block[2];  // below the diagonal and unused where f = g
        upper[size + 1] += block[3];
      }
    }
  }

  std::vector<int> slots(functions);
  for (int f = 0; f < functions; ++f) slots[f] = slot_of(enrichment.functions[f], coupling[f]);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  if (!loads_.empty()) {
    if (!edge_loads_) edge_loads_.emplace(*model_, loads_, patch_);
    right = edge_loads_->forces(enrichment);
  }
  for (int f = 0; f < functions; ++f) {
    for (const auto& [node, block] : coupling[f]) {
      right[2 * f] -= block[0] * u0_[2 * node] + block[2] * u0_[2 * node + 1];
      right[2 * f + 1] -= block[1] * u0_[2 * node] + block[3] * u0_[2 * node + 1];
    }
    for (int g = f; g < functions; ++g) {
      const Block4& block = product(slots[f], slots[g]);
      double* upper = &schur.at(2 * f, 2 * g);
      upper[0] -= block[0];
      upper[1] -= block[1];
      upper[size] -= block[2];
      upper[size + 1] -= block[3];
    }
  }

  const std::vector<FaceSegment> faces = face_segments(mesh, model_->gradients(), enrichment);
  const double penalty = kFacePenalty * model_->constants().young_modulus / mesh.size;
  std::optional<FaceContact> contact = face_friction_ > 0
                                           ? solve_frictional_contact(schur, right, faces, penalty, face_friction_)
                                           : solve_face_contact(schur, right, faces, penalty);
  state.solved = contact.has_value();
  if (!contact) {
    const SpdCondition condition = condition_of(schur);
    state.defect = fmt::format(
        "smallest pivot {:.2g} at node {}, expected above {:.0e}; condition {:.2g} of {} scaled unknowns, expected "
        "below "
        "{:.0e}",
        condition.smallest_pivot, condition.row < 0 ? -1 : enrichment.functions[condition.row / 2].node, kSmallestPivot,
        condition.condition, size, 1 / kSmallestPivot);
  }
  if (contact) {
    state.q = std::move(contact->q);
    state.settled = contact->settled;
    state.closed_segments = contact->closed_segments;
    state.face_shear = std::move(contact->shear);
  }
  double* __restrict u = state.u.data();
  const Eigen::Index dofs = state.u.size();
  for (int f = 0; f < functions; ++f) {
    const double* __restrict first = columns_[slots[f]].response.data();
    const double* __restrict second = first + dofs;
    const double q0 = state.q[2 * f];
    const double q1 = state.q[2 * f + 1];
    for (Eigen::Index i = 0; i < dofs; ++i) u[i] = (u[i] - q0 * first[i]) - q1 * second[i];
  }
  state.stress = cracked_stresses(*model_, enrichment, state.u, state.q);
  return state;
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
