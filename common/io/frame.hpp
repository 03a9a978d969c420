// frame/1: the contact state that `xfem` reads, and at the same time the complete checkpoint of `dem`.
// Flat arrays with offsets. SI units, stress positive in compression, unit thickness.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/polygon.hpp"
#include "common/io/immutable_file.hpp"

namespace common {

enum class Stage { compaction, relaxation, confinement, shear };
const char* name_of(Stage stage);

/// N particles, V vertices in all. A `dem` state holds these very arrays.
struct Particles {
  std::vector<std::int64_t> id, parent, root;  ///< N; stable ids, ascending; parent -1 for an original
  std::vector<std::int32_t> generation;        ///< N; 0 for an original
  std::vector<std::int32_t> type;              ///< N; index of the shape type, -1 for a fragment
  std::vector<Vec2> position;                  ///< N; centroid [m]
  std::vector<Vec2> velocity;                  ///< N; at t - dt/2 [m/s]
  std::vector<Vec2> displacement;              ///< N; since the start of shear [m]
  std::vector<double> angle;                   ///< N [rad]
  std::vector<double> angular_velocity;        ///< N; at t - dt/2 [rad/s]
  std::vector<double> mass;                    ///< N [kg]
  std::vector<double> inertia;                 ///< N [kg m^2]
  std::vector<double> area;                    ///< N [m^2]
  std::vector<std::uint8_t> boundary;          ///< N; 1: driven, never broken
  std::vector<std::int64_t> vertex_offset{0};  ///< N + 1
  std::vector<Vec2> vertices;                  ///< V; body frame, counter-clockwise, centroid at the origin [m]

  std::size_t size() const { return id.size(); }
  PolygonView outline(std::size_t i) const {
    return {vertices.data() + vertex_offset[i], static_cast<std::size_t>(vertex_offset[i + 1] - vertex_offset[i])};
  }
};

/// C contacts, ascending by (a, b) with a < b, one per pair.
struct Contacts {
  std::vector<std::int64_t> a, b;          ///< C; particle ids
  std::vector<Vec2> point, normal, force;  ///< C; application point [m], unit normal a to b, force on b [N]
  std::vector<double> normal_force;        ///< C; >= 0 [N]
  std::vector<double> shear_force;         ///< C; force . (-n_y, n_x) [N]
  std::vector<double> overlap_area;        ///< C [m^2]
  std::vector<double> overlap_width;       ///< C [m]
  std::optional<std::vector<double>> shear_displacement;  ///< C [m]; only in scenes with friction
  std::optional<std::vector<double>> rolling_moment;      ///< C, on b [N m]; only in scenes with rolling resistance

  std::size_t size() const { return a.size(); }
};

/// One named column of numbers, with what a reader of the file needs to know of it.
struct Column {
  std::string name;
  std::string unit;
  std::string description;
  std::vector<double> values;
};

/// Frames, steps and ids of particles count up to here: what goes on from a file still counts upward.
inline constexpr std::int64_t kLargestCount = std::int64_t{1} << 62;

struct Frame {
  std::int64_t frame = 0;
  std::int64_t step = 0;
  double time = 0;  ///< [s]
  Stage stage = Stage::shear;
  double axial_strain = 0;
  std::uint64_t seed = 0;
  std::int64_t next_id = 0;
  double friction = 0;  ///< coefficient in force
  bool final = false;
  std::string config_hash;
  std::string payload_hash;  ///< set by write and read

  Particles particles;
  Contacts contacts;
  std::vector<std::int64_t> ring;  ///< boundary/ring: ids in order around the assembly
  std::vector<Column> history;     ///< history/*: one row per record since the previous frame, equal lengths
  std::vector<Column> checkpoint;  ///< checkpoint/*: the rest of dem's state (servo, ring counter, energy sums, ...)
};

/// What a reader needs: `contact_state` accepts files with only particles/{id,position,angle,boundary,vertex_offset,
/// vertices} and contacts/{a,b,point,force}, and leaves all other arrays empty, in the file or not; `particles` does
/// without the contacts, too, and reads what is there; `everything` insists on all.
enum class FrameContent { particles, contact_state, everything };

/// Writes atomically (image + rename). Sets frame.payload_hash. Throws io_failure; then no file of that name changed.
WrittenFile write_frame(const std::filesystem::path& path, Frame& frame, Durability durability);

/// Reads and verifies (checksums, payload hash if present, shapes, ids ascending, finite numbers, convex outlines,
/// contacts that name existing particles). Throws bad_input naming file and dataset, found and expected;
/// io_failure if the file cannot be opened.
Frame read_frame(const std::filesystem::path& path, FrameContent content = FrameContent::everything);

}  // namespace common
