// Loops in blocks, and the engine that runs on them: the same bits for any number of threads.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "common/config/scene.hpp"
#include "common/error.hpp"
#include "dem/engine.hpp"
#include "dem/stages/control.hpp"
#include "dem/stages/generate.hpp"
#include "dem/team.hpp"

using common::Vec2;

TEST_CASE("a team visits every entry once, loop after loop") {
  for (const int threads : {1, 2, 3, 7}) {
    dem::Team team(threads);
    for (const std::size_t entries : {0u, 1u, 63u, 64u, 65u, 1000u}) {
      std::vector<int> visits(entries, 0);
      for (int loop = 0; loop < 50; ++loop) {
        team.for_blocks(entries, [&](std::size_t, std::size_t first, std::size_t last) {
          for (std::size_t i = first; i < last; ++i) ++visits[i];
        });
      }
      CHECK(std::count(visits.begin(), visits.end(), 50) == static_cast<std::ptrdiff_t>(entries));
    }
  }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they need address space of their own
TEST_CASE("a team that cannot have all its threads says so, and ends those that it has") {
  // Address space for some stacks only. In a process of its own: the limit stays.
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const rlimit limit{rlim_t{1} << 30, rlim_t{1} << 30};
    bool refused = false;
    if (setrlimit(RLIMIT_AS, &limit) == 0) {
      try {
        dem::Team team(1024);
      } catch (const common::Error& error) {
        refused = error.code() == common::ExitCode::bad_input;
      }
    }
    _exit(refused ? 0 : 1);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK((WIFEXITED(status) && WEXITSTATUS(status) == 0));
}
#endif

TEST_CASE("sums over blocks have the same bits for any number of threads") {
  std::vector<double> values(10000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 1.0 / static_cast<double>(3 * i + 1);
  const auto sum = [&](int threads) {
    dem::Team team(threads);
    std::vector<double> scratch;
    return team.sum_blocks(values.size(), scratch, [&](std::size_t first, std::size_t last) {
      double part = 0;
      for (std::size_t i = first; i < last; ++i) part += values[i];
      return part;
    });
  };
  const double one = sum(1);
  CHECK(one == Approx(3.85).epsilon(0.1));
  for (const int threads : {2, 3, 4, 8}) CHECK(sum(threads) == one);
}

TEST_CASE("an assembly moves to the same bits on any number of threads") {
  common::Scene scene;
  scene.effects = {.friction = true, .local_damping = true, .energy_ledger = true};
  scene.assembly.particles = 200;
  const auto run = [&](int threads) {
    dem::State state;
    state.particles = dem::generate_assembly(scene.assembly, scene.material.density, 4);
    state.friction = 0.5;
    dem::Engine engine(scene, std::move(state), threads);
    for (Vec2& x : engine.edit().particles.position) x *= 0.87;
    dem::renew_ring(engine);
    for (int k = 0; k < 400; ++k) engine.step({0.2, 0.4});
    return engine.state();
  };
  const dem::State one = run(1);
  REQUIRE(one.contacts.size() > 100);
  for (const int threads : {2, 3, 4}) {
    const dem::State other = run(threads);
    const auto same = [](const auto& l, const auto& r) {
      return l.size() == r.size() && std::memcmp(l.data(), r.data(), l.size() * sizeof(l[0])) == 0;
    };
    CHECK(same(one.particles.position, other.particles.position));
    CHECK(same(one.particles.angular_velocity, other.particles.angular_velocity));
    CHECK(other.energy.boundary_work == one.energy.boundary_work);
    CHECK(other.energy.friction == one.energy.friction);
    CHECK(other.energy.damping == one.energy.damping);
    REQUIRE(other.contacts.size() == one.contacts.size());
    for (std::size_t k = 0; k < one.contacts.size(); ++k) {
      REQUIRE(one.contacts[k].normal_force == other.contacts[k].normal_force);
      REQUIRE(one.contacts[k].shear_displacement == other.contacts[k].shear_displacement);
    }
  }
}
