// The whole enriched system, standard and enriched dofs together, evaluated part by part. Shares no matrix with the
// solver: no stiffness, no Schur complement, no condensation.
#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <span>

#include "xfem/crack/cracked_solver.hpp"

namespace growth_walks {

/// A shape function on a part: its gradient times its value of H - H_J (1 for a standard one), and its first dof.
struct Shape {
  xfem::Vec2 gradient;
  Eigen::Index row;  ///< 2 * node, or the number of standard dofs + 2 * function
};

/// Calls visit(area, shapes) for every part of every element, uncut elements being one part.
void for_each_part(const xfem::IntactModel& model, const xfem::Enrichment& enrichment,
                   const std::function<void(double, std::span<const Shape>)>& visit);

struct Residual {
  /// Largest unbalanced force on a dof over the largest load on one and sum of |K_ij x_j|, each divided by the root of
  /// the dof's diagonal entry (Jacobi scaling): with it a dof with a support of 1e-28 of an element counts as much as
  /// any other.
  double scaled = 0;
  /// The same over the largest load alone. Where a part hangs on a last element, it turns far for a small load, and
  /// what rounding of its displacement leaves unbalanced grows with it.
  double over_load = 0;
  /// 1 + the largest sum of |K_ij x_j| over the largest load.
  double amplification = 1;
  /// Largest |mean stress - virial stress| over the sum of the loads times the particle's diameter over its area.
  double virial = 0;
  bool is_finite = true;
};

/// What a state leaves unbalanced under the loads, closed faces (with their friction) and held dofs
/// (whose reactions vanish) included.
Residual residual_of(const xfem::IntactModel& model, std::span<const xfem::Load> loads, double patch,
                     const common::Polygon& outline, const xfem::CrackedState& state);

/// The whole stiffness, standard and enriched, nothing held, with its diagonal scaled to 1.
Eigen::SparseMatrix<double> scaled_stiffness(const xfem::IntactModel& model, const xfem::Enrichment& enrichment);

/// Smallest eigenvalue of the whole stiffness, standard and enriched, three dofs held, diagonal scaled to 1: next to
/// nothing if a part of the particle can move without strain, or if two enriched functions are the same.
double smallest_eigenvalue(const xfem::IntactModel& model, const xfem::Enrichment& enrichment);

}  // namespace growth_walks
