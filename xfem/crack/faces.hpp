// Contact of crack faces: a crack segment that would close gets a normal penalty, so that a crack under compression
// carries load as the uncracked body does. Faces slide freely, or with Coulomb friction (face_contact.hpp).
#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "xfem/crack/enrichment.hpp"
#include "xfem/elasticity/intact_model.hpp"

namespace xfem {

/// The two faces of one crack segment, integrated with one point at its middle:
/// opening = normal . sum over jumps of weight * q of that function; positive: open.
struct FaceSegment {
  int segment;                                ///< index into Enrichment::segments
  double length;                              ///< [m]
  Vec2 normal;                                ///< unit vector, towards the left side
  std::vector<std::pair<int, double>> jumps;  ///< function, weight 2 N_J(middle)
};

/// The segments on which some enrichment function acts, in the order of Enrichment::segments.
std::vector<FaceSegment> face_segments(const Mesh& mesh, std::span<const ElementGradients> gradients,
                                       const Enrichment& enrichment);

/// Normal opening of a segment for the enriched dofs q (2 per function) [m].
double opening(const FaceSegment& segment, const Eigen::VectorXd& q);

/// How far the left side has slid forward against the right one [m].
double slip(const FaceSegment& segment, const Eigen::VectorXd& q);

/// Penalty stiffness per area, k = 100 E / h [N/m^3].
inline constexpr double kFacePenalty = 100;

}  // namespace xfem
