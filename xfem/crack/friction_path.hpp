// Contact of crack faces with Coulomb friction, by a path that always ends: what the iteration of face_contact.hpp
// falls back on where it does not settle.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "xfem/crack/dense_spd.hpp"
#include "xfem/crack/faces.hpp"

namespace xfem {

struct FrictionPath {
  Eigen::VectorXd q;             ///< enriched dofs, 2 per function [m]
  std::vector<double> pressure;  ///< per face [Pa]
  std::vector<double> shear;     ///< per face, resists its slip [Pa]
  int pieces = 0;                ///< linear pieces that the path went through
};

/// The q with S q = right + sum l (p n - tau t), p = penalty max(0, -opening), tau = penalty slip clamped to
/// +-friction p. All faces are first set apart by a gap z so wide that none touches, then brought together: in the
/// states that the faces have (open, stick, slip either way) everything is linear in z, and where a face changes its
/// state the path goes on into the neighbouring piece, with z falling or, for a while, rising (the method of Lemke and
/// Katzenelson for piecewise linear equations).
/// It ends at z = 0: contact and friction only take energy, so that q S q <= right q on the whole path, and from some z
/// on the open state is the only one; a path that can neither end elsewhere nor leave has to reach z = 0.
/// Empty if S is singular, or where pieces are degenerate (faces that change together to within rounding).
std::optional<FrictionPath> follow_friction_path(const DenseSymmetric& schur, const Eigen::VectorXd& right,
                                                 const std::vector<FaceSegment>& faces, double penalty,
                                                 double friction);

}  // namespace xfem
