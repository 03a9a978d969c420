// split/1: the answer of `xfem` to one frame, and at the same time its complete state (persistent cracks).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/geometry/polygon.hpp"
#include "common/io/immutable_file.hpp"

namespace common {

enum class ParticleStatus : std::int32_t {
  screened = 0,  ///< a bound shows that it cannot fail
  intact = 1,    ///< solved, no failure
  arrested = 2,  ///< cracked, no crack goes on
  broken = 3,
  not_breakable = 4,  ///< boundary, or below the smallest size
  refused = 5,        ///< see refusals
};
enum class FailureMode : std::int32_t { none = 0, tension = 1, shear = 2 };

struct Split {
  std::int64_t frame = 0;
  std::string frame_hash;  ///< payload hash of the frame that was analysed
  std::string config_hash;
  std::string payload_hash;  ///< set by write and read

  struct {
    std::vector<std::int64_t> id;                    ///< N; in the frame's order
    std::vector<ParticleStatus> status;              ///< N
    std::vector<std::array<double, 3>> mean_stress;  ///< N; (xx, yy, xy), world axes, compression positive [Pa]
    std::vector<double> min_safety_factor;           ///< N; load factor at failure; +inf unloaded, NaN not breakable
    std::vector<FailureMode> failure_mode;           ///< N
  } particles;

  /// K cracks with P points in all, grouped by particle, particles ascending; fragments included.
  struct {
    std::vector<std::int64_t> particle;                  ///< K
    std::vector<std::int64_t> point_offset{0};           ///< K + 1
    std::vector<Vec2> points;                            ///< P; body frame [m]
    std::vector<std::array<std::int32_t, 2>> edge;       ///< P; mesh nodes of the edge that holds the point
    std::vector<double> edge_fraction;                   ///< P; position along that edge, 0 at its first node
    std::vector<std::array<std::int32_t, 2>> tip_state;  ///< K; of first and last tip, see xfem/crack/path.hpp
  } cracks;

  /// M broken particles.
  struct {
    std::vector<std::int64_t> parent;       ///< M
    std::vector<std::array<Vec2, 2>> path;  ///< M; breakage line in the parent's body frame [m]
  } broken;

  /// Fragments, two for each broken particle, left of the path first.
  struct {
    std::vector<std::int64_t> id, parent;
    std::vector<std::int64_t> vertex_offset{0};
    std::vector<Vec2> vertices;  ///< in the PARENT's body frame [m]
  } fragments;

  struct {
    std::vector<std::int64_t> particle;
    std::vector<std::string> reason;
  } refusals;

  /// work/*: counters that are pure functions of the inputs.
  struct {
    std::int64_t screened = 0;
    std::int64_t solved = 0;
    std::int64_t growth_steps = 0;
  } work;
};

/// Writes atomically (image + rename). Sets split.payload_hash. Throws io_failure.
WrittenFile write_split(const std::filesystem::path& path, Split& split, Durability durability);

/// Reads and verifies. Throws bad_input naming file and dataset, found and expected; io_failure if unreadable.
Split read_split(const std::filesystem::path& path);

}  // namespace common
