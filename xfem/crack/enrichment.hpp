// Shifted sign-Heaviside enrichment of cracked T3 meshes (Eqs. 1-3 of Raisianzadeh et al. 2019):
//   u(x) = sum_I N_I(x) u_I + sum_J N_J(x) [H(x) - H(x_J)] q_J,   H = +1 left of the crack, -1 right of it.
// H(x) - H(x_J) vanishes in every element that the crack does not cut, so only cut elements carry enrichment.
// In a cut element H is constant on each side of the straight cut: all integrals of T3 are exact.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "xfem/crack/path.hpp"
#include "xfem/crack/short_list.hpp"

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

/// A place in an element by its three shape functions. Near a corner it keeps the digits that coordinates lose.
using Barycentric = std::array<double, 3>;

/// Area of the triangle a, b, c as a fraction of its element's, positive if counter-clockwise.
inline double area_fraction(const Barycentric& a, const Barycentric& b, const Barycentric& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// A piece of a cut element on which the H of every crack is constant.
struct ElementPart {
  ShortList<Barycentric, 4> corners;  ///< counter-clockwise
  double area;                        ///< [m^2]
  ShortList<int, 1> side;             ///< one for each segment of the element
};

/// The short lists need no memory of their own as long as one crack cuts the element, which is the rule.
struct CutElement {
  /// Function `function` acts in the element with the shape function of local node `local`.
  struct Term {
    int function;
    int local;
    int slot;  ///< which of the element's segments is the function's crack
  };
  int element;
  ShortList<int, 1> segments;  ///< indices into Enrichment::segments
  ShortList<ElementPart, 2> parts;
  ShortList<Term, 3> terms;
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

/// Fraction of a node's support that must lie on the other side of the crack; below it the node is not enriched. Points
/// that keep kEdgeClearance stay above it, so that no crack of production is tied together by a dropped node.
inline constexpr double kSmallestSupport = 1e-6;

/// Enriched nodes: the nodes of the cut elements, except those of a tip edge inside the particle. A tip on the
/// boundary is a mouth: its edge's nodes are enriched. So a crack of one or two elements inside has no effect.
/// Precondition: crack_defect is empty for each crack.
Enrichment enrich(const Mesh& mesh, std::span<const Crack> cracks, double smallest_support = kSmallestSupport);

/// Corners of a part in the body frame [m].
Polygon outline(const Mesh& mesh, int element, const ElementPart& part);

}  // namespace xfem
