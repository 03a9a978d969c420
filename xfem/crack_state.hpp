// Persistent cracks between frames: from a split to cracks on a mesh, back, and down to fragments.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "common/io/frame.hpp"
#include "common/io/split.hpp"
#include "xfem/crack/path.hpp"

namespace xfem {

/// Cracks of each cracked particle, in stored order.
using CrackState = std::map<std::int64_t, std::vector<Crack>>;

/// Refuses (bad_input) a previous split that cannot precede this frame under this configuration: another
/// configuration hash, a frame number that is not smaller, a cracked particle that the frame does not have, a broken
/// particle that the frame still has.
void check_previous(const common::Split& previous, const common::Frame& frame, const std::string& config_hash);

/// The cracks of a split as they stand there.
CrackState stored_cracks(const common::Split& split);

/// The same crack on `mesh`: itself if its points stand on edges of the mesh (to 1e-9 of the mesh's extent), otherwise
/// placed anew by its geometry; empty if nothing of it remains.
std::optional<Crack> crack_on_mesh(const Mesh& mesh, const Crack& crack);

/// Appends the cracks of one particle to a split; particles must come in ascending order.
void append_cracks(common::Split& split, std::int64_t particle, const std::vector<Crack>& cracks);

/// Cracks that a fragment inherits: those of the parent that do not hang together with the path (`path_cracks`, indices
/// into `cracks`: of a path through three cracks the middle one may lie far from the straight line), and that lie
/// wholly on the fragment's side of the breakage line and nowhere nearer to it than `clearance` [m] (what is nearer
/// opens into it), as polylines in the fragment's own frame (origin at its centroid, the parent's angle). `side` is +1
/// for the left fragment and -1 for the right one.
struct InheritedCrack {
  std::vector<Vec2> polyline;  ///< [m]
  std::array<TipState, 2> tips;
};
std::vector<InheritedCrack> inherited_cracks(const std::vector<Crack>& cracks, const std::vector<int>& path_cracks,
                                             const std::array<Vec2, 2>& path, int side, const Vec2& fragment_centroid,
                                             double clearance);

}  // namespace xfem
