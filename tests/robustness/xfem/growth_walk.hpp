// Random growth of random cracks in random particles, without any criterion: what the solver of cracked particles must
// survive. A walk is one particle under one set of loads; it is a pure function of its family, size and number.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace growth_walks {

struct Family {
  const char* name;
  const char* what;
  bool clear_of_nodes = true;  ///< points keep kEdgeClearance, as production does; false: the layer below
  double snap = 0;             ///< share of points put beside the nearest node, log-uniformly 1e-28 to 0.3 edges off it
  double mouth = 0.2;          ///< share of cracks that start at the boundary, at corners with `snap`
  double kink = 0.3;           ///< how much the heading changes from step to step [rad]
  double wander = 0.05;        ///< share of steps that leave by any edge whatever the heading
  int most_cracks = 3;
  bool share_elements = false;  ///< cracks cross one another; else a tip ends before a cut element
  bool near_others = false;     ///< further cracks start beside an element that is cut already
  bool driven = false;          ///< by the criterion of production, in rock far too weak for its loads
};

std::span<const Family> families();
const Family* family_named(const std::string& name);

struct Tally {
  std::int64_t walks = 0;
  std::int64_t steps = 0;      ///< states solved for, one element of one tip each
  std::int64_t separated = 0;  ///< of them: recognized as loose by topology, and taken back
  std::int64_t hinged = 0;     ///< not solved: in one piece, but one that turns about a node, to within rounding
  std::int64_t singular = 0;   ///< not solved although whole
  std::int64_t refused = 0;    ///< tips that no valid point took on (into their own crack, round a node): arrested
  std::int64_t merged = 0;     ///< tips that ran into another crack
  std::int64_t impure = 0;     ///< states with other bits than those of a new solver
  std::int64_t not_finite = 0;
  std::int64_t over_limit = 0;  ///< scaled residual above kResidualLimit, with friction kFrictionResidualLimit
  std::int64_t unsettled = 0;   ///< contact found no state: such a particle is refused, its residual not looked at
  std::int64_t virial_over_limit = 0;
  std::int64_t turned = 0;  ///< states with more than 1e-10 of the load unbalanced, on a part that turns far
  std::int64_t closed = 0;  ///< states with faces in contact
  double worst_residual = 0, worst_over_load = 0, worst_virial = 0;
  std::int64_t worst_walk = -1;  ///< of the worst residual
  double smallest_part = 1;      ///< area over that of its element
  std::int64_t most_functions = 0;
  std::vector<std::string> failures;  ///< cases, at most 20

  std::int64_t wrong() const { return singular + unsettled + impure + not_finite + over_limit + virial_over_limit; }
  void add(const Tally& other);
};

inline constexpr double kResidualLimit = 1e-12;
/// The bounds on the shear settle to 1e-9 of the largest.
inline constexpr double kFrictionResidualLimit = 1e-10;
/// Below this the oracle of the whole system calls it loose too; the solver's own limit is a pivot of 1e-8.
inline constexpr double kLooseEigenvalue = 1e-7;
/// Times the amplification: a mean stress cannot be better than the displacements that it comes from.
inline constexpr double kVirialLimit = 1e-14;

/// One walk of at most `steps` steps. `every`: each so many steps are compared with a new solver, 0: none. `friction`:
/// of closed faces.
Tally walk(const Family& family, int nodes, std::int64_t number, int steps, int every, double friction = 0);

}  // namespace growth_walks
