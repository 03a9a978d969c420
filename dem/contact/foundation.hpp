// The contact as an elastic foundation on the chord: forces that are the exact gradient of a stored energy.
//
// Coordinates: origin at one crossing, s along the chord (0 <= s <= b), y along its normal n, from a to b. The overlap
// lies between the piece of a's boundary, y_a(s) >= 0, and that of b's, y_b(s) <= 0; its depth is d = y_a - y_b and
//
//   U = k/2 Int d^2 ds = k (Int Int |y| dA - Int y_a y_b ds)                                       k in N/m^2
//
// (the second form also where a boundary overhangs an end of the chord; the last integral runs over 0 <= s <= b).
// If one of the boundaries is straight, y_a y_b = 0: then U = k A |y of the centroid|, and its gradient is the force
// k A n through the centroid, which is the area law. Else, with
//
//   T = Int y_a y_b' ds,  W_a = Int y_a' y_a y_b ds,  W_b = Int y_b' y_a y_b ds
//
// a motion of b with the chord's line held feels the pressure k d on b's boundary, that is on b
//
//   f_n = k A,  f_t = -k T,  moment about the origin k (A s_centroid + W_b)
//
// and the line itself turns by the motion of its ends: dU/d(n . c_1) = -E, dU/d(n . c_2) = E, E = k (W_a + W_b) / b.
// A crossing c slides along a's edge, dc = t_a (m_b . dx) / (m_b . t_a) with m_b the normal of b's edge there, so each
// end adds the force -dU/d(n . c) (n . t_a) / (m_b . t_a) m_b on b at c. The factor is sin(alpha_a) / sin(alpha_a +
// alpha_b), with the angles between chord and edges: bounded, also for edges that cross at a shallow angle. What
// overhangs an end by the area O acts on the line as well: k O at its centroid, for b along n and for a against it,
// and a's does not press on b.
// The energy does not change when both bodies move together, so one force on one line serves both.
#pragma once

#include "common/geometry/overlap.hpp"
#include "dem/contact/normal_action.hpp"

namespace dem {

/// The action of a contact with two crossings and corners of both bodies in the overlap. `outline`: of the overlap.
///
/// T, W_a and W_b are small in d/b. Where the overlap is deeper than the chord is wide they are not, the chord loses
/// its meaning, and the action is limited: force and moment differ from those of the area law by at most k A / 2 and k
/// A b / 2 (continuously; the energy is not conserved there).
NormalAction foundation_action(const common::Overlap& overlap, const common::OverlapOutline& outline, double stiffness);

}  // namespace dem
