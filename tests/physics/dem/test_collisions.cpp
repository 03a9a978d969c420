// Undamped, frictionless collisions of two random bodies. Oracle: Noether; the force of a law that is the gradient of
// an energy gives back what it took, up to the error of the time integration.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/physics/dem/random_contacts.hpp"

using common::ContactLaw;

namespace {

struct Errors {
  int count = 0;
  double mean = 0, worst = 0;
};

Errors collisions(ContactLaw law, contacts::Bodies bodies, int starts) {
  common::Scene scene;
  scene.effects = {false, false, false, false};
  scene.contact.law = law;
  scene.contact.normal_stiffness = common::stiffness_is_per_area(law) ? 5e9 : 1e9;
  scene.time_step.safety = 0.02;
  Errors errors;
  for (int k = 0; k < starts; ++k) {
    const auto start = contacts::approach(bodies, 1000 + k);
    if (!start) continue;
    const auto collision = contacts::collide(scene, *start);
    if (!collision || collision->depth < 1e-3 || collision->depth > 2e-2) continue;
    ++errors.count;
    errors.mean += std::abs(collision->error);
    errors.worst = std::max(errors.worst, std::abs(collision->error));
  }
  errors.mean /= errors.count;
  return errors;
}

}  // namespace

TEST_CASE("undamped collisions 0.1 to 2 % of a diameter deep keep the energy with the foundation and potential laws") {
  const struct {
    ContactLaw law;
    double mean, worst;
  } bounds[] = {
      {ContactLaw::mean_depth, 0.06, 0.5},
      {ContactLaw::area, 0.01, 0.3},
      {ContactLaw::potential, 2e-6, 1e-4},
      {ContactLaw::foundation, 1e-7, 1e-5},
  };
  for (const auto& bound : bounds) {
    const Errors errors = collisions(bound.law, contacts::Bodies::whole, 400);
    CAPTURE(static_cast<int>(bound.law), errors.count, errors.mean, errors.worst);
    CHECK(errors.count > 100);
    CHECK(errors.mean < bound.mean);
    CHECK(errors.worst < bound.worst);
  }
}

TEST_CASE("among fragments, too, the foundation law keeps the energy of all but rare collisions") {
  const Errors area = collisions(ContactLaw::area, contacts::Bodies::fragments, 400);
  const Errors foundation = collisions(ContactLaw::foundation, contacts::Bodies::fragments, 400);
  CAPTURE(area.count, area.mean, area.worst, foundation.count, foundation.mean, foundation.worst);
  CHECK(foundation.count > 100);
  CHECK(foundation.mean < 0.1 * area.mean);
}
