#include "xfem/elasticity/intact_model.hpp"

#include <string>
#include <utility>

#include "common/error.hpp"
#include "xfem/elasticity/factor.hpp"
#include "xfem/elasticity/loads.hpp"
#include "xfem/elasticity/stiffness.hpp"

namespace xfem {

Eigen::Matrix3d ElasticConstants::matrix() const {
  const double e = young_modulus;
  const double nu = poisson_ratio;
  Eigen::Matrix3d d;
  if (plane_stress) {
    d << 1, nu, 0, nu, 1, 0, 0, 0, (1 - nu) / 2;
    return e / (1 - nu * nu) * d;
  }
  d << 1 - nu, nu, 0, nu, 1 - nu, 0, 0, 0, (1 - 2 * nu) / 2;
  return e / ((1 + nu) * (1 - 2 * nu)) * d;
}

namespace {

const ElasticConstants& checked(const ElasticConstants& constants) {
  if (!(constants.young_modulus > 0)) {
    throw common::bad_input("elasticity: Young's modulus is " + std::to_string(constants.young_modulus) +
                            " Pa, expected a positive one");
  }
  if (!(constants.poisson_ratio > -1 && constants.poisson_ratio < 0.5)) {
    throw common::bad_input("elasticity: Poisson's ratio is " + std::to_string(constants.poisson_ratio) +
                            ", expected one in (-1, 0.5)");
  }
  return constants;
}

}  // namespace

struct IntactModel::Implementation {
  Mesh mesh;
  ElasticConstants constants;
  Eigen::Matrix3d elasticity;
  std::vector<ElementGradients> gradients;
  std::array<int, 3> fixed_dofs;
  Factor factor;
  std::vector<int> loop;          ///< boundary nodes in order
  std::vector<Vec2> loop_points;  ///< and where they stand
  BoundaryLoop feet;              ///< where loads reach them
  AreaMoments moments{0, Vec2::Zero(), 0};
  Eigen::MatrixXd rigid;  ///< 2 n x 3: nodal forces of unit body forces along x and y, and about the center

  Implementation(Mesh mesh_in, const ElasticConstants& constants_in, const std::array<int, 3>* fixed)
      : mesh(std::move(mesh_in)),
        constants(checked(constants_in)),
        elasticity(constants.matrix()),
        gradients(element_gradients(mesh)),
        fixed_dofs(fixed != nullptr ? *fixed : determinate_supports(mesh)),
        factor(mesh, gradients, elasticity, fixed_dofs),
        loop(xfem::boundary_loop(mesh)),
        rigid(Eigen::MatrixXd::Zero(2 * static_cast<Eigen::Index>(mesh.nodes.size()), 3)) {
    for (const int node : loop) loop_points.push_back(mesh.nodes[node]);
    feet = BoundaryLoop(loop_points);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      moments.area += mesh.areas[t];
      moments.center += mesh.areas[t] / 3 * (mesh.nodes[a] + mesh.nodes[b] + mesh.nodes[c]);
    }
    moments.center /= moments.area;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      Vec2 sum = Vec2::Zero();
      double squares = 0;
      for (const int node : mesh.triangles[t]) {
        const Vec2 r = mesh.nodes[node] - moments.center;
        sum += r;
        squares += r.squaredNorm();
      }
      moments.polar += mesh.areas[t] / 12 * (squares + sum.squaredNorm());
      // Consistent mass of the T3: A / 12 (1 + delta_ij), exact for the linear field of a rigid acceleration.
      for (const int node : mesh.triangles[t]) {
        const Vec2 share = mesh.areas[t] / 12 * common::perpendicular(sum + mesh.nodes[node] - moments.center);
        rigid(2 * node, 0) += mesh.areas[t] / 3;
        rigid(2 * node + 1, 1) += mesh.areas[t] / 3;
        rigid(2 * node, 2) += share.x();
        rigid(2 * node + 1, 2) += share.y();
      }
    }
  }

  /// Adds the nodal forces of a body force.
  template <class Column>
  void add(const BodyForce& body, Column&& forces) const {
    for (Eigen::Index i = 0; i < rigid.rows(); ++i) {
      forces[i] -= body.linear[i % 2] * rigid(i, i % 2) + body.angular * rigid(i, 2);
    }
  }
};

IntactModel::IntactModel(Mesh mesh, const ElasticConstants& constants)
    : implementation_(std::make_unique<Implementation>(std::move(mesh), constants, nullptr)) {}
IntactModel::IntactModel(Mesh mesh, const ElasticConstants& constants, const std::array<int, 3>& fixed_dofs)
    : implementation_(std::make_unique<Implementation>(std::move(mesh), constants, &fixed_dofs)) {}
IntactModel::~IntactModel() = default;
IntactModel::IntactModel(IntactModel&&) noexcept = default;
IntactModel& IntactModel::operator=(IntactModel&&) noexcept = default;

const Mesh& IntactModel::mesh() const {
  return implementation_->mesh;
}
const ElasticConstants& IntactModel::constants() const {
  return implementation_->constants;
}
const std::vector<ElementGradients>& IntactModel::gradients() const {
  return implementation_->gradients;
}
int IntactModel::dofs() const {
  return 2 * static_cast<int>(implementation_->mesh.nodes.size());
}
const std::array<int, 3>& IntactModel::fixed_dofs() const {
  return implementation_->fixed_dofs;
}

