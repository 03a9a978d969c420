// Uniaxial compression of a block between smooth platens: a uniform field s1 = sigma, s3 = 0.
//
// First failure and breakage at sigma_ci * width; the failure plane stands at pi/4 - phi/2 from the load axis, with
// sin(phi) = (k - 1) / (k + 1) and k = 1 + m / 2, the slope of the envelope at s3 = 0. Smooth platens are a uniform
// traction: the consistent nodal forces of the mesh edges on the two faces. In a uniform field every element fails at
// once; where the crack starts is then a tie that rounding and the order of elements settle, and means nothing.
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "xfem/lab/laboratory.hpp"

namespace xfem {

namespace {

/// Consistent nodal forces of a traction [Pa] in direction y on the mesh edges of the face y = `level`.
void add_traction(const Mesh& mesh, double level, double traction, std::vector<Load>& loads) {
  const auto on_face = [&](int node) { return mesh.nodes[node].y() == level; };
  std::vector<double> length(mesh.nodes.size(), 0.0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][(k + 1) % 3], b = mesh.triangles[t][(k + 2) % 3];
      if (mesh.neighbours[t][k] >= 0 || !on_face(a) || !on_face(b)) continue;
      const double half = 0.5 * std::abs(mesh.nodes[a].x() - mesh.nodes[b].x());
      length[a] += half;
      length[b] += half;
    }
  for (std::size_t i = 0; i < length.size(); ++i)
    if (length[i] > 0) loads.push_back({mesh.nodes[i], {0, traction * length[i]}});
}

}  // namespace

LabSetup uniaxial_test(const common::LabTest& test) {
  if (test.loading.confining_stress != 0 || test.loading.platen_friction != 0 || test.loading.patch != 0)
    throw common::bad_input(
        "loading: a uniaxial test has smooth platens: no confining_stress, platen_friction or patch");
  LabSetup setup;
  setup.test = "uniaxial";
  const double x = 0.5 * test.specimen.width, y = 0.5 * test.specimen.height;
  setup.outline = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};

  const double strength = test.material.sigma_ci;
  setup.theory_load = strength * test.specimen.width;
  const double k = 1 + 0.5 * test.material.m_i;
  const double angle = 0.25 * std::numbers::pi - 0.5 * std::asin((k - 1) / (k + 1));
  setup.theory = {{"first_failure_load", setup.theory_load},
                  {"uniaxial_strength", strength},
                  {"fracture_angle_deg", angle * 180 / std::numbers::pi}};
  setup.unit_load = setup.theory_load;
  setup.loads = [y, strength](const Mesh& mesh) {
    std::vector<Load> loads;
    add_traction(mesh, -y, strength, loads);
    add_traction(mesh, y, -strength, loads);
    return loads;
  };
  return setup;
}

}  // namespace xfem
