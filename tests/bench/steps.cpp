// Whole steps of a dense assembly, for wall time, threads and instruction counts.
//   steps SAMPLE.h5 CASE.yaml [STEPS [TILES [THREADS [rest|shear]]]]
// SAMPLE.h5 is a prepared sample of CASE.yaml. TILES > 1 lays TILES x TILES copies of the square inside the sample side
// by side, leaves out what would overlap, and presses them together: 4 and 10 make about 7,000 and 80,000 particles of
// 1194.
//   valgrind --tool=callgrind --toggle-collect='dem::Engine::step*' .../steps SAMPLE.h5 CASE.yaml 100
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "common/config/scene.hpp"
#include "common/io/frame.hpp"
#include "dem/checkpoint.hpp"
#include "dem/engine.hpp"

namespace {

using common::Vec2;

constexpr double kContactsEach = 1.8;  // per particle, as in the sample
constexpr int kLongestSettling = 5000;

void append(dem::Particles& to, const dem::Particles& from, std::size_t i, const Vec2& shift) {
  const auto id = static_cast<std::int64_t>(to.size());
  to.id.push_back(id);
  to.parent.push_back(-1);
  to.root.push_back(id);
  to.generation.push_back(0);
  to.type.push_back(from.type[i]);
  to.position.push_back(from.position[i] + shift);
  to.velocity.push_back(Vec2::Zero());
  to.displacement.push_back(Vec2::Zero());
  to.angle.push_back(from.angle[i]);
  to.angular_velocity.push_back(0);
  to.mass.push_back(from.mass[i]);
  to.inertia.push_back(from.inertia[i]);
  to.area.push_back(from.area[i]);
  to.boundary.push_back(0);
  const common::PolygonView outline = from.outline(i);
  to.vertices.insert(to.vertices.end(), outline.begin(), outline.end());
  to.vertex_offset.push_back(static_cast<std::int64_t>(to.vertices.size()));
}

common::Polygon world_outline(const dem::Particles& p, std::size_t i, const Vec2& shift) {
  common::Polygon world;
  const common::Rotation rotation(p.angle[i]);
  for (const Vec2& v : p.outline(i)) world.push_back(p.position[i] + shift + rotation * v);
  return world;
}

/// The copies; a particle that reaches over an edge of the square stays only if its copies at the other edge do not
/// overlap it.
dem::State tiled(const dem::State& sample, int tiles) {
  const dem::Particles& p = sample.particles;
  double radius = 0;
  for (const Vec2& x : p.position) radius = std::max(radius, x.norm());
  const double half = 0.6 * radius;
  std::vector<std::size_t> inside;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec2& x = p.position[i];
    if (std::abs(x.x()) > half || std::abs(x.y()) > half) continue;
    bool fits = true;
    for (const std::size_t j : inside) {
      for (int dx = -1; dx <= 1 && fits; ++dx) {
        for (int dy = -1; dy <= 1 && fits; ++dy) {
          const Vec2 shift(2 * half * dx, 2 * half * dy);
          if ((dx == 0 && dy == 0) || (p.position[j] + shift - x).norm() > 0.6) continue;
          fits = common::overlap(world_outline(p, i, Vec2::Zero()), world_outline(p, j, shift)).area < 1e-4;
        }
      }
    }
    if (fits) inside.push_back(i);
  }
  dem::State state;
  state.friction = sample.friction;
  for (int row = 0; row < tiles; ++row) {
    for (int column = 0; column < tiles; ++column) {
      const Vec2 shift(2 * half * (column - 0.5 * (tiles - 1)), 2 * half * (row - 0.5 * (tiles - 1)));
      for (const std::size_t i : inside) append(state.particles, p, i, shift);
    }
  }
  state.next_id = static_cast<std::int64_t>(state.particles.size());
  for (std::size_t i = 0; i < state.particles.size(); ++i) {
    const Vec2& x = state.particles.position[i];
    const double edge = half * tiles - 0.6;
    state.particles.boundary[i] = std::abs(x.x()) > edge || std::abs(x.y()) > edge;
  }
  return state;
}

double user_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

double peak_kilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return std::fprintf(stderr, "steps SAMPLE.h5 CASE.yaml [STEPS [TILES [THREADS [rest|shear]]]]\n"), 2;
  const auto option = [&](int k, const char* otherwise) { return std::string(argc > k ? argv[k] : otherwise); };
  const int steps = std::atoi(option(3, "1000").c_str());
  const int tiles = std::atoi(option(4, "1").c_str());
  const int threads = std::atoi(option(5, "1").c_str());
  const bool shear = option(6, "rest") == "shear";

  const common::Scene scene = common::read_scene(argv[2]);
  dem::State sample = dem::to_state(common::read_frame(argv[1]));
  const double before = peak_kilobytes();
  dem::Engine engine(scene, tiles > 1 ? tiled(sample, tiles) : std::move(sample), threads);
  const auto count = static_cast<double>(engine.clock().particles.size());
  if (tiles > 1) {
    int settling = 0;
    const auto enough = static_cast<std::int64_t>(kContactsEach * count);
    while (engine.contacts() < enough && ++settling < kLongestSettling) engine.step({0.2, 0.2});
    for (int k = 0; k < 100; ++k) engine.step({});
  }

  const dem::StrainRate rate = shear ? dem::StrainRate{-0.01, 0.02} : dem::StrainRate{};
  const std::int64_t contact_steps = engine.contact_steps();
  const double user = user_seconds();
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < steps; ++k) engine.step(rate);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto done = static_cast<double>(engine.contact_steps() - contact_steps);
  std::printf(
      "particles %.0f, contacts %.0f, %s, threads %d: %.4f ms per step, %.1f ns per contact-step (wall), "
      "user %.1f ns; memory of the whole process %.2f KB per particle (%.2f above the sample)\n",
      count, done / steps, shear ? "shear" : "rest", threads, 1e3 * wall / steps, 1e9 * wall / done,
      1e9 * (user_seconds() - user) / done, peak_kilobytes() / count, (peak_kilobytes() - before) / count);
}
