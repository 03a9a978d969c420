// Loads on the enriched dofs: contact forces on a cut boundary edge and the body force of the inertia relief.
#pragma once

#include <span>
#include <vector>

#include "xfem/crack/enrichment.hpp"
#include "xfem/elasticity/intact_model.hpp"
#include "xfem/elasticity/loads.hpp"

namespace xfem {

/// One load case as the enriched dofs see it; what does not depend on the cracks is computed once.
class EdgeLoads {
 public:
  /// `patch` [m]: see IntactModel::nodal_forces. Keeps a reference to the model.
  EdgeLoads(const IntactModel& model, std::span<const Load> loads, double patch);

  /// Forces on the enriched dofs (2 per function) [N], so that the virtual work of every enriched displacement is that
  /// of the true forces.
  Eigen::VectorXd forces(const Enrichment& enrichment) const;

  /// Body force per volume of the inertia relief [N/m^3].
  Vec2 body_force(const Vec2& position) const;

  /// Sum of N_J f of the loads that act on a mouth's boundary edge beyond the mouth as seen from `node`, one of the
  /// edge's ends J. Loads act and spread as in IntactModel::nodal_forces; a patch across the mouth is divided there.
  Vec2 beyond_mouth(const CrackPoint& mouth, int node) const;

 private:
  Vec2 integrate_body_force(int element, int local, const ElementPart& part) const;

  const Mesh* mesh_;
  std::vector<Load> loads_;
  double patch_;
  std::vector<int> loop_;     ///< boundary nodes in order
  std::vector<Vec2> points_;  ///< and where they stand
  BodyForce body_;            ///< of the inertia relief
};

}  // namespace xfem
