// Equilibrium of the enriched dofs under contact of the crack faces.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "xfem/crack/dense_spd.hpp"
#include "xfem/crack/faces.hpp"

namespace xfem {

struct FaceContact {
  Eigen::VectorXd q;          ///< enriched dofs, 2 per function [m]
  int closed_segments = 0;    ///< in contact
  bool settled = true;        ///< false: no state was found in which open faces do not overlap and closed ones do not
                              ///< pull, and that with friction meets Coulomb's law on all of them
  std::vector<double> shear;  ///< per face, with friction: shear stress that resists its slip [Pa]; else empty
};

/// The q that has the least energy 1/2 q S q - right q + 1/2 penalty sum l min(0, opening)^2; S the stiffness of the
/// enriched dofs with the standard ones eliminated, penalty in N/m^3. Empty if S is singular.
/// Active set: segments that would overlap are closed, closed ones that would open are released. Left alone such a set
/// may run in circles, so each new solution is approached only as far as the energy falls, which ends after finitely
/// many steps: about as many as there are faces where a crack peels open.
std::optional<FaceContact> solve_face_contact(const DenseSymmetric& schur, const Eigen::VectorXd& right,
                                              const std::vector<FaceSegment>& faces, double penalty);

/// The same with Coulomb friction on closed faces: |shear| <= friction * pressure. Slip counts from the uncracked body,
/// as for a load that grows from nothing. For given bounds on the shear (Tresca) the solution has the least energy
///   1/2 q S q - right q + sum l [1/2 penalty min(0, opening)^2 + psi(slip)],
/// psi' = penalty * slip, at most the bound either way: convex, symmetric, solved as above. The bounds follow from the
/// pressures, which follow from the bounds: a fixed point, whose steps are halved where they do not shrink. Starts from
/// the frictionless solution. There always is a fixed point (the solution is continuous in the bounds and bounded
/// whatever they are: Brouwer), but the steps need not settle on it: in 2 % of random ragged cracks with friction 0.6,
/// and 10 % with 1 to 2, they do not. Then friction_path.hpp finds it.
std::optional<FaceContact> solve_frictional_contact(const DenseSymmetric& schur, const Eigen::VectorXd& right,
                                                    const std::vector<FaceSegment>& faces, double penalty,
                                                    double friction);

}  // namespace xfem