const std::vector<int>& IntactModel::boundary() const {
  return implementation_->loop;
}
const std::vector<Vec2>& IntactModel::boundary_points() const {
  return implementation_->loop_points;
}
const BoundaryLoop& IntactModel::boundary_loop() const {
  return implementation_->feet;
}

Eigen::VectorXd IntactModel::nodal_forces(std::span<const Load> loads, double patch) const {
  const Implementation& self = *implementation_;
  const std::vector<Vec2> forces = boundary_forces(self.loop_points, self.feet, loads, patch);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(dofs());
  for (std::size_t k = 0; k < forces.size(); ++k) {
    result[2 * self.loop[k]] += forces[k].x();
    result[2 * self.loop[k] + 1] += forces[k].y();
  }
  self.add(balancing_body_force(self.loop_points, forces, self.moments), result);
  return result;
}

BodyForce IntactModel::inertia_relief(std::span<const Load> loads, double patch) const {
  const Implementation& self = *implementation_;
  return balancing_body_force(self.loop_points, boundary_forces(self.loop_points, self.feet, loads, patch),
                              self.moments);
}

double IntactModel::unbalance(std::span<const Load> loads) {
  Vec2 resultant = Vec2::Zero();
  double sum = 0, moment = 0, levers = 0;
  for (const Load& load : loads) {
    resultant += load.force;
    sum += load.force.norm();
    moment += common::cross(load.point, load.force);
    levers += load.force.norm() * load.point.norm();
  }
  return std::max(sum > 0 ? resultant.norm() / sum : 0, levers > 0 ? std::abs(moment) / levers : 0);
}

Eigen::VectorXd IntactModel::solve(const Eigen::VectorXd& forces) const {
  return implementation_->factor.solve(forces);
}

Eigen::MatrixXd IntactModel::solve(const Eigen::MatrixXd& forces) const {
  return implementation_->factor.solve(forces);
}

void IntactModel::unit_stresses(int first, std::vector<double>& stress, std::vector<double>& work) const {
  using Lanes = Eigen::Array<double, kSideBySide, 1>;
  const auto lanes = [](std::vector<double>& values, std::size_t k) {
    return Eigen::Map<Lanes>(values.data() + k * kSideBySide);
  };
  const Implementation& self = *implementation_;
  const int cases = 2 * static_cast<int>(self.loop.size());
  work.assign(static_cast<std::size_t>(dofs()) * kSideBySide, 0.0);
  std::array<Lanes, 2> linear{Lanes::Zero(), Lanes::Zero()};
  Lanes angular = Lanes::Zero();
  for (int k = 0; k < kSideBySide && first + k < cases; ++k) {
    const int c = (first + k) % 2;
    const Vec2 force = Vec2::Unit(c);
    const std::size_t at = static_cast<std::size_t>(first + k) / 2;
    const BodyForce body = balancing_body_force({&self.loop_points[at], 1}, {&force, 1}, self.moments);
    linear[0][k] = body.linear.x();
    linear[1][k] = body.linear.y();
    angular[k] = body.angular;
    lanes(work, 2 * static_cast<std::size_t>(self.loop[at]) + c)[k] = 1;
  }
  for (int i = 0; i < dofs(); ++i) lanes(work, i) -= linear[i % 2] * self.rigid(i, i % 2) + angular * self.rigid(i, 2);
  self.factor.solve_side_by_side<kSideBySide>(work.data());

  const Eigen::Matrix3d& d = self.elasticity;
  stress.resize(self.mesh.triangles.size() * (3 * kSideBySide));
  for (std::size_t t = 0; t < self.mesh.triangles.size(); ++t) {
    Lanes exx = Lanes::Zero(), eyy = Lanes::Zero(), gxy = Lanes::Zero();
    for (int n = 0; n < 3; ++n) {
      const Vec2& g = self.gradients[t].gradient[n];
      const std::size_t node = static_cast<std::size_t>(self.mesh.triangles[t][n]);
      const Lanes u = lanes(work, 2 * node), v = lanes(work, 2 * node + 1);
      exx += g.x() * u;
      eyy += g.y() * v;
      gxy += g.y() * u + g.x() * v;
    }
    lanes(stress, 3 * t) = -(d(0, 0) * exx + d(0, 1) * eyy);
    lanes(stress, 3 * t + 1) = -(d(1, 0) * exx + d(1, 1) * eyy);
    lanes(stress, 3 * t + 2) = -d(2, 2) * gxy;
  }
}

std::vector<Stress> IntactModel::stresses(const Eigen::VectorXd& displacement) const {
  const Implementation& self = *implementation_;
  const Eigen::Matrix3d& d = self.elasticity;
  std::vector<Stress> result(self.mesh.triangles.size());
  for (std::size_t t = 0; t < result.size(); ++t) {
    double exx = 0, eyy = 0, gxy = 0;
    for (int k = 0; k < 3; ++k) {
      const int node = self.mesh.triangles[t][k];
      const Vec2& g = self.gradients[t].gradient[k];
      const double u = displacement[2 * node];
      const double v = displacement[2 * node + 1];
      exx += g.x() * u;
      eyy += g.y() * v;
      gxy += g.y() * u + g.x() * v;
    }
    result[t] = {-(d(0, 0) * exx + d(0, 1) * eyy), -(d(1, 0) * exx + d(1, 1) * eyy), -d(2, 2) * gxy};
  }
  return result;
}

}  // namespace xfem
