// Grading curves given by the user: in a scene, or in a file of their own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace common {

struct Value;

/// A point of a grading curve.
struct GradingPoint {
  double diameter = 0;  ///< longest distance between two vertices [m]
  double passing = 0;   ///< fraction by mass (area) of the particles whose diameter is at most this [-]

  bool operator==(const GradingPoint&) const = default;
};

/// Diameters do not fall, `passing` rises from 0 to 1 and is linear in the diameter between the points. Points of equal
/// diameter are a step: that much of the mass has this one size. Points of equal `passing` are a gap; none stands at
/// either end (readers drop it).
using Grading = std::vector<GradingPoint>;

/// A list of [diameter, passing]. `path` names the key in messages. Throws bad_input at the place of the wrong point.
Grading read_grading(const Value& list, const std::string& path);

/// CSV with rows diameter,passing (header line and lines that start with # are skipped), or YAML with a list as above.
/// The ending .csv means CSV, any other YAML. Throws bad_input with FILE:LINE.
Grading read_grading_file(const std::filesystem::path& file);

/// [[0.1, 0.0], [0.4, 1.0]]
std::string print_grading(const Grading& grading);

/// Diameter [m] of a particle of mean area, shapes being independent of size.
///
/// A particle's area goes with d^2, so mass w spread evenly over [a, b] holds particles in proportion to the integral
/// of w / (b - a) d^-2, which is w / (a b); and the mean of d^2 over all particles is 1 / (sum of w / (a b)).
double diameter_of_mean_area(const Grading& grading);

/// Diameter [m] that the share `number` in [0, 1] of the particles, counted, does not exceed. Within the points a and b
/// the counted share rises with 1/a - 1/d.
double diameter_at(const Grading& grading, double number);

}  // namespace common
