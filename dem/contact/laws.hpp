// Normal contact laws: what they make of the overlap's area A, width b and outline.
//
//   mean_depth  F = k A / b       k [N/m]    U = k (A / b)^2 / 2   not a gradient; linear in depth at faces
//   area        F = k A           k [N/m^2]  U = k A^2 / (2 b)     not a gradient; neutral to a split (Mirghasemi 1997)
//   potential   F = k A b / L^2   k [N/m]    U = k A^2 / (2 L^2)   F = -dU/dx exactly, since dA/dx = -b n
//                                                                  (Feng & Owen 2004; Feng, Han & Owen 2012)
//   foundation  F = k A + ...     k [N/m^2]  U = k/2 Int d^2 ds    force and moment are the exact gradient; nearly
//                                                                  neutral to a split; linear in depth at faces
//                                                                  (foundation.hpp)
// U is a state function by definition; what a law's force does beyond it is booked as contact_law_work.
#pragma once

#include <cmath>

#include "dem/contact/foundation.hpp"

namespace dem {

using common::Overlap;
using common::OverlapOutline;
using common::Vec2;

/// Constants of a run's contacts.
struct ContactConstants {
  double normal_stiffness = 0;      ///< k above
  double tangential_stiffness = 0;  ///< kt [N/m]
  double length = 1;                ///< L: mean diameter of the scene [m]
  double damping = 0;               ///< share of critical, with effect contact_damping
  double rolling_friction = 0;      ///< mu_r, with effect rolling_resistance
  double rolling_stiffness = 0;     ///< of a contact's rolling spring over R^2, see rolling_resistance.hpp [N/m]
};

struct MeanDepthLaw {
  static constexpr const char* kName = "mean_depth";
  static constexpr bool kGradient = false;
  static constexpr bool kOutline = false;  ///< true: `action` reads the outline
  static NormalAction action(const Overlap& o, const OverlapOutline&, const ContactConstants& c) {
    const double depth = o.area / o.width;
    return {c.normal_stiffness * depth, 0.5 * c.normal_stiffness * depth * depth, o.normal, o.centroid};
  }
  /// Largest dF/d depth of a contact at most `edge` wide [N/m].
  static double stiffness_bound(double, const ContactConstants& c) { return c.normal_stiffness; }
};

struct AreaLaw {
  static constexpr const char* kName = "area";
  static constexpr bool kGradient = false;
  static constexpr bool kOutline = false;
  static NormalAction action(const Overlap& o, const OverlapOutline&, const ContactConstants& c) {
    return {c.normal_stiffness * o.area, 0.5 * c.normal_stiffness * o.area * o.area / o.width, o.normal, o.centroid};
  }
  static double stiffness_bound(double edge, const ContactConstants& c) { return c.normal_stiffness * edge; }
};

struct PotentialLaw {
  static constexpr const char* kName = "potential";
  static constexpr bool kGradient = true;
  static constexpr bool kOutline = false;
  // The moment is a gradient too only about the middle of the chord.
  static NormalAction action(const Overlap& o, const OverlapOutline&, const ContactConstants& c) {
    const double k = c.normal_stiffness / (c.length * c.length);
    return {k * o.area * o.width, 0.5 * k * o.area * o.area, o.normal, o.chord_midpoint};
  }
  static double stiffness_bound(double edge, const ContactConstants& c) {
    return c.normal_stiffness * edge * edge / (c.length * c.length);
  }
};

struct FoundationLaw {
  static constexpr const char* kName = "foundation";
  static constexpr bool kGradient = false;  // not for four crossings and inclusion, which take the area law
  static constexpr bool kOutline = true;
  static NormalAction action(const Overlap& o, const OverlapOutline& outline, const ContactConstants& c) {
    if (o.crossings != 2) return AreaLaw::action(o, outline, c);
    if (outline.size > 0) return foundation_action(o, outline, c.normal_stiffness);
    const double height = std::abs(o.normal.dot(o.centroid - o.chord_midpoint));
    return {c.normal_stiffness * o.area, c.normal_stiffness * o.area * height, o.normal, o.centroid};
  }
  static double stiffness_bound(double edge, const ContactConstants& c) { return AreaLaw::stiffness_bound(edge, c); }
};

}  // namespace dem
