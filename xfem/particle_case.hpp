// One particle of a frame on its way through the analysis: its loads in the body frame, what it is analysed with, and
// what came out.
#pragma once

#include <string>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/io/frame.hpp"
#include "xfem/breakage.hpp"
#include "xfem/canonical.hpp"
#include "xfem/model_cache.hpp"

namespace xfem {

/// What one particle brings to the analysis and takes from it.
struct ParticleCase {
  std::vector<Load> loads;  ///< body frame
  bool breakable = false;
  const std::vector<Crack>* stored = nullptr;  ///< cracks of the previous split
  CanonicalOutline shape;                      ///< of a breakable particle
  ModelCache::Entry* entry = nullptr;          ///< null: not analysed
  std::string failure;                         ///< why there is no model or no result
  bool solved = false;
  BreakageResult result;  ///< in metres
};

/// The particles of a frame with their contact forces. A force or a point that is no number becomes the particle's
/// failure. Throws bad_input if a contact names a particle that is not there.
std::vector<ParticleCase> gather_loads(const common::Frame& frame, const std::vector<common::Rotation>& rotation);

/// Its loads in the coordinates of its canonical shape.
std::vector<Load> canonical_loads(const ParticleCase& particle);

/// Takes a result in canonical coordinates back to metres. The fragments are cut anew from the true outline, so that
/// they share its vertices bit for bit.
BreakageResult to_metres(BreakageResult result, const CanonicalOutline& shape, PolygonView outline);

bool is_finite(const Stress& stress);

/// Why a result cannot be written down; empty if it can.
std::string defect_of(const BreakageResult& result);

/// Says how many of the analysed particles are out of balance by more than 5 % of their contact forces, and which one
/// is the worst; empty if none. Particles that carry less than 5 % of the mean are passed over.
std::string unbalance_warning(const common::Frame& frame, const std::vector<ParticleCase>& cases);

}  // namespace xfem
