#include "xfem/elasticity/intact_model.hpp"

#include <string>
#include <utility>

#include "common/error.hpp"
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
  double area = 0;
  Vec2 center = Vec2::Zero();
  double polar_moment = 0;  ///< of the area about the center [m^4]

  Implementation(Mesh mesh_in, const ElasticConstants& constants_in, const std::array<int, 3>* fixed)
      : mesh(std::move(mesh_in)),
        constants(checked(constants_in)),
        elasticity(constants.matrix()),
        gradients(element_gradients(mesh)),
        fixed_dofs(fixed != nullptr ? *fixed : determinate_supports(mesh)),
        factor(mesh, gradients, elasticity, fixed_dofs),
        loop(boundary_loop(mesh)) {
    for (const int node : loop) loop_points.push_back(mesh.nodes[node]);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      area += mesh.areas[t];
      center += mesh.areas[t] / 3 * (mesh.nodes[a] + mesh.nodes[b] + mesh.nodes[c]);
    }
    center /= area;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      Vec2 sum = Vec2::Zero();
      double squares = 0;
      for (const int node : mesh.triangles[t]) {
        const Vec2 r = mesh.nodes[node] - center;
        sum += r;
        squares += r.squaredNorm();
      }
      polar_moment += mesh.areas[t] / 12 * (squares + sum.squaredNorm());
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

Eigen::VectorXd IntactModel::nodal_forces(std::span<const Load> loads, double patch) const {
  const Implementation& self = *implementation_;
  const std::vector<Vec2> forces = boundary_forces(self.loop_points, loads, patch);
  const RigidAcceleration rigid =
      rigid_acceleration(self.loop_points, forces, self.area, self.center, self.polar_moment);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(dofs());
  for (std::size_t k = 0; k < forces.size(); ++k) {
    result[2 * self.loop[k]] += forces[k].x();
    result[2 * self.loop[k] + 1] += forces[k].y();
  }
  // Consistent mass of the T3: A / 12 (1 + delta_ij), exact for the linear field of a rigid acceleration.
  for (std::size_t t = 0; t < self.mesh.triangles.size(); ++t) {
    const auto& triangle = self.mesh.triangles[t];
    std::array<Vec2, 3> body;
    for (int k = 0; k < 3; ++k) {
      body[k] = rigid.linear + rigid.angular * common::perpendicular(self.mesh.nodes[triangle[k]] - self.center);
    }
    const Vec2 sum = body[0] + body[1] + body[2];
    for (int k = 0; k < 3; ++k) {
      const Vec2 share = self.mesh.areas[t] / 12 * (sum + body[k]);
      result[2 * triangle[k]] -= share.x();
      result[2 * triangle[k] + 1] -= share.y();
    }
  }
  return result;
}

double IntactModel::unbalance(std::span<const Load> loads) {
  Vec2 resultant = Vec2::Zero();
  double sum = 0;
  for (const Load& load : loads) {
    resultant += load.force;
    sum += load.force.norm();
  }
  return sum > 0 ? resultant.norm() / sum : 0;
}

Eigen::VectorXd IntactModel::solve(const Eigen::VectorXd& forces) const {
  return implementation_->factor.solve(forces);
}

Eigen::MatrixXd IntactModel::solve(const Eigen::MatrixXd& forces) const {
  return implementation_->factor.solve(forces);
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
