// Normal contact laws: force, elastic energy and stiffness bound as functions of the overlap's area A and width b.
//
//   mean_depth  F = k A / b       k [N/m]    U = k (A / b)^2 / 2   not a gradient; linear in depth at faces
//   area        F = k A           k [N/m^2]  U = k A^2 / (2 b)     not a gradient; neutral to a split (Mirghasemi 1997)
//   potential   F = k A b / L^2   k [N/m]    U = k A^2 / (2 L^2)   F = -dU/dx exactly, since dA/dx = -b n
//                                                                  (Feng & Owen 2004; Feng, Han & Owen 2012)
// U is a state function by definition; what a law's force does beyond it is booked as contact_law_work.
#pragma once

#include "common/geometry/overlap.hpp"

namespace dem {

using common::Overlap;
using common::Vec2;

/// Constants of a run's contacts.
struct ContactConstants {
  double normal_stiffness = 0;      ///< k above
  double tangential_stiffness = 0;  ///< kt [N/m]
  double length = 1;                ///< L: mean diameter of the scene [m]
};

struct MeanDepthLaw {
  static constexpr const char* kName = "mean_depth";
  static constexpr bool kGradient = false;
  static double force(const Overlap& o, const ContactConstants& c) { return c.normal_stiffness * o.area / o.width; }
  static double energy(const Overlap& o, const ContactConstants& c) {
    const double depth = o.area / o.width;
    return 0.5 * c.normal_stiffness * depth * depth;
  }
  static const Vec2& point(const Overlap& o) { return o.centroid; }
  /// Largest dF/d depth of a contact at most `edge` wide [N/m].
  static double stiffness_bound(double, const ContactConstants& c) { return c.normal_stiffness; }
};

struct AreaLaw {
  static constexpr const char* kName = "area";
  static constexpr bool kGradient = false;
  static double force(const Overlap& o, const ContactConstants& c) { return c.normal_stiffness * o.area; }
  static double energy(const Overlap& o, const ContactConstants& c) {
    return 0.5 * c.normal_stiffness * o.area * o.area / o.width;
  }
  static const Vec2& point(const Overlap& o) { return o.centroid; }
  static double stiffness_bound(double edge, const ContactConstants& c) { return c.normal_stiffness * edge; }
};

struct PotentialLaw {
  static constexpr const char* kName = "potential";
  static constexpr bool kGradient = true;
  static double force(const Overlap& o, const ContactConstants& c) {
    return c.normal_stiffness * o.area * o.width / (c.length * c.length);
  }
  static double energy(const Overlap& o, const ContactConstants& c) {
    return 0.5 * c.normal_stiffness * o.area * o.area / (c.length * c.length);
  }
  // The moment is a gradient too only about the middle of the chord.
  static const Vec2& point(const Overlap& o) { return o.chord_midpoint; }
  static double stiffness_bound(double edge, const ContactConstants& c) {
    return c.normal_stiffness * edge * edge / (c.length * c.length);
  }
};

}  // namespace dem
