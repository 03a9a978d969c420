// What a split does to a loaded pile and to single contacts. Oracle: the area law is neutral to a cut, since the
// overlap areas of the pieces add up; no law may set free more kinetic energy than the elastic energy that was stored.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/physics/dem/loaded_pile.hpp"
#include "tests/physics/dem/random_contacts.hpp"

using common::ContactLaw;

TEST_CASE("splits in a loaded pile keep the forces of the area and foundation laws and do not explode with any law") {
  for (const ContactLaw law :
       {ContactLaw::mean_depth, ContactLaw::area, ContactLaw::potential, ContactLaw::foundation}) {
    const piles::SplitEffect effect = piles::split_effect(piles::scene_of(law));
    CAPTURE(static_cast<int>(law), effect.normal, effect.shear, effect.elastic, effect.peak, effect.end);
    CHECK(effect.rest < 0.01);
    CHECK(effect.overlap == Approx(1).epsilon(1e-9));
    if (law == ContactLaw::area) CHECK(effect.normal == Approx(1).epsilon(1e-9));
    if (law == ContactLaw::foundation) CHECK(effect.normal == Approx(1).epsilon(0.01));
    CHECK(effect.normal > 0.7);
    CHECK(effect.normal < 1.5);
    CHECK(effect.shear < 1 + 1e-6);  // never more than the parents carried
    CHECK(effect.shear > 0.8);
    CHECK(effect.peak < std::max(1.0, effect.elastic));
    CHECK(effect.end < 0.05);
  }
}

TEST_CASE("a chord through a contact leaves the sum of its forces to the area and foundation laws alone") {
  const dem::ContactConstants constants{1, 1, 0.47};
  constexpr int kCuts = 1000;
  common::Random random(17);
  contacts::CutForces depth, area, potential, foundation;
  const auto add = [](contacts::CutForces& mean, const contacts::CutForces& f) {
    mean.sum += f.sum / kCuts;
    mean.change += f.change / kCuts;
    mean.energy += f.energy / kCuts;
  };
  double worst_area = 0;
  for (int k = 0; k < kCuts; ++k) {
    const contacts::CutContact cut = contacts::cut_contact(random);
    const contacts::CutForces of_area = contacts::forces_of<dem::AreaLaw>(cut, constants);
    worst_area = std::max(worst_area, std::abs(of_area.sum - 1));
    add(area, of_area);
    add(depth, contacts::forces_of<dem::MeanDepthLaw>(cut, constants));
    add(potential, contacts::forces_of<dem::PotentialLaw>(cut, constants));
    add(foundation, contacts::forces_of<dem::FoundationLaw>(cut, constants));
  }
  CAPTURE(depth.sum, potential.sum, foundation.sum, foundation.energy, area.energy, foundation.change, area.change);
  CHECK(worst_area < 1e-9);
  CHECK(foundation.sum == Approx(1).epsilon(0.01));
  CHECK(foundation.energy == Approx(1).epsilon(0.02));
  CHECK(foundation.change < 0.7 * area.change);
  CHECK(depth.sum > 1.5);
  CHECK(potential.sum < 0.8);
}
