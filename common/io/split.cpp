#include "common/io/split.hpp"

#include <set>

#include "common/io/columns.hpp"
#include "common/io/hdf5_file.hpp"

namespace common {
namespace {

constexpr char kSchema[] = "split/1";
constexpr char kReason[] = "refusals/reason";
constexpr bool kRequired = true;
constexpr bool kOptional = false;

/// Calls field(path, array, unit, description, required) for each array: one table for writing and reading.
template <class AnySplit, class Field>
void fields(AnySplit& s, const Field& field) {
  field("particles/id", s.particles.id, "1", "particle ids in the frame's order", kRequired);
  field("particles/status", s.particles.status, "1",
        "0 screened (cannot fail), 1 intact, 2 cracked and arrested, 3 broken, 4 not breakable, 5 refused", kRequired);
  field("particles/mean_stress", s.particles.mean_stress, "Pa",
        "mean stress (xx, yy, xy), world axes, compression positive; average over the elements for status 1-3, "
        "from the contact forces for 0, 4, 5",
        kRequired);
  field("particles/min_safety_factor", s.particles.min_safety_factor, "1",
        "smallest load factor at failure; a lower bound for status 0, +inf if unloaded, NaN for 4", kRequired);
  field("particles/failure_mode", s.particles.failure_mode, "1", "0 none, 1 tension, 2 shear", kRequired);
  field("cracks/particle", s.cracks.particle, "1", "id of the particle or fragment that holds the crack, ascending",
        kRequired);
  field("cracks/point_offset", s.cracks.point_offset, "1", "first row in cracks/points; one entry more than cracks",
        kRequired);
  field("cracks/points", s.cracks.points, "m", "crack polylines (x, y), body axes of the particle", kRequired);
  field("cracks/edge", s.cracks.edge, "1", "mesh nodes of the edge that holds the point", kOptional);
  field("cracks/edge_fraction", s.cracks.edge_fraction, "1", "position along that edge, 0 at its first node",
        kOptional);
  field("cracks/tip_state", s.cracks.tip_state, "1", "state of the first and the last tip", kOptional);
  field("broken/parent", s.broken.parent, "1", "ids of the broken particles, in the frame's order", kRequired);
  field("broken/path", s.broken.path, "m", "ends ((x, y), (x, y)) of the breakage line, body axes of the parent",
        kRequired);
  field("fragments/id", s.fragments.id, "1", "ids of the fragments, left of the path first", kRequired);
  field("fragments/parent", s.fragments.parent, "1", "id of the broken particle", kRequired);
  field("fragments/vertex_offset", s.fragments.vertex_offset, "1",
        "first row in fragments/vertices; one entry more than fragments", kRequired);
  field("fragments/vertices", s.fragments.vertices, "m", "outlines (x, y), body axes of the parent, counter-clockwise",
        kRequired);
  field("refusals/particle", s.refusals.particle, "1", "ids of the particles with status 5", kRequired);
}

template <class AnyWork, class Field>
void work_fields(AnyWork& work, const Field& field) {
  field("work/screened", work.screened, "particles that a bound shows to be safe");
  field("work/solved", work.solved, "particles whose stress was solved");
  field("work/growth_steps", work.growth_steps, "crack growth steps");
}

template <class Enum>
void check_enum(const std::string& path, const std::vector<Enum>& values, Enum last, const Source& source) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] < Enum{0} || values[i] > last) {
      source.fail_dataset(path, fmt::format("entry {} is {}, expected 0 to {}", i, static_cast<int>(values[i]),
                                            static_cast<int>(last)));
    }
  }
}

void validate_particles(const Split& split, const Source& source) {
  const auto& p = split.particles;
  const std::size_t n = p.id.size();
  check_ascending("particles/id", p.id, source);
  check_rows("particles/status", p.status.size(), n, source);
  check_rows("particles/mean_stress", p.mean_stress.size(), n, source);
  check_rows("particles/min_safety_factor", p.min_safety_factor.size(), n, source);
  check_rows("particles/failure_mode", p.failure_mode.size(), n, source);
  check_enum("particles/status", p.status, ParticleStatus::refused, source);
  check_enum("particles/failure_mode", p.failure_mode, FailureMode::shear, source);
  check_finite("particles/mean_stress", p.mean_stress, source);
  for (std::size_t i = 0; i < n; ++i) {
    const bool nan_allowed = p.status[i] == ParticleStatus::not_breakable || p.status[i] == ParticleStatus::refused;
    const double factor = p.min_safety_factor[i];
    if (!(factor >= 0 || (nan_allowed && std::isnan(factor)))) {
      source.fail_dataset("particles/min_safety_factor", fmt::format("entry {} is {}, expected at least 0", i, factor));
    }
  }
}

void validate_cracks(const Split& split, const Source& source) {
  const auto& c = split.cracks;
  check_offsets("cracks/point_offset", c.point_offset, c.particle.size(), c.points.size(), source);
  check_finite("cracks/points", c.points, source);
  check_finite("cracks/edge_fraction", c.edge_fraction, source);
  if (!c.edge.empty()) check_rows("cracks/edge", c.edge.size(), c.points.size(), source);
  if (!c.edge_fraction.empty()) check_rows("cracks/edge_fraction", c.edge_fraction.size(), c.points.size(), source);
  if (!c.tip_state.empty()) check_rows("cracks/tip_state", c.tip_state.size(), c.particle.size(), source);
  for (std::size_t i = 0; i < c.particle.size(); ++i) {
    if (i > 0 && c.particle[i] < c.particle[i - 1]) {
      source.fail_dataset("cracks/particle", fmt::format("entry {} is {} after {}, expected ascending ids", i,
                                                         c.particle[i], c.particle[i - 1]));
    }
    if (!is_among(split.particles.id, c.particle[i]) && !is_among(split.fragments.id, c.particle[i])) {
      source.fail_dataset("cracks/particle",
                          fmt::format("entry {} names particle {}, which is neither in particles/id nor in "
                                      "fragments/id",
                                      i, c.particle[i]));
    }
  }
}

