// Shifted sign-Heaviside enrichment of cracked T3 meshes (Eqs. 1-3 of Raisianzadeh et al. 2019):
//   u(x) = sum_I N_I(x) u_I + sum_J N_J(x) [H(x) - H(x_J)] q_J,   H = +1 left of the crack, -1 right of it.
// H(x) - H(x_J) vanishes in every element that the crack does not cut, so only cut elements carry enrichment.
// In a cut element H is constant on each side of the straight cut: all integrals of T3 are exact.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "xfem/crack/path.hpp"

namespace xfem {

/// One crack's straight cut through one element.
struct CrackSegment {
  int crack;
  int element;
  std::array<int, 3> side;  ///< of the element's local nodes, +1 left, -1 right
  CrackPoint first, last;
};

/// An enrichment function N_J [H_c - H_c(x_J)]; it has the dofs 2 k and 2 k + 1, k its index.
struct EnrichmentFunction {
  int crack;
  int node;
  int side;  ///< H_c(x_J)
};

/// A piece of a cut element on which the H of every crack is constant.
struct ElementPart {
  Polygon outline;
  double area;            ///< [m^2]
  std::vector<int> side;  ///< one for each segment of the element
};

struct CutElement {
  /// Function `function` acts in the element with the shape function of local node `local`.
  struct Term {
    int function;
    int local;
    int slot;  ///< which of the element's segments is the function's crack
  };
  int element;
  std::vector<int> segments;  ///< indices into Enrichment::segments
  std::vector<ElementPart> parts;
  std::vector<Term> terms;
};

struct Enrichment {
  std::vector<CrackSegment> segments;         ///< crack by crack, along each crack
  std::vector<CutElement> cut;                ///< ascending by element
  std::vector<EnrichmentFunction> functions;  ///< by crack, then by node

  /// Value of H(x) - H(x_J) of a term on one part: 0 or +-2.
  double jump(const CutElement::Term& term, const ElementPart& part) const {
    return part.side[term.slot] - functions[term.function].side;
  }
};

/// Fraction of a node's support that must lie on the other side of the crack; below it the node is not enriched.
inline constexpr double kSmallestSupport = 1e-4;

/// Enriched nodes: the nodes of the cut elements, except those of a tip edge inside the particle. A tip on the
/// boundary is a mouth: its edge's nodes are enriched. So a crack of one or two elements inside has no effect.
/// Precondition: crack_defect is empty for each crack.
Enrichment enrich(const Mesh& mesh, std::span<const Crack> cracks);

}  // namespace xfem
