// Linear elasticity of one uncracked particle: mesh, stiffness, one factorization in its life, stress.
// Plane strain or plane stress, T3 elements, any three dofs fixed and inertia relief (DESIGN section 3).
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "xfem/criterion/hoek_brown.hpp"
#include "xfem/mesh.hpp"

namespace xfem {

/// A force on the particle at a point of (or near) its boundary; body frame.
struct Load {
  Vec2 point;  ///< [m]
  Vec2 force;  ///< [N]
};

struct ElasticConstants {
  double young_modulus;  ///< [Pa]
  double poisson_ratio;  ///< [-]
  bool plane_stress = false;
  /// Tension-positive constitutive matrix D of (xx, yy, 2 xy), 3 x 3 [Pa].
  Eigen::Matrix3d matrix() const;
};

/// Body force that balances loads (inertia relief), b(x) = -(linear + angular * perpendicular(x - center)).
struct BodyForce {
  Vec2 center;     ///< area centroid [m]
  Vec2 linear;     ///< [N/m^2]
  double angular;  ///< [N/m^3]
};

class BoundaryLoop;  // loads.hpp

/// Strain-displacement data of a T3 element: constant gradients of its three shape functions [1/m].
struct ElementGradients {
  std::array<Vec2, 3> gradient;
};

class IntactModel {
 public:
  /// Throws bad_input for constants outside E > 0, -1 < nu < 0.5, numerical_failure if the stiffness is not definite.
  IntactModel(Mesh mesh, const ElasticConstants& constants);
  /// With three dofs of the caller's choice held; they must be statically determinate.
  IntactModel(Mesh mesh, const ElasticConstants& constants, const std::array<int, 3>& fixed_dofs);
  ~IntactModel();
  IntactModel(IntactModel&&) noexcept;
  IntactModel& operator=(IntactModel&&) noexcept;

  const Mesh& mesh() const;
  const ElasticConstants& constants() const;
  const std::vector<ElementGradients>& gradients() const;
  /// Global dof 2 * node + component. Number of dofs, 2 n.
  int dofs() const;
  /// The three dofs that are held, ascending.
  const std::array<int, 3>& fixed_dofs() const;

  /// Boundary nodes in counter-clockwise order, and where they stand [m].
  const std::vector<int>& boundary() const;
  const std::vector<Vec2>& boundary_points() const;
  const BoundaryLoop& boundary_loop() const;
  /// Nodal forces (2 n) [N] of the loads as consistent edge loads at the nearest point of the boundary (`patch` > 0:
  /// spread over that length [m] along the boundary, see loads.hpp), plus the body force of the rigid acceleration that
  /// balances them (inertia relief): their sum and moment vanish. The moment that a load loses by being moved to the
  /// boundary is thereby balanced too.
  Eigen::VectorXd nodal_forces(std::span<const Load> loads, double patch = 0) const;
  /// The body force in it.
  BodyForce inertia_relief(std::span<const Load> loads, double patch = 0) const;
  /// The larger of |resultant of the loads| / sum of |load| and |their moment about the origin| / sum of |load|
  /// |point|, before inertia relief. Points about the centroid.
  static double unbalance(std::span<const Load> loads);

  /// Displacements (2 n) [m] for nodal forces (2 n); the fixed dofs come out zero. Thread-safe.
  Eigen::VectorXd solve(const Eigen::VectorXd& forces) const;
  /// The same for many right-hand sides at once (2 n x k), each column bit for bit as if alone.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& forces) const;

  /// Element stresses under unit forces on the boundary with their inertia relief, kSideBySide cases at a time: case
  /// 2 k + c is a force along axis c on boundary node k. Cases first, first + 1, ... stand side by side in
  /// stress[(3 e + component) * kSideBySide + case - first], e x (xx, yy, xy), compression positive; beyond the last
  /// case zeros. `work` is for the caller to keep.
  static constexpr int kSideBySide = 8;
  void unit_stresses(int first, std::vector<double>& stress, std::vector<double>& work) const;

  /// Element stresses, compression positive [Pa].
  std::vector<Stress> stresses(const Eigen::VectorXd& displacement) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Area average of the element stresses over a disc of `radius` about each element: about the middle of its boundary
/// edge, if it has one, else about its centroid (elements whose centroid lies inside; the element itself always).
/// radius = 0: the element's own stress.
class StressAverage {
 public:
  StressAverage(const Mesh& mesh, double radius);
  std::vector<Stress> operator()(std::span<const Stress> element_stress) const;
  /// The same of `Values` numbers per element, e x Values.
  template <int Values>
  void average(const double* of_elements, double* result) const {
    for (std::size_t t = 0; t + 1 < offset_.size(); ++t) {
      using Row = Eigen::Array<double, Values, 1>;
      Row sum = Row::Zero();
      for (int k = offset_[t]; k < offset_[t + 1]; ++k) {
        sum += weight_[k] * Eigen::Map<const Row>(of_elements + static_cast<std::size_t>(element_[k]) * Values);
      }
      Eigen::Map<Row>(result + t * Values) = sum;
    }
  }

 private:
  std::vector<int> offset_, element_;
  std::vector<double> weight_;
};

/// Virial mean stress sum(f (x) x) / A of the forces that `IntactModel::nodal_forces` applies (loads moved to the
/// nearest boundary point, `patch` [m], body force of inertia relief), compression positive [Pa]; needs no mesh. It
/// equals the area-weighted mean of the element stresses to rounding, cracked or not.
Stress virial_stress(std::span<const Load> loads, PolygonView outline, double patch = 0);

/// Area-weighted mean of element stresses [Pa].
Stress mean_stress(const Mesh& mesh, std::span<const Stress> element_stress);

}  // namespace xfem
