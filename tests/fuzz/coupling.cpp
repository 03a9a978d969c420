#include <fmt/format.h>

#include "common/io/split.hpp"
#include "dem/checkpoint.hpp"
#include "dem/engine.hpp"
#include "dem/fragments.hpp"
#include "dem/measures.hpp"
#include "tests/fuzz/draws.hpp"
#include "tests/unit/dem/bodies.hpp"
#include "xfem/solve_frame.hpp"

namespace fuzz {
namespace {

using common::Polygon;
using common::Vec2;

common::Scene scene_of(Draws& draws) {
  common::Scene scene;
  scene.effects.breakage = true;
  const std::uint8_t effects = draws.byte();
  scene.effects.friction = effects & 1;
  scene.effects.local_damping = effects & 2;
  scene.effects.energy_ledger = effects & 4;
  scene.effects.contact_damping = effects & 8;
  scene.effects.rolling_resistance = effects & 16;
  scene.effects.gravity = effects & 32;
  scene.effects.mass_scaling = effects & 64;
  scene.contact.law = static_cast<common::ContactLaw>(draws.integer(0, 3));
  scene.contact.normal_stiffness =
      (common::stiffness_is_per_area(scene.contact.law) ? 5e9 : 1e9) * std::ldexp(1, draws.integer(-8, 8));
  scene.contact.friction = draws.one_in(4) ? 2 * draws.unit() : 0.5;
  scene.breakage.nodes = draws.integer(20, 40);
  scene.breakage.minimum_area = draws.one_in(2) ? 0.001 : 0;
  return scene;
}

dem::State state_of(Draws& draws, const common::Scene& scene) {
  dem::State state;
  state.friction = scene.contact.friction;
  state.next_id = draws.one_in(16) ? draws.bits<std::int64_t>() >> 1 : draws.byte();
  for (int count = draws.integer(1, 7); count > 0; --count) {
    Polygon outline = draws.polygon(8);
    const double size = draws.one_in(8) ? std::ldexp(1, -draws.integer(0, 12)) : draws.uniform(0.15, 0.3);
    for (Vec2& v : outline) v *= size;
    if (!common::outline_defect(outline).empty()) continue;
    const Vec2 center = common::centroid(outline);
    for (Vec2& v : outline) v -= center;
    if (!common::outline_defect(outline).empty()) continue;
    const Vec2 at = draws.one_in(24) ? Vec2{draws.number(1), draws.number(1)}
                                     : Vec2{draws.uniform(-0.5, 0.5), draws.uniform(-0.5, 0.5)};
    if (state.next_id >= std::numeric_limits<std::int64_t>::max() - 8) break;
    bodies::add(state, outline, at, draws.one_in(24) ? draws.number(7) : draws.uniform(-7, 7));
    auto& p = state.particles;
    if (draws.one_in(3)) {
      state.ring.push_back(static_cast<std::int32_t>(p.size()) - 1);
      p.boundary.back() = 1;
    }
    if (draws.flag()) p.velocity.back() = Vec2{draws.number(1), draws.number(1)};
    if (draws.flag()) p.angular_velocity.back() = draws.number(10);
    if (draws.one_in(32)) p.mass.back() = std::abs(draws.number(1));
  }
  return state;
}

}  // namespace

void coupling(Input input) {
  Draws draws(input);
  const common::Scene scene = scene_of(draws);
  dem::State start = state_of(draws, scene);
  const double density = scene.material.density;
  xfem::FrameSolver solver(scene, 1);
  common::Split previous;
  bool has_previous = false;

  unless_refused([&] {
    dem::Engine engine(scene, std::move(start));
    engine.restart();
    for (int number = 0; number < 3; ++number) {
      for (int steps = draws.integer(0, 20); steps > 0; --steps) engine.step({-0.01, 0.02});
      // The frame goes through its file, as a checkpoint and as the contact state that xfem reads.
      common::Frame frame = dem::to_frame(engine.state(), scene, common::Stage::shear);
      frame.frame = number;
      const std::filesystem::path path = scratch() / "frame.h5";
      common::write_frame(path, frame, {});
      common::Frame read;
      must("a frame that was written cannot be read", [&] { read = common::read_frame(path); });
      require(read.payload_hash == frame.payload_hash, "another payload after reading");
      dem::State state = dem::to_state(read);
      common::Split split = solver.solve(read, has_previous ? &previous : nullptr);
      const std::filesystem::path split_path = scratch() / "split.h5";
      must("the answer to a valid frame cannot be written", [&] { common::write_split(split_path, split, {}); });
      must("a split that was written cannot be read", [&] { previous = common::read_split(split_path); });
      has_previous = true;
      require(previous.payload_hash == split.payload_hash, "another payload of the split after reading");
      engine.edit() = std::move(state);
      engine.restart();
      const dem::SplitReport report = dem::apply_split(engine.edit(), previous, density);
      require(report.area_error <= 1e-9, "area of the fragments");
      engine.restart();
      dem::share_inherited_history(engine.edit(), report);
      engine.restart();
    }
  });
}

}  // namespace fuzz
