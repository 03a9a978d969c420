// Stress of a cracked particle by a bordered Schur complement over the intact factorization:
//   W = K^-1 Kua,  S = Kaa - Kau W,  S q = fa - Kau u0,  u = u0 - W q,
// u0 the intact displacement, q the enriched dofs. The intact factor is never touched; a column of W is computed once
// and kept as long as its column of Kua stays the same.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "xfem/crack/enrichment.hpp"
#include "xfem/crack/faces.hpp"
#include "xfem/elasticity/intact_model.hpp"

namespace xfem {

struct CrackedState {
  bool solved = true;  ///< false: the system is singular, a part of the particle is loose
  Eigen::VectorXd u;   ///< nodal displacement (2 n) [m]
  Eigen::VectorXd q;   ///< enriched dofs, 2 per function [m]
  Enrichment enrichment;
  std::vector<Stress> stress;  ///< per element, the area average over its parts, compression positive [Pa]
  int closed_segments = 0;     ///< crack segments in contact
};

/// One load case of one particle; the cracks may change from call to call. The result of a call depends on its cracks
/// alone, not on earlier calls.
class CrackedSolver {
 public:
  /// `patch` [m]: see IntactModel::nodal_forces. Keeps a reference to the model.
  CrackedSolver(const IntactModel& model, std::span<const Load> loads, double patch = 0);
  /// For given nodal forces (2 n, in balance): they act on the standard dofs only.
  CrackedSolver(const IntactModel& model, Eigen::VectorXd forces);

  const Eigen::VectorXd& intact_displacement() const { return u0_; }

  /// Precondition: crack_defect is empty for each crack, and none crosses the particle.
  CrackedState solve(std::span<const Crack> cracks);

 private:
  using Block = std::pair<int, Eigen::Matrix2d>;  ///< node, Kua of this node and one function
  struct Column {
    std::vector<Block> stiffness;             ///< ascending nodes
    std::array<Eigen::VectorXd, 2> response;  ///< the two columns of W
  };

  const Column& column(const EnrichmentFunction& function, std::vector<Block> stiffness);

  const IntactModel* model_;
  std::vector<Load> loads_;
  double patch_ = 0;
  Eigen::VectorXd u0_;
  std::map<std::pair<int, int>, Column> columns_;  ///< by crack and node
};

/// Forces on the enriched dofs (2 per function) [N]: the loads on cut boundary edges and the body force of the inertia
/// relief, so that the virtual work of every enriched displacement is that of the true forces.
Eigen::VectorXd enriched_forces(const IntactModel& model, const Enrichment& enrichment, std::span<const Load> loads,
                                double patch = 0);

/// Stress of each element under nodal displacements u and enriched dofs q: the area average over its parts.
std::vector<Stress> cracked_stresses(const IntactModel& model, const Enrichment& enrichment, const Eigen::VectorXd& u,
                                     const Eigen::VectorXd& q);

}  // namespace xfem
