// The whole state of an assembly: plain arrays that the step advances and a frame stores.
#pragma once

#include <cstdint>
#include <vector>

#include "common/io/frame.hpp"

namespace dem {

using common::Particles;
using common::Polygon;
using common::PolygonView;
using common::Vec2;

/// A contact in force. Indices into the particle arrays, a < b; the list ascends by (a, b).
struct Contact {
  std::int32_t a = 0, b = 0;
  Vec2 point = Vec2::Zero();      ///< application point [m], world
  Vec2 normal = Vec2::Zero();     ///< unit, from a to b
  double normal_force = 0;        ///< >= 0 [N]
  double shear_force = 0;         ///< along (-n_y, n_x), on b [N]
  double shear_displacement = 0;  ///< tangential spring history [m]
  double rolling_moment = 0;      ///< of the rolling resistance, on b [N m]
  double overlap_area = 0;        ///< [m^2]
  double overlap_width = 0;       ///< [m]
  double elastic_normal = 0;      ///< state function of the normal law [J]

  Vec2 force() const { return normal_force * normal + shear_force * common::perpendicular(normal); }
};

/// Running sums of energies [J] since the start of shear (DESIGN section 2, energy ledger).
struct EnergySums {
  double boundary_work = 0;
  double friction = 0;
  double damping = 0;
  double contact_damping = 0;
  double rolling = 0;
  double gravity_work = 0;
  double contact_law_work = 0;
  double released_by_breakage = 0;
};

struct State {
  Particles particles;
  std::vector<Contact> contacts;
  std::vector<std::int32_t> ring;  ///< indices of the boundary particles in order around the assembly
  std::int64_t step = 0;
  double time = 0;       ///< [s]
  double time_step = 0;  ///< dt [s]
  double friction = 0;   ///< coefficient in force
  std::int64_t next_id = 0;
  EnergySums energy;
};

}  // namespace dem
