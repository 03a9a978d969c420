#include "xfem/crack/face_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "xfem/crack/friction_path.hpp"

namespace xfem {
namespace {

/// A long crack that is peeled open settles from its end, one face after another, so that the steps grow with the
/// faces: of 3,500 cracks along the edge of a strip none took more than 2 for each (76 for 90 faces, 153 for 228). What
/// is not found within this is not used.
constexpr int kStepsPerFace = 10;
/// A difference of displacements below this share of their sum is rounding: where faces only just touch, or slide,
/// there need not be a set that agrees with its own solution.
constexpr double kRounding = 1e-13;
/// The bounds on the shear settle to this share of the largest, within so many steps, or else on the friction path; a
/// step is at least this share of the change wanted.
constexpr int kFrictionIterations = 60;
constexpr double kFrictionTolerance = 1e-9;
constexpr double kSmallestShare = 1.0 / 16;
constexpr int kPolishingSteps = 4;

/// Adds k l v v^T for the face's direction v, its normal or its tangent.
void add_direction(DenseSymmetric& matrix, const FaceSegment& face, const Vec2& direction, double stiffness) {
  for (const auto& [f, wf] : face.jumps) {
    for (const auto& [g, wg] : face.jumps) {
      for (int a = 0; a < 2; ++a) {
        for (int b = 0; b < 2; ++b) {
          const int row = 2 * f + a;
          const int column = 2 * g + b;
          if (row > column) continue;
          matrix.at(row, column) += stiffness * face.length * wf * direction[a] * wg * direction[b];
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

int most_steps(const std::vector<FaceSegment>& faces) {
  return kStepsPerFace * (static_cast<int>(faces.size()) + 1);
}

/// How far rounding takes the opening along `direction`, the face's normal, or its slip along the tangent.
double rounding(const FaceSegment& face, const Vec2& direction, const Eigen::VectorXd& q) {
  double sum = 0;
  for (const auto& [function, weight] : face.jumps) {
    sum += std::abs(weight) * q.segment<2>(2 * function).cwiseAbs().dot(direction.cwiseAbs());
  }
  return kRounding * sum;
}

bool touches(const FaceSegment& face, const Eigen::VectorXd& q) {
  return std::abs(opening(face, q)) <= rounding(face, face.normal, q);
}

double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Root in [0, 1] of a growing function that is linear between the ascending `bends`, of which the last is 1; 0 or 1 if
/// it has none.
template <class Derivative>
double root_between(const std::vector<double>& bends, const Derivative& derivative) {
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
  return root_between(bends, derivative);
}

/// By how much the bounds on the shear would change, and the largest of them [Pa].
struct Change {
  double largest_change, largest;
};

/// What a face does under a bound on its shear.
enum class Shear { none, sticks, forward, backward };

Vec2 tangent(const FaceSegment& face) {
  return {face.normal.y(), -face.normal.x()};
}

/// Contact under given bounds on the shear of each face.
class TrescaContact {
 public:
  TrescaContact(const DenseSymmetric& schur, const Eigen::VectorXd& right, const std::vector<FaceSegment>& faces,
                double penalty, const std::vector<double>& bounds)
      : schur_(schur), right_(right), faces_(faces), penalty_(penalty), bounds_(bounds) {}

  struct Solution {
    Eigen::VectorXd q;
    bool settled;  ///< what the faces do in q is what it was solved for
  };

  /// The solution, from `start`; empty if a system is singular.
  std::optional<Solution> solve(Eigen::VectorXd start) const {
    Eigen::VectorXd reached = std::move(start);
    State state = state_of(reached);
    Solution solution{{}, false};
    for (int left = most_steps(faces_); left > 0; --left) {
      std::optional<Eigen::VectorXd> q = solve_linear(state);
      if (!q) return std::nullopt;
      solution.q = std::move(*q);
      solution.settled = agrees(state, solution.q);
      if (solution.settled) break;
      const Eigen::VectorXd step = solution.q - reached;
      reached += least(reached, step) * step;
      state = state_of(reached);
    }
    return solution;
  }

  double shear(std::size_t face, double slipped) const {
    return std::clamp(penalty_ * slipped, -bounds_[face], bounds_[face]);
  }

 private:
  struct State {
    std::vector<bool> closed;
    std::vector<Shear> shear;
  };

  State state_of(const Eigen::VectorXd& q) const {
    State state;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      state.closed.push_back(opening(faces_[i], q) < 0);
      const double trial = penalty_ * slip(faces_[i], q);
      state.shear.push_back(bounds_[i] == 0       ? Shear::none
                            : trial > bounds_[i]  ? Shear::forward
                            : trial < -bounds_[i] ? Shear::backward
                                                  : Shear::sticks);
    }
    return state;
  }

  /// True if the faces do in q what `state` says, to within rounding.
  bool agrees(const State& state, const Eigen::VectorXd& q) const {
    const State found = state_of(q);
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      if (found.closed[i] != state.closed[i] && !touches(faces_[i], q)) return false;
      const double beyond_bound = std::abs(slip(faces_[i], q)) - bounds_[i] / penalty_;
      if (found.shear[i] != state.shear[i] && std::abs(beyond_bound) > rounding(faces_[i], tangent(faces_[i]), q)) {
        return false;
      }
    }
    return true;
  }

  std::optional<Eigen::VectorXd> solve_linear(const State& state) const {
    DenseSymmetric system = schur_;
    Eigen::VectorXd load = right_;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const FaceSegment& face = faces_[i];
      if (state.closed[i]) add_direction(system, face, face.normal, penalty_);
      if (state.shear[i] == Shear::sticks) add_direction(system, face, tangent(face), penalty_);
      if (state.shear[i] != Shear::forward && state.shear[i] != Shear::backward) continue;
      const double force = (state.shear[i] == Shear::forward ? -1 : 1) * bounds_[i] * face.length;
      for (const auto& [function, weight] : face.jumps) {
        load[2 * function] += force * weight * tangent(face).x();
        load[2 * function + 1] += force * weight * tangent(face).y();
      }
    }
    return solve_spd(std::move(system), load);
  }

  /// Fraction of the step at which the energy is least: its derivative is piecewise linear and grows.
  double least(const Eigen::VectorXd& q, const Eigen::VectorXd& step) const {
    const double constant = dot(step, product(schur_, q)) - dot(step, right_);
    const double linear = dot(step, product(schur_, step));
    std::vector<double> gap, gap_rate, slipped, slip_rate, bends{1.0};
    const auto bend_at = [&](double value) {
      if (value > 0 && value < 1) bends.push_back(value);
    };
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      gap.push_back(opening(faces_[i], q));
      gap_rate.push_back(opening(faces_[i], step));
      slipped.push_back(slip(faces_[i], q));
      slip_rate.push_back(slip(faces_[i], step));
      if (gap_rate[i] != 0) bend_at(-gap[i] / gap_rate[i]);
      if (bounds_[i] == 0 || slip_rate[i] == 0) continue;
      for (const int sign : {1, -1}) bend_at((sign * bounds_[i] / penalty_ - slipped[i]) / slip_rate[i]);
    }
    std::sort(bends.begin(), bends.end());
    const auto derivative = [&](double t) {
      double sum = constant + linear * t;
      for (std::size_t i = 0; i < faces_.size(); ++i) {
        const double pressure = penalty_ * std::min(0.0, gap[i] + gap_rate[i] * t);
        sum += faces_[i].length * (pressure * gap_rate[i] + shear(i, slipped[i] + slip_rate[i] * t) * slip_rate[i]);
      }
      return sum;
    };
    return root_between(bends, derivative);
  }

  const DenseSymmetric& schur_;
  const Eigen::VectorXd& right_;
  const std::vector<FaceSegment>& faces_;
  double penalty_;
  const std::vector<double>& bounds_;
};

}  // namespace

std::optional<FaceContact> solve_face_contact(const DenseSymmetric& schur, const Eigen::VectorXd& right,
                                              const std::vector<FaceSegment>& faces, double penalty) {
  FaceContact contact;
  Eigen::VectorXd reached = Eigen::VectorXd::Zero(schur.size);
  std::vector<bool> closed(faces.size(), false);
  const auto agrees = [&](const Eigen::VectorXd& q) {
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if ((opening(faces[i], q) < 0) != closed[i] && !touches(faces[i], q)) return false;
    }
    return true;
  };
  for (int left = most_steps(faces); left > 0; --left) {
    DenseSymmetric system = schur;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (closed[i]) add_direction(system, faces[i], faces[i].normal, penalty);
    }
    std::optional<Eigen::VectorXd> q = solve_spd(std::move(system), right);
    if (!q) return std::nullopt;
    contact.q = std::move(*q);
    contact.closed_segments = static_cast<int>(std::count(closed.begin(), closed.end(), true));
    contact.settled = agrees(contact.q);
    if (contact.settled) break;
    const Eigen::VectorXd step = contact.q - reached;
    reached += least_energy(schur, right, faces, penalty, reached, step) * step;
    for (std::size_t i = 0; i < faces.size(); ++i) closed[i] = opening(faces[i], reached) < 0;
  }
  return contact;
}

