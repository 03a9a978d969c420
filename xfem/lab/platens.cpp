#include "xfem/lab/platens.hpp"

#include <Eigen/Dense>

#include "common/error.hpp"

namespace xfem {

namespace {

enum class Contact { stick, slip_left, slip_right, open };

constexpr int kMostChoices = 100;
/// Forces and displacements nearer to a limit than this share of their scale do not contradict a choice.
constexpr double kTolerance = 1e-9;

/// The two faces' nodes with their compliances, and the linear system of one choice.
class PlatenSystem {
 public:
  PlatenSystem(const IntactModel& model, const Face& bottom, const Face& top, double friction, double load)
      : friction_(friction), load_(load) {
    nodes_ = face_nodes(model.mesh(), bottom);
    bottoms_ = nodes_.size();
    for (const int node : face_nodes(model.mesh(), top)) nodes_.push_back(node);
    for (const int node : nodes_) points_.push_back(model.mesh().nodes[node]);
    const Eigen::Index n = static_cast<Eigen::Index>(nodes_.size());
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(model.dofs(), 2 * n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (int c = 0; c < 2; ++c) unit(2 * nodes_[i] + c, 2 * i + c) = 1;
    const Eigen::MatrixXd displacement = model.solve(unit);
    compliance_.resize(2 * n, 2 * n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (int c = 0; c < 2; ++c) compliance_.row(2 * i + c) = displacement.row(2 * nodes_[i] + c);
  }

  std::size_t size() const { return nodes_.size(); }
  const Vec2& point(std::size_t i) const { return points_[i]; }
  /// Direction of the platen's push.
  double inwards(std::size_t i) const { return i < bottoms_ ? 1 : -1; }

  /// Forces (x, y) of the nodes, and their displacements against the platens.
  void solve(const std::vector<Contact>& contacts) {
    const Eigen::Index n = static_cast<Eigen::Index>(size()), forces = 2 * n, unknowns = forces + 4;
    // Scales that make all columns and rows of one size: lengths by the compliance of a node.
    const double scale = compliance_.diagonal().cwiseAbs().maxCoeff();
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(unknowns, unknowns);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(unknowns);
    double length = 0;
    for (const Vec2& p : points_) length = std::max(length, p.norm());
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Index x = 2 * i, y = x + 1;
      const double up = inwards(i);
      const Vec2& p = points_[i];
      if (contacts[i] == Contact::open) {
        a(x, x) = a(y, y) = 1;
        continue;
      }
      // Displacement of the node against its platen: elastic, rigid (u, v, turn), closing of the top platen.
      a.row(y).head(forces) = compliance_.row(y) / scale;
      a(y, forces + 1) = 1;
      a(y, forces + 2) = p.x() / length;
      if (up < 0) a(y, forces + 3) = 1;
      if (contacts[i] == Contact::stick) {
        a.row(x).head(forces) = compliance_.row(x) / scale;
        a(x, forces) = 1;
        a(x, forces + 2) = -p.y() / length;
      } else {
        a(x, x) = 1;
        a(x, y) = (contacts[i] == Contact::slip_right ? 1 : -1) * friction_ * up;
      }
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      a(forces, 2 * i) = 1;
      a(forces + 1, 2 * i + 1) = 1;
      a(forces + 2, 2 * i) = -points_[i].y() / length;
      a(forces + 2, 2 * i + 1) = points_[i].x() / length;
      if (inwards(i) < 0) a(forces + 3, 2 * i + 1) = -1;
    }
    b[forces + 3] = load_;
    // Where no node sticks, the block's sideways place is free: the smallest solution is taken.
    const Eigen::VectorXd x = a.completeOrthogonalDecomposition().solve(b);
    force = x.head(forces);
    slip.resize(n);
    gap.resize(n);
    const Eigen::VectorXd elastic = compliance_ * force / scale;
    for (Eigen::Index i = 0; i < n; ++i) {
      slip[i] = elastic[2 * i] + x[forces] - x[forces + 2] * points_[i].y() / length;
      const double normal = elastic[2 * i + 1] + x[forces + 1] + x[forces + 2] * points_[i].x() / length +
                            (inwards(i) < 0 ? x[forces + 3] : 0);
      gap[i] = inwards(i) * normal;
    }
    displacement_scale = std::abs(x[forces + 3]);
  }

  Eigen::VectorXd force;      ///< of the last choice: 2 per node
  Eigen::VectorXd slip, gap;  ///< sideways displacement, and opening between node and platen
  double displacement_scale = 0;

 private:
  double friction_, load_;
  std::vector<int> nodes_;
  std::size_t bottoms_ = 0;
  std::vector<Vec2> points_;
  Eigen::MatrixXd compliance_;
};

/// What the last solution says of a node that was taken as `now`.
Contact next_choice(const PlatenSystem& system, std::size_t i, Contact now, double friction, double load) {
  const double normal = system.inwards(i) * system.force[2 * i + 1], tangential = system.force[2 * i];
  const double small_force = kTolerance * load;
  const double small_displacement = kTolerance * system.displacement_scale;
  if (now == Contact::open) return system.gap[i] < -small_displacement ? Contact::stick : now;
  if (normal < -small_force) return Contact::open;
  if (now == Contact::stick) {
    if (std::abs(tangential) <= friction * normal + small_force) return now;
    return tangential > 0 ? Contact::slip_left : Contact::slip_right;  // the platen holds it back: against its slip
  }
  const bool slides_back =
      now == Contact::slip_right ? system.slip[i] < -small_displacement : system.slip[i] > small_displacement;
  return slides_back ? Contact::stick : now;
}

}  // namespace

std::vector<Load> platen_forces(const IntactModel& model, const Face& bottom, const Face& top, double friction,
                                double load) {
  PlatenSystem system(model, bottom, top, friction, load);
  std::vector<Contact> contacts(system.size(), Contact::stick);
  for (int choice = 0; choice < kMostChoices; ++choice) {
    system.solve(contacts);
    bool settled = true;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const Contact next = next_choice(system, i, contacts[i], friction, load);
      settled = settled && next == contacts[i];
      contacts[i] = next;
    }
    if (!settled) continue;
    std::vector<Load> loads;
    for (std::size_t i = 0; i < contacts.size(); ++i)
      loads.push_back({system.point(i), {system.force[2 * i], system.force[2 * i + 1]}});
    return loads;
  }
  throw common::numerical_failure("uniaxial: which nodes of the platens slip does not settle; expected it to within " +
                                  std::to_string(kMostChoices) + " choices");
}

}  // namespace xfem
