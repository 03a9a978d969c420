// Small frames and splits, and what an error says: shared by the tests of this folder.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include "common/error.hpp"
#include "common/io/contents.hpp"
#include "common/io/frame.hpp"
#include "common/io/hdf5_file.hpp"
#include "common/io/split.hpp"
#include "tests/unit/scratch_folder.hpp"

namespace common_test {

using namespace common;

using Directory = scratch::Folder;

/// Four particles (triangle, square, pentagon-like quadrilateral, triangle) with ids 3, 9, 17, 40 and three contacts.
inline Frame sample_frame() {
  Frame f;
  f.frame = 12;
  f.step = 123456;
  f.time = 0.1 + 0.2;
  f.stage = Stage::shear;
  f.axial_strain = 1.0 / 3.0;
  f.seed = 0xfedcba9876543210u;
  f.next_id = 41;
  f.friction = 0.5;
  f.config_hash = "0123abcd";
  Particles& p = f.particles;
  p.id = {3, 9, 17, 40};
  p.parent = {-1, -1, -1, 2};
  p.root = {3, 9, 17, 2};
  p.generation = {0, 0, 0, 1};
  p.type = {0, 1, 2, -1};
  p.position = {{0, 0}, {1.0 / 3, -2}, {5e-324, 1e300}, {-0.0, 0.7}};
  p.velocity = {{1e-3, 2e-3}, {0, 0}, {-1, 1}, {0.1, 0.2}};
  p.displacement = {{0, 0}, {1e-9, 0}, {0, 0}, {0.5, -0.5}};
  p.angle = {0, 0.3, -7, 1e-17};
  p.angular_velocity = {0, 1, -1, 0.5};
  p.mass = {1, 2, 3, 4};
  p.inertia = {0.1, 0.2, 0.3, 0.4};
  p.area = {0.5, 1, 1.5, 0.5};
  p.boundary = {1, 0, 0, 1};
  p.vertex_offset = {0, 3, 7, 11, 14};
  p.vertices = {{-0.5, -0.4}, {0.5, -0.4}, {0, 0.8}, {-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5},  {-0.5, 0.5},
                {-1, -0.4},   {1, -0.5},   {1, 0.5}, {-1, 0.4},    {-0.3, 0},   {0.3, -0.2}, {0, 0.2}};
  Contacts& c = f.contacts;
  c.a = {3, 3, 9};
  c.b = {9, 17, 40};
  c.point = {{0.1, 0.2}, {0.3, 0.4}, {0.5, 0.6}};
  c.normal = {{1, 0}, {0, 1}, {0.6, -0.8}};
  c.force = {{1e6, 0}, {0, 2e6}, {3e5, -4e5}};
  c.normal_force = {1e6, 2e6, 5e5};
  c.shear_force = {0, 0, 0};
  c.overlap_area = {1e-5, 2e-5, 3e-5};
  c.overlap_width = {1e-2, 2e-2, 3e-2};
  c.shear_displacement = {1e-6, -1e-6, 0};
  f.ring = {40, 3};
  f.history = {{"axial_strain", "1", "since the start of shear", {0.1, 0.2}}, {"step", "1", "", {1, 2}}};
  f.checkpoint = {{"energy", "J", "running sums", {1, 2, 3, 4, 5}}, {"servo", "Pa s", "integral", {}}};
  return f;
}

/// Particle 9 broken in two, 17 cracked, 40 refused; one crack in fragment 41.
inline Split sample_split() {
  Split s;
  s.frame = 12;
  s.frame_hash = "00ff";
  s.config_hash = "abcd";
  s.particles.id = {3, 9, 17, 40};
  s.particles.status = {ParticleStatus::not_breakable, ParticleStatus::broken, ParticleStatus::arrested,
                        ParticleStatus::refused};
  s.particles.mean_stress = {{1e6, 2e6, -3e5}, {0, 0, 0}, {4, 5, 6}, {7, 8, 9}};
  s.particles.min_safety_factor = {std::numeric_limits<double>::quiet_NaN(), 0.9, 0.99,
                                   std::numeric_limits<double>::infinity()};
  s.particles.failure_mode = {FailureMode::none, FailureMode::tension, FailureMode::shear, FailureMode::none};
  s.cracks.particle = {17, 17, 41};
  s.cracks.point_offset = {0, 2, 5, 7};
  s.cracks.points = {{0, 0}, {0.1, 0.1}, {0.2, 0}, {0.3, 0.1}, {0.4, 0.1}, {0, -0.1}, {0.1, -0.2}};
  s.cracks.edge = {{0, 1}, {1, 2}, {3, 4}, {4, 5}, {5, 6}, {0, 2}, {2, 3}};
  s.cracks.edge_fraction = {0.5, 0.25, 0.125, 0.3, 0.4, 0.5, 0.98};
  s.cracks.tip_state = {{0, 1}, {1, 1}, {2, 0}};
  s.broken.parent = {9};
  s.broken.path = {{Vec2(0, -0.5), Vec2(0, 0.5)}};
  s.fragments.id = {41, 42};
  s.fragments.parent = {9, 9};
  s.fragments.vertex_offset = {0, 4, 8};
  s.fragments.vertices = {{-0.5, -0.5}, {0, -0.5}, {0, 0.5}, {-0.5, 0.5}, {0, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {0, 0.5}};
  s.refusals.particle = {40};
  s.refusals.reason = {"crack in element 7: σ is not finite"};
  s.work.screened = 0;
  s.work.solved = 3;
  s.work.growth_steps = 25;
  return s;
}

/// The text and code of the Error that `action` throws; an empty text if it throws none.
struct Thrown {
  std::string text;
  ExitCode code = ExitCode::success;
};
template <class Action>
Thrown error_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return {error.what(), error.code()};
  }
  return {};
}

}  // namespace common_test
