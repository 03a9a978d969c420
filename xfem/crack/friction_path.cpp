#include "xfem/crack/friction_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "xfem/crack/dense_lu.hpp"

namespace xfem {
namespace {

/// Pieces per face: measured paths have 1 to 6.
constexpr int kPiecesPerFace = 40;

enum class State { open, stick, forward, backward };

/// A number that changes linearly with the gap z.
struct Linear {
  double value = 0, rate = 0;
  double at(double z) const { return value + rate * z; }
};

/// Openings and slips of the faces as linear functions of the pressures and shears on them:
///   (opening, slip) = free + compliance (l p, -l tau), index 2 i for face i's opening and 2 i + 1 for its slip.
class Faces {
 public:
  Faces(const DenseSymmetric& schur, const Eigen::VectorXd& right, const std::vector<FaceSegment>& faces)
      : faces_(faces), size_(2 * static_cast<int>(faces.size())) {
    const int n = schur.size;
    scale_.resize(n);
    std::vector<double> matrix(static_cast<std::size_t>(n) * n);
    for (int i = 0; i < n; ++i) {
      if (!(schur.at(i, i) > 0)) return;
      scale_[i] = 1 / std::sqrt(schur.at(i, i));
    }
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        matrix[static_cast<std::size_t>(i) * n + j] = scale_[i] * schur.at(std::min(i, j), std::max(i, j)) * scale_[j];
      }
    }
    const DenseLu factor(n, std::move(matrix));
    if (factor.is_singular()) return;
    const auto solved = [&](Eigen::VectorXd b) {
      for (int i = 0; i < n; ++i) b[i] *= scale_[i];
      factor.solve({b.data(), static_cast<std::size_t>(n)});
      for (int i = 0; i < n; ++i) b[i] *= scale_[i];
      return b;
    };
    free_q_ = solved(right);
    for (int k = 0; k < size_; ++k) {
      const FaceSegment& face = faces[k / 2];
      const Vec2 direction = k % 2 == 0 ? face.normal : Vec2(face.normal.y(), -face.normal.x());
      Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
      for (const auto& [function, weight] : face.jumps) {
        force[2 * function] += weight * direction.x();
        force[2 * function + 1] += weight * direction.y();
      }
      response_.push_back(solved(std::move(force)));
    }
    free_ = seen(free_q_);
    for (const Eigen::VectorXd& response : response_) compliance_.push_back(seen(response));
    is_regular_ = true;
  }

  bool is_regular() const { return is_regular_; }
  /// Of opening or slip k without contact, and under a unit force on opening or slip j.
  double free(int k) const { return free_[k]; }
  double compliance(int k, int j) const { return compliance_[j][k]; }

  Eigen::VectorXd q(const std::vector<double>& pressure, const std::vector<double>& shear) const {
    Eigen::VectorXd q = free_q_;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      q += faces_[i].length * pressure[i] * response_[2 * i];
      q -= faces_[i].length * shear[i] * response_[2 * i + 1];
    }
    return q;
  }

 private:
  std::vector<double> seen(const Eigen::VectorXd& q) const {
    std::vector<double> seen;
    for (const FaceSegment& face : faces_) {
      seen.push_back(opening(face, q));
      seen.push_back(slip(face, q));
    }
    return seen;
  }

  const std::vector<FaceSegment>& faces_;
  int size_;
  bool is_regular_ = false;
  std::vector<double> scale_;
  Eigen::VectorXd free_q_;
  std::vector<Eigen::VectorXd> response_;
  std::vector<double> free_;
  std::vector<std::vector<double>> compliance_;
};

/// Pressures, shears, openings and slips of all faces in one piece of the path, as functions of the gap z.
struct Piece {
  std::vector<Linear> pressure, shear, opening, slip;
};

class Path {
 public:
  Path(const Faces& model, const std::vector<FaceSegment>& faces, double penalty, double friction)
      : model_(model), faces_(faces), penalty_(penalty), friction_(friction), state_(faces.size(), State::open) {}

  /// True if z = 0 was reached; the solution is that of `piece` there.
  bool follow();
  const Piece& piece() const { return piece_; }
  int pieces() const { return pieces_; }

 private:
  /// A condition of the piece, >= 0 in it, and the state of its face beyond (of an open face: `forward` for either
  /// way).
  struct Border {
    Linear distance;
    State beyond;
  };
  struct Crossing {
    std::size_t face;
    State beyond;
    double z;
  };

  bool solve();
  std::vector<Border> borders(std::size_t face) const;
  std::optional<Crossing> first_border(double z, int direction) const;

  const Faces& model_;
  const std::vector<FaceSegment>& faces_;
  double penalty_;
  double friction_;
  std::vector<State> state_;
  Piece piece_;
  int pieces_ = 0;
};

