// Whether cracks cut a particle into loose pieces: by topology, before anything is solved. Loose pieces have rigid
// motions of their own (a through cut 3 of them beside the 3 that the supports hold), on which the system is singular.
#pragma once

#include <span>

#include "xfem/crack/enrichment.hpp"

namespace xfem {

/// True if the parts of the elements, joined across the uncut portions of the mesh edges between them, fall into more
/// than one piece. `enrichment`: of these cracks. Purely combinatorial: what counts is the order of the cracks along
/// each edge, never a distance.
bool is_separated(const Mesh& mesh, std::span<const Crack> cracks, const Enrichment& enrichment);

}  // namespace xfem
