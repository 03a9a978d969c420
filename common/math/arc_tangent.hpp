// Arc tangent whose bits do not depend on the machine (see trigonometry.hpp for the reason).
#pragma once

namespace common {

/// Angle of the vector (x, y) from the x axis [rad], in [-pi, pi], to 2 units in the last place; the signs of zeros as
/// in std::atan2. Finite arguments whose sizes differ by less than 1e150.
/// Reduction to the nearest of atan(k/8), k = 0..8: atan(t) = atan(c) + atan((t - c) / (1 + c t)), then Taylor.
double arc_tangent2(double y, double x);

}  // namespace common