bool Path::solve() {
  const int count = static_cast<int>(faces_.size());
  // Unknown: the pressure of each closed face, and the shear of each that sticks.
  std::vector<int> pressure_of(count, -1), shear_of(count, -1);
  int size = 0;
  for (int i = 0; i < count; ++i) {
    if (state_[i] != State::open) pressure_of[i] = size++;
    if (state_[i] == State::stick) shear_of[i] = size++;
  }
  const auto slide = [&](int i) {
    return state_[i] == State::forward ? friction_ : state_[i] == State::backward ? -friction_ : 0.0;
  };
  // Row k of opening and slip, over the unknowns.
  const auto fill = [&](int k, double* row) {
    for (int j = 0; j < count; ++j) {
      const double length = faces_[j].length;
      if (pressure_of[j] < 0) continue;
      row[pressure_of[j]] += length * (model_.compliance(k, 2 * j) - slide(j) * model_.compliance(k, 2 * j + 1));
      if (shear_of[j] >= 0) row[shear_of[j]] -= length * model_.compliance(k, 2 * j + 1);
    }
  };
  std::vector<double> matrix(static_cast<std::size_t>(size) * size, 0.0), value(size), rate(size);
  for (int i = 0; i < count; ++i) {
    if (const int row = pressure_of[i]; row >= 0) {  // opening + z + p / penalty = 0
      fill(2 * i, &matrix[static_cast<std::size_t>(row) * size]);
      matrix[static_cast<std::size_t>(row) * size + row] += 1 / penalty_;
      value[row] = -model_.free(2 * i);
      rate[row] = -1;
    }
    if (const int row = shear_of[i]; row >= 0) {  // slip - tau / penalty = 0
      fill(2 * i + 1, &matrix[static_cast<std::size_t>(row) * size]);
      matrix[static_cast<std::size_t>(row) * size + row] -= 1 / penalty_;
      value[row] = -model_.free(2 * i + 1);
      rate[row] = 0;
    }
  }
  const DenseLu factor(size, std::move(matrix));
  if (factor.is_singular()) return false;
  factor.solve(value);
  factor.solve(rate);
  piece_ = {};
  for (int i = 0; i < count; ++i) {
    Linear pressure, shear;
    if (const int k = pressure_of[i]; k >= 0) {
      pressure = {value[k], rate[k]};
      shear = {slide(i) * value[k], slide(i) * rate[k]};
    }
    if (const int k = shear_of[i]; k >= 0) shear = {value[k], rate[k]};
    piece_.pressure.push_back(pressure);
    piece_.shear.push_back(shear);
  }
  for (int k = 0; k < 2 * count; ++k) {
    Linear seen{model_.free(k), 0};
    for (int j = 0; j < count; ++j) {
      const double length = faces_[j].length;
      const double normal = length * model_.compliance(k, 2 * j);
      const double tangential = length * model_.compliance(k, 2 * j + 1);
      seen.value += normal * piece_.pressure[j].value - tangential * piece_.shear[j].value;
      seen.rate += normal * piece_.pressure[j].rate - tangential * piece_.shear[j].rate;
    }
    (k % 2 == 0 ? piece_.opening : piece_.slip).push_back(seen);
  }
  return true;
}

std::vector<Path::Border> Path::borders(std::size_t i) const {
  const Linear& pressure = piece_.pressure[i];
  const Linear bound{friction_ * pressure.value, friction_ * pressure.rate};
  const auto within = [&](const Linear& shear, int sign) {
    return Linear{bound.value - sign * shear.value, bound.rate - sign * shear.rate};
  };
  const auto beyond = [&](int sign) {
    const Linear& slip = piece_.slip[i];
    return Linear{sign * penalty_ * slip.value - bound.value, sign * penalty_ * slip.rate - bound.rate};
  };
  switch (state_[i]) {
    case State::open:
      return {{{piece_.opening[i].value, piece_.opening[i].rate + 1}, State::forward}};
    case State::stick:
      return {{within(piece_.shear[i], 1), State::forward}, {within(piece_.shear[i], -1), State::backward}};
    case State::forward:
      return {{pressure, State::open}, {beyond(1), State::stick}};
    case State::backward:
      return {{pressure, State::open}, {beyond(-1), State::stick}};
  }
  return {};
}

/// What the path meets first from z on; empty if nothing.
std::optional<Path::Crossing> Path::first_border(double z, int direction) const {
  std::optional<Crossing> first;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    for (const Border& border : borders(i)) {
      if (!(direction * border.distance.rate < 0)) continue;
      double at = -border.distance.value / border.distance.rate;
      if (direction * (at - z) < 0) at = z;  // met already, to within rounding
      if (!(direction * at < nearest)) continue;
      nearest = direction * at;
      first = Crossing{i, border.beyond, at};
    }
  }
  return first;
}

bool Path::follow() {
  const int most = kPiecesPerFace * (static_cast<int>(faces_.size()) + 4);
  double z = std::numeric_limits<double>::infinity();
  int direction = -1;
  if (!solve()) return false;
  while (++pieces_ <= most) {
    const std::optional<Crossing> crossing = first_border(z, direction);
    if (direction < 0 && (!crossing || crossing->z <= 0)) return true;
    if (!crossing) return false;  // only rounding can lead back to where nothing touches
    z = crossing->z;
    const State before = std::exchange(state_[crossing->face], crossing->beyond);
    if (before == State::open && piece_.slip[crossing->face].at(z) < 0) state_[crossing->face] = State::backward;
    if (!solve()) return false;
    // The new piece sees the border just crossed from its other side, and the path goes away from it.
    direction = 0;
    for (const Border& border : borders(crossing->face)) {
      if (border.beyond != before && state_[crossing->face] != State::open) continue;
      direction = border.distance.rate > 0 ? 1 : border.distance.rate < 0 ? -1 : 0;
    }
    if (direction == 0) return false;
  }
  return false;
}

}  // namespace

std::optional<FrictionPath> follow_friction_path(const DenseSymmetric& schur, const Eigen::VectorXd& right,
                                                 const std::vector<FaceSegment>& faces, double penalty,
                                                 double friction) {
  const Faces model(schur, right, faces);
  if (!model.is_regular()) return std::nullopt;
  Path path(model, faces, penalty, friction);
  if (!path.follow()) return std::nullopt;
  FrictionPath solution;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    solution.pressure.push_back(path.piece().pressure[i].at(0));
    solution.shear.push_back(path.piece().shear[i].at(0));
  }
  solution.q = model.q(solution.pressure, solution.shear);
  solution.pieces = path.pieces();
  return solution;
}

}  // namespace xfem
