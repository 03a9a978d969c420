#include <fmt/format.h>

#include "common/io/hdf5_file.hpp"
#include "dem/checkpoint.hpp"
#include "dem/engine.hpp"
#include "dem/fragments.hpp"
#include "tests/fuzz/draws.hpp"
#include "tests/unit/xfem/sample_frame.hpp"
#include "xfem/solve_frame.hpp"

namespace fuzz {
namespace {

using common::Contents;
using common::Item;

/// A frame of two particles under load besides the walls, and the split of the frame before it, with cracks and a
/// broken particle (which the frame does not have).
struct Samples {
  common::Scene scene = sample::scene();
  Contents frame, split;

  Samples() {
    scene.breakage.nodes = 40;
    common::Frame now = sample::walls();
    sample::add_pressed(now, sample::regular(6, 0.25), {0, 0}, 0.3, {1.5e7, 0.2});
    sample::add_pressed(now, sample::regular(5, 0.25), {1, 0}, 1.3, {6e6, 0.37});
    sample::add_pressed(now, sample::regular(5, 0.25), {2, 0}, 0.7, {1.8e7, 0.74, 0.3});
    sample::sort_contacts(now.contacts);
    now.contacts.shear_displacement.emplace(now.contacts.size(), 1e-6);
    for (int wall = 0; wall < sample::kWalls; ++wall) now.ring.push_back(wall);
    now.history.push_back({"axial_strain", "-", "of the row", {0.1, 0.2}});
    now.checkpoint.push_back({"time_step", "s", "dt", {1e-5}});
    const std::filesystem::path path = scratch() / "sample.h5";
    common::write_frame(path, now, {});
    common::Split of_now = xfem::FrameSolver(scene, 1).solve(now, nullptr);
    require(of_now.broken.parent.size() >= 1 && of_now.cracks.particle.size() >= 1, "the sample has no cracks");
    common::write_split(scratch() / "sample_split.h5", of_now, {});
    split = common::read_hdf5(scratch() / "sample_split.h5");
    frame = common::read_hdf5(path);
    // Of the next frame: the broken particles gone would need a run of dem; here they go by another number.
    frame["@frame"] = common::scalar_item(std::int64_t{8});
  }
};

std::size_t width_of(const std::string& type) {
  if (type == "string") return 0;
  return std::stoul(type.substr(type.find_first_of("123468"))) / 8;
}

std::size_t count_of(const std::vector<std::uint64_t>& shape) {
  std::size_t count = 1;
  for (const std::uint64_t n : shape) count *= n;
  return count;
}

/// Bytes as many as type and shape demand, the old ones first.
void fit(Item& item) {
  const std::size_t count = count_of(item.shape);
  if (item.type != "string") {
    item.bytes.resize(count * width_of(item.type));
    return;
  }
  std::vector<std::string> texts(count, "x");
  item.bytes = common::text_array_item(texts).bytes;
}

void change(Draws& draws, Contents& contents) {
  auto at = std::next(contents.begin(), static_cast<std::ptrdiff_t>(draws.bits<std::uint16_t>() % contents.size()));
  Item& item = at->second;
  const std::size_t width = item.type == "string" || item.type == "other" ? 0 : width_of(item.type);
  switch (draws.integer(0, 9)) {
    case 0:
      contents.erase(at);
      return;
    case 1: {
      constexpr const char* kTypes[] = {"int8",   "int32",   "int64",   "uint8",  "uint32",
                                        "uint64", "float32", "float64", "string", "int16"};
      item.type = kTypes[draws.integer(0, 9)];
      fit(item);
      return;
    }
    case 2:
      if (item.shape.empty()) {
        item.shape = {static_cast<std::uint64_t>(draws.integer(0, 3))};
      } else {
        item.shape[draws.byte() % item.shape.size()] = static_cast<std::uint64_t>(draws.integer(0, 40));
      }
      fit(item);
      return;
    case 3:
      if (draws.flag()) item.shape.push_back(static_cast<std::uint64_t>(draws.integer(0, 3)));
      if (!item.shape.empty()) item.shape.pop_back();
      fit(item);
      return;
    case 4: {  // another item's values
      const auto other =
          std::next(contents.begin(), static_cast<std::ptrdiff_t>(draws.bits<std::uint16_t>() % contents.size()));
      item = Item(other->second);
      return;
    }
    case 5:  // one row more or less, so that several arrays may stay of one length
      if (item.shape.empty() || width == 0) return;
      item.shape[0] += draws.flag() || item.shape[0] == 0 ? 1 : std::uint64_t(-1);
      fit(item);
      return;
    default: {  // one value
      if (width == 0 || item.bytes.empty()) return;
      const std::size_t entry = draws.bits<std::uint16_t>() % (item.bytes.size() / width);
      char* value = item.bytes.data() + entry * width;
      if (item.type == "float64") {
        double number = 0;
        std::memcpy(&number, value, 8);
        number = draws.flag() ? draws.number(1) : number * draws.number(2);
        std::memcpy(value, &number, 8);
      } else {
        std::int64_t number = 0;
        std::memcpy(&number, value, std::min<std::size_t>(width, 8));
        const int kind = draws.integer(0, 3);
        if (kind == 0) number += draws.integer(-4, 4);
        if (kind == 1) number = draws.integer(-1, 20);
        if (kind == 2) number = draws.bits<std::int64_t>();
        if (kind == 3) number = std::numeric_limits<std::int64_t>::max() >> (8 * (8 - width));
        std::memcpy(value, &number, width);
      }
    }
  }
}

}  // namespace

void files(Input input) {
  static const Samples samples;
  Draws draws(input);
  Contents frame_contents = samples.frame, split_contents = samples.split;
  for (int changes = draws.integer(0, 3); changes > 0; --changes) change(draws, frame_contents);
  for (int changes = draws.integer(0, 3); changes > 0; --changes) change(draws, split_contents);
  const std::filesystem::path frame_path = scratch() / "frame.h5", split_path = scratch() / "split.h5";
  common::write_hdf5(frame_path, frame_contents, {});
  common::write_hdf5(split_path, split_contents, {});

  common::Frame frame, state;
  common::Split split, answer;
  const bool complete = unless_refused([&] { state = common::read_frame(frame_path); });
  const bool has_split = unless_refused([&] { split = common::read_split(split_path); });
  if (complete) {
    unless_refused([&] {
      common::Scene scene = samples.scene;
      scene.effects.friction = true;
      dem::Engine engine(scene, dem::to_state(state));
      engine.restart();
      if (has_split) dem::apply_split(engine.edit(), split, scene.material.density);
      engine.restart();
      engine.step({});
      common::Frame next = dem::to_frame(engine.state(), scene, common::Stage::shear);
      common::write_frame(scratch() / "next.h5", next, {});
    });
  }
  if (!unless_refused([&] { frame = common::read_frame(frame_path, common::FrameContent::contact_state); })) return;
  xfem::FrameSolver solver(samples.scene, 1);
  if (!unless_refused([&] { answer = solver.solve(frame, has_split ? &split : nullptr); })) return;
  // What the solver says of a frame that the reader takes, the writer and the reader take too.
  must("the answer to a valid frame cannot be written",
       [&] { common::write_split(scratch() / "answer.h5", answer, {}); });
  must("the answer to a valid frame cannot be read", [&] { common::read_split(scratch() / "answer.h5"); });
}

}  // namespace fuzz