void validate_fragments(const Split& split, const Source& source) {
  const auto& broken = split.broken;
  const auto& f = split.fragments;
  check_ascending("broken/parent", broken.parent, source);
  check_known("broken/parent", broken.parent, "particles/id", split.particles.id, source);
  check_rows("broken/path", broken.path.size(), broken.parent.size(), source);
  check_finite("broken/path", broken.path, source);
  check_rows("fragments/id", f.id.size(), 2 * broken.parent.size(), source);
  check_rows("fragments/parent", f.parent.size(), f.id.size(), source);
  check_ids("fragments/id", f.id, source);
  check_offsets("fragments/vertex_offset", f.vertex_offset, f.id.size(), f.vertices.size(), source);
  check_finite("fragments/vertices", f.vertices, source);
  for (std::size_t i = 0; i < f.id.size(); ++i) {
    if (is_among(split.particles.id, f.id[i])) {
      source.fail_dataset("fragments/id", fmt::format("entry {} is {}, which is already in particles/id", i, f.id[i]));
    }
    if (f.parent[i] != broken.parent[i / 2]) {
      source.fail_dataset("fragments/parent", fmt::format("entry {} is {}, expected {} as in broken/parent", i,
                                                          f.parent[i], broken.parent[i / 2]));
    }
    const auto first = static_cast<std::size_t>(f.vertex_offset[i]);
    const auto count = static_cast<std::size_t>(f.vertex_offset[i + 1]) - first;
    const std::string defect = outline_defect(PolygonView(f.vertices).subspan(first, count));
    if (!defect.empty()) source.fail_dataset("fragments/vertices", fmt::format("particle {}: {}", f.id[i], defect));
  }
}

void validate(const Split& split, const Source& source) {
  validate_particles(split, source);
  validate_fragments(split, source);
  validate_cracks(split, source);
  check_known("refusals/particle", split.refusals.particle, "particles/id", split.particles.id, source);
  check_rows(kReason, split.refusals.reason.size(), split.refusals.particle.size(), source);
}

Contents contents_of(const Split& split) {
  Contents contents;
  contents["@schema"] = text_item(kSchema);
  contents["@frame"] = scalar_item(split.frame);
  contents["@frame_hash"] = text_item(split.frame_hash);
  contents["@config_hash"] = text_item(split.config_hash);
  fields(split, [&](const char* path, const auto& values, const char* unit, const char* description, bool) {
    put_column(contents, path, values, unit, description);
  });
  contents[kReason] = text_array_item(split.refusals.reason);
  contents[std::string(kReason) + "@unit"] = text_item("1");
  contents[std::string(kReason) + "@description"] = text_item("why the particle ended in status 5");
  work_fields(split.work, [&](const char* path, std::int64_t value, const char* description) {
    put_column(contents, path, std::vector{value}, "1", description);
  });
  return contents;
}

std::vector<std::string> read_reasons(const Contents& contents, const Source& source) {
  const auto found = contents.find(kReason);
  if (found == contents.end()) source.fail_dataset(kReason, "missing");
  const Item& item = found->second;
  if (item.type != "string" || item.shape.size() != 1) {
    source.fail_dataset(
        kReason, fmt::format("is {} of shape {}, expected a list of strings", item.type, shape_text(item.shape)));
  }
  return texts_of(item);
}

}  // namespace

WrittenFile write_split(const std::filesystem::path& path, Split& split, Durability durability) {
  validate(split, {path.string(), ExitCode::numerical_failure});
  WrittenFile written = write_hdf5(path, contents_of(split), durability);
  split.payload_hash = written.payload_hash;
  return written;
}

Split read_split(const std::filesystem::path& path) {
  const Source source{path.string(), ExitCode::bad_input};
  Split split;
  std::set<std::string> wanted{kReason};
  fields(split, [&](const char* name, const auto&, const char*, const char*, bool) { wanted.insert(name); });
  work_fields(split.work, [&](const char* name, std::int64_t, const char*) { wanted.insert(name); });
  const Contents contents = read_hdf5(path, &wanted);
  std::string schema;
  get_attribute(contents, "schema", true, source, schema);
  if (schema != kSchema) source.fail("attribute schema", fmt::format("is '{}', expected '{}'", schema, kSchema));
  get_attribute(contents, "frame", true, source, split.frame);
  get_attribute(contents, "frame_hash", true, source, split.frame_hash);
  get_attribute(contents, "config_hash", true, source, split.config_hash);
  fields(split, [&](const char* path_in_file, auto& values, const char*, const char*, bool required) {
    using Element = typename std::remove_reference_t<decltype(values)>::value_type;
    if (required || contents.contains(path_in_file)) {
      values = get_column<Element>(contents, path_in_file, source);
    }
  });
  split.refusals.reason = read_reasons(contents, source);
  work_fields(split.work, [&](const char* path_in_file, std::int64_t& value, const char*) {
    const std::vector<std::int64_t> values = get_column<std::int64_t>(contents, path_in_file, source);
    check_rows(path_in_file, values.size(), 1, source);
    value = values[0];
  });
  validate(split, source);
  get_attribute(contents, "payload_hash", true, source, split.payload_hash);
  return split;
}

}  // namespace common
