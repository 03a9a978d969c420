// Can this particle fail at all? A bound on its load factor from stored responses to unit forces, without a solve.
//
// The averaged stress of element e under forces w_j on the boundary nodes is linear, s_e = sum_j w_j I_je, with I_je
// the response to a unit force and its inertia relief. 1 / lambda is a function of the stress alone, for s3 of either
// sign
//   g = 1 / lambda = (sqrt(m^2 s3^2 + 4 (s1 - s3)^2) - m s3) / (2 sigma_ci),
// the closed form of HoekBrown::load_factor. I is kept in single precision, g evaluated in it, and a margin added that
// covers every rounding, so that 1 / (max_e g + margin) is a lower bound of the load factor that a solve would find.
//
// The margin. u = 2^-24, N forces, S = sum_j |w_j| max_e |I_je|. A component of s_e is off by at most (N + 3) u S (one
// rounding each of I, w and the product, N - 1 sums); s3 by at most 2.42 and s1 - s3 by 2.83 times that, hence g by
// (2.42 m + 2.83) (N + 3) u S / sigma_ci. Evaluating g in single precision adds at most (17 m + 21) u S / sigma_ci. The
// margin 3 (N + 10) (m + 2) u S / sigma_ci exceeds their sum by more than 1e-8 S m / sigma_ci, which leaves room for
// what sets two solves in double precision apart.
#pragma once

#include <span>
#include <vector>

#include "xfem/criterion/hoek_brown.hpp"
#include "xfem/elasticity/intact_model.hpp"
#include "xfem/elasticity/loads.hpp"

namespace xfem {

class Influence {
 public:
  /// Keeps no reference. Float, 2 B x 3 E values, B boundary nodes and E elements.
  Influence(const IntactModel& model, const StressAverage& average, PolygonView outline);

  struct Bound {
    double safety_factor;  ///< lower bound of the load factor, +inf without forces, 0 if forces are not finite
    Stress mean_stress;    ///< virial, compression positive [Pa]
  };
  /// For the uncracked particle under point loads (in the model's unit of length). Thread-safe.
  Bound bound(std::span<const Load> loads, const HoekBrown& rock) const;

 private:
  BoundaryLoop loop_;
  SecondMoments moments_;
  int nodes_ = 0;                ///< B
  int blocks_ = 0;               ///< of kLanes elements
  std::vector<float> response_;  ///< 2 B columns (node, component) x blocks x (xx, yy, xy) x kLanes elements
  std::vector<double> largest_;  ///< 2 B: max_e |I_je|
};

}  // namespace xfem