std::optional<FaceContact> solve_frictional_contact(const DenseSymmetric& schur, const Eigen::VectorXd& right,
                                                    const std::vector<FaceSegment>& faces, double penalty,
                                                    double friction) {
  std::optional<FaceContact> contact = solve_face_contact(schur, right, faces, penalty);
  if (!contact) return contact;
  contact->shear.assign(faces.size(), 0.0);
  if (contact->closed_segments == 0) return contact;
  std::vector<double> bounds(faces.size(), 0.0);
  // The bounds go this share of the way to what the pressures ask for.
  const auto adjust_bounds = [&](double share) {
    double change = 0;
    double largest = 0;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const double wanted = friction * penalty * std::max(0.0, -opening(faces[i], contact->q));
      change = std::max(change, std::abs(wanted - bounds[i]));
      largest = std::max(largest, wanted);
      bounds[i] += share * (wanted - bounds[i]);
    }
    return Change{change, largest};
  };
  const auto solve_for_bounds = [&] {
    const TrescaContact tresca(schur, right, faces, penalty, bounds);
    std::optional<TrescaContact::Solution> solution = tresca.solve(contact->q);
    if (!solution) return false;
    contact->q = std::move(solution->q);
    contact->settled = solution->settled;
    contact->closed_segments = 0;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      contact->closed_segments += opening(faces[i], contact->q) < 0;
      contact->shear[i] = tresca.shear(i, slip(faces[i], contact->q));
    }
    return true;
  };
  double previous = std::numeric_limits<double>::infinity();
  double share = 1;
  for (int iteration = 0; iteration < kFrictionIterations; ++iteration) {
    const auto [change, largest] = adjust_bounds(share);
    if (!contact->settled) break;
    if (change <= kFrictionTolerance * largest) return contact;
    if (change >= previous) share = std::max(share / 2, kSmallestShare);
    previous = change;
    if (!solve_for_bounds()) return std::nullopt;
  }
  // The path's bounds; solving for them once more must leave them where they are, to within rounding: of a few steps
  // from there one does.
  contact->settled = false;
  const std::optional<FrictionPath> path = follow_friction_path(schur, right, faces, penalty, friction);
  if (!path) return contact;
  for (std::size_t i = 0; i < faces.size(); ++i) bounds[i] = friction * path->pressure[i];
  contact->q = path->q;
  for (int step = 0; step < kPolishingSteps && !contact->settled; ++step) {
    if (!solve_for_bounds()) return std::nullopt;
    const auto [change, largest] = adjust_bounds(1);
    contact->settled = contact->settled && change <= kFrictionTolerance * largest;
  }
  return contact;
}

}  // namespace xfem
