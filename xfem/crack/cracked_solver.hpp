// Stress of a cracked particle by a bordered Schur complement over the intact factorization:
//   W = K^-1 Kua,  S = Kaa - Kau W,  S q = fa - Kau u0,  u = u0 - W q,
// u0 the intact displacement, q the enriched dofs. The intact factor is never touched. A column of W is computed once
// and kept as long as its column of Kua stays the same, and so is each product of Kau W: a step of growth adds the
// columns of the nodes that it enriches, and their products.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "xfem/crack/edge_loads.hpp"
#include "xfem/crack/enrichment.hpp"
#include "xfem/crack/faces.hpp"
#include "xfem/elasticity/intact_model.hpp"

namespace xfem {

struct CrackedState {
  bool solved = true;   ///< false: the system is singular, a part of the particle is loose
  bool settled = true;  ///< false: contact of the crack faces found no state (solved, but not to be used)
  std::string defect;   ///< why it is not solved, in numbers
  Eigen::VectorXd u;    ///< nodal displacement (2 n) [m]
  Eigen::VectorXd q;    ///< enriched dofs, 2 per function [m]
  Enrichment enrichment;
  std::vector<Stress> stress;  ///< per element, the area average over its parts, compression positive [Pa]
  int closed_segments = 0;     ///< crack segments in contact
  /// Shear stress on each of face_segments(...) that resists its slip [Pa]; empty without friction.
  std::vector<double> face_shear;
};

/// One load case of one particle; the cracks may change from call to call. The result of a call depends on its cracks
/// alone, bit for bit, not on earlier calls.
class CrackedSolver {
 public:
  /// `patch` [m]: see IntactModel::nodal_forces. Keeps a reference to the model.
  /// `face_friction`: Coulomb coefficient of closed crack faces; 0: smooth.
  CrackedSolver(const IntactModel& model, std::span<const Load> loads, double patch = 0, double face_friction = 0);
  /// For given nodal forces (2 n, in balance): they act on the standard dofs only.
  CrackedSolver(const IntactModel& model, Eigen::VectorXd forces, double face_friction = 0);

  const Eigen::VectorXd& intact_displacement() const { return u0_; }

  /// Precondition: crack_defect is empty for each crack. `smallest_support`: see enrich.
  CrackedState solve(std::span<const Crack> cracks, double smallest_support = kSmallestSupport);

 private:
  /// Kua of one node and one function.
  struct Block {
    int node;
    std::array<double, 4> value;  ///< row by row
    bool operator==(const Block&) const = default;
  };
  using Blocks = ShortList<Block, 10>;
  struct Column {
    Blocks stiffness;          ///< ascending nodes
    Eigen::MatrixXd response;  ///< the two columns of W (2 n x 2)
    /// Kau W of this function and the one in each other slot, row by row; NaN: not computed.
    std::vector<std::array<double, 4>> product;
  };

  int slot_of(const EnrichmentFunction& function, const Blocks& stiffness);
  const std::array<double, 4>& product(int row, int column);

  const IntactModel* model_;
  std::vector<Load> loads_;
  double patch_ = 0;
  double face_friction_ = 0;
  Eigen::VectorXd u0_;
  std::optional<EdgeLoads> edge_loads_;  ///< made when the first crack asks for it
  std::vector<Column> columns_;
  std::vector<int> slots_;  ///< into columns_, by crack * nodes + node, -1: none
};

/// Stress of each element under nodal displacements u and enriched dofs q: the area average over its parts.
std::vector<Stress> cracked_stresses(const IntactModel& model, const Enrichment& enrichment, const Eigen::VectorXd& u,
                                     const Eigen::VectorXd& q);

}  // namespace xfem
