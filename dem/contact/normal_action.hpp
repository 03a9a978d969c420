// What a normal law makes of an overlap.
#pragma once

#include "common/geometry/vec2.hpp"

namespace dem {

struct NormalAction {
  double force = 0;     ///< >= 0 [N]
  double energy = 0;    ///< state function of the law [J]
  common::Vec2 normal;  ///< unit; the force on b
  common::Vec2 point;   ///< application point [m]
};

}  // namespace dem
