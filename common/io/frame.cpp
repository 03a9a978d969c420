#include "common/io/frame.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "common/io/columns.hpp"
#include "common/io/hdf5_file.hpp"

namespace common {
namespace {

constexpr char kSchema[] = "frame/1";
constexpr bool kNeeded = true;    // by every reader
constexpr bool kDemOnly = false;  // FrameContent::everything insists on it

/// Calls field(path, array, unit, description, needed) for each particle array: one table for writing and reading.
/// `vertex_offset` and `vertices` have their own lengths and stand in `outline_fields`.
template <class ParticleArrays, class Field>
void particle_fields(ParticleArrays& p, const Field& field) {
  field("particles/id", p.id, "1", "stable particle id, ascending", kNeeded);
  field("particles/parent", p.parent, "1", "id of the particle that this one broke from, -1 for an original", kDemOnly);
  field("particles/root", p.root, "1", "id of the original particle", kDemOnly);
  field("particles/generation", p.generation, "1", "number of breakages since the original", kDemOnly);
  field("particles/type", p.type, "1", "index of the shape type, -1 for a fragment", kDemOnly);
  field("particles/position", p.position, "m", "centroid (x, y), world axes", kNeeded);
  field("particles/velocity", p.velocity, "m/s", "centroid velocity (x, y) at t - dt/2", kDemOnly);
  field("particles/displacement", p.displacement, "m", "displacement (x, y) since the start of shear", kDemOnly);
  field("particles/angle", p.angle, "rad", "rotation from body to world axes, counter-clockwise", kNeeded);
  field("particles/angular_velocity", p.angular_velocity, "rad/s", "angular velocity at t - dt/2", kDemOnly);
  field("particles/mass", p.mass, "kg", "mass, unit thickness", kDemOnly);
  field("particles/inertia", p.inertia, "kg m^2", "polar moment of inertia about the centroid, unit thickness",
        kDemOnly);
  field("particles/area", p.area, "m^2", "area of the outline", kDemOnly);
  field("particles/boundary", p.boundary, "1", "1: boundary particle, driven and never broken; 0: free", kNeeded);
}

template <class ParticleArrays, class Field>
void outline_fields(ParticleArrays& p, const Field& field) {
  field("particles/vertex_offset", p.vertex_offset, "1", "first row in particles/vertices; one entry more than ids",
        kNeeded);
  field("particles/vertices", p.vertices, "m",
        "outlines (x, y), body axes, counter-clockwise, centroid at the origin; world = position + R(angle) vertex",
        kNeeded);
}

template <class ContactArrays, class Field>
void contact_fields(ContactArrays& c, const Field& field) {
  field("contacts/a", c.a, "1", "id of the first particle", kNeeded);
  field("contacts/b", c.b, "1", "id of the second particle, a < b", kNeeded);
  field("contacts/point", c.point, "m", "application point (x, y) of the force, world axes", kNeeded);
  field("contacts/normal", c.normal, "1", "unit normal (x, y) from a to b", kDemOnly);
  field("contacts/force", c.force, "N", "force (x, y) on b, unit thickness", kNeeded);
  field("contacts/normal_force", c.normal_force, "N", "force along the normal, compression positive", kDemOnly);
  field("contacts/shear_force", c.shear_force, "N", "force . (-n_y, n_x)", kDemOnly);
  field("contacts/overlap_area", c.overlap_area, "m^2", "area of the overlap polygon", kDemOnly);
  field("contacts/overlap_width", c.overlap_width, "m", "distance of the two crossings of the outlines", kDemOnly);
}

constexpr char kRing[] = "boundary/ring";
constexpr char kSlip[] = "contacts/shear_displacement";
constexpr char kRolling[] = "contacts/rolling_moment";

std::optional<Stage> stage_named(const std::string& name) {
  for (const Stage stage : {Stage::compaction, Stage::relaxation, Stage::confinement, Stage::shear}) {
    if (name == name_of(stage)) return stage;
  }
  return std::nullopt;
}

/// True if no array that belongs to a complete frame is left out.
bool is_complete(const Frame& frame) {
  bool complete = true;
  const auto count = [&](std::size_t expected) {
    return [&complete, expected](const char*, const auto& values, const char*, const char*, bool) {
      complete = complete && (expected == 0 || !values.empty());
    };
  };
  particle_fields(frame.particles, count(frame.particles.size()));
  contact_fields(frame.contacts, count(frame.contacts.size()));
  return complete;
}

void validate_columns(const std::string& group, const std::vector<Column>& columns, bool equal_lengths,
                      const Source& source) {
  std::set<std::string> names;
  for (const Column& column : columns) {
    const std::string path = group + "/" + column.name;
    if (column.name.empty() || column.name.find_first_of("/@") != std::string::npos) {
      source.fail_dataset(path, "expected a name without '/' and '@'");
    }
    if (!names.insert(column.name).second) source.fail_dataset(path, "stands there twice");
    if (equal_lengths) check_rows(path, column.values.size(), columns[0].values.size(), source);
    check_finite(path, column.values, source);
  }
}

void validate_particles(const Particles& p, const Source& source) {
  check_ids("particles/id", p.id, source);
  check_offsets("particles/vertex_offset", p.vertex_offset, p.size(), p.vertices.size(), source);
  check_finite("particles/vertices", p.vertices, source);
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (std::isnan(sin_cos(p.angle[i]).sin)) {
      source.fail_dataset(
          "particles/angle",
          fmt::format("particle {} has turned by {} rad, too far to know its direction", p.id[i], p.angle[i]));
    }
    const std::string defect = outline_defect(p.outline(i));
    if (!defect.empty()) source.fail_dataset("particles/vertices", fmt::format("particle {}: {}", p.id[i], defect));
  }
}

void validate_contacts(const Frame& frame, FrameContent content, const Source& source) {
  const Contacts& c = frame.contacts;
  check_known("contacts/a", c.a, "particles/id", frame.particles.id, source);
  check_known("contacts/b", c.b, "particles/id", frame.particles.id, source);
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (c.a[i] == c.b[i]) {
      source.fail_dataset("contacts/b", fmt::format("entry {}: particle {} in contact with itself", i, c.b[i]));
    }
    if (content != FrameContent::everything) continue;
    if (c.a[i] > c.b[i]) {
      source.fail_dataset("contacts/b",
                          fmt::format("entry {} is {}, expected more than contacts/a, which is {}", i, c.b[i], c.a[i]));
    }
    if (i > 0 && std::pair(c.a[i], c.b[i]) <= std::pair(c.a[i - 1], c.b[i - 1])) {
      source.fail_dataset("contacts/a", fmt::format("entry {}: the pair ({}, {}) after ({}, {}), expected ascending "
                                                    "pairs",
                                                    i, c.a[i], c.b[i], c.a[i - 1], c.b[i - 1]));
    }
    if (c.normal_force[i] < 0) {
      source.fail_dataset("contacts/normal_force",
                          fmt::format("entry {} is {}, expected at least 0", i, c.normal_force[i]));
    }
  }
}

/// What holds only for dem's own frames.
void validate_checkpoint(const Frame& frame, const Source& source) {
  const Particles& p = frame.particles;
  const auto check_positive = [&](const std::string& path, const std::vector<double>& values) {
    const auto bad = std::find_if(values.begin(), values.end(), [](double x) { return !(x > 0); });
    if (bad != values.end()) {
      source.fail_dataset(path, fmt::format("entry {} is {}, expected more than 0", bad - values.begin(), *bad));
    }
  };
  check_positive("particles/mass", p.mass);
  check_positive("particles/inertia", p.inertia);
  check_positive("particles/area", p.area);
  if (p.size() > 0 && frame.next_id <= p.id.back()) {
    source.fail("attribute next_id",
                fmt::format("is {}, expected more than the largest particle id {}", frame.next_id, p.id.back()));
  }
  for (const auto& [name, value] :
       {std::pair{"frame", frame.frame}, {"step", frame.step}, {"next_id", frame.next_id}}) {
    if (value < 0 || value > kLargestCount) {
      source.fail(fmt::format("attribute {}", name), fmt::format("is {}, expected 0 to {}", value, kLargestCount));
    }
  }
}

void validate(const Frame& frame, FrameContent content, const Source& source) {
  for (const auto& [name, value] :
       {std::pair{"time", frame.time}, {"axial_strain", frame.axial_strain}, {"friction", frame.friction}}) {
    if (!std::isfinite(value)) {
      source.fail(std::string("attribute ") + name, fmt::format("is {}, expected a finite number", value));
    }
  }
  const auto check_array = [&](std::size_t rows) {
    return [&source, content, rows](const char* path, const auto& values, const char*, const char*, bool needed) {
      const bool may_be_absent = !needed && content != FrameContent::everything;
      if (!(may_be_absent && values.empty())) check_rows(path, values.size(), rows, source);
      check_finite(path, values, source);
    };
  };
  particle_fields(frame.particles, check_array(frame.particles.size()));
  contact_fields(frame.contacts, check_array(frame.contacts.size()));
  if (frame.contacts.shear_displacement) {
    check_rows(kSlip, frame.contacts.shear_displacement->size(), frame.contacts.size(), source);
    check_finite(kSlip, *frame.contacts.shear_displacement, source);
  }
  if (frame.contacts.rolling_moment) {
    check_rows(kRolling, frame.contacts.rolling_moment->size(), frame.contacts.size(), source);
    check_finite(kRolling, *frame.contacts.rolling_moment, source);
  }
  validate_particles(frame.particles, source);
  validate_contacts(frame, content, source);
  check_known(kRing, frame.ring, "particles/id", frame.particles.id, source);
  validate_columns("history", frame.history, true, source);
  validate_columns("checkpoint", frame.checkpoint, false, source);
  if (content == FrameContent::everything) validate_checkpoint(frame, source);
}

Contents contents_of(const Frame& frame) {
  Contents contents;
  contents["@schema"] = text_item(kSchema);
  contents["@frame"] = scalar_item(frame.frame);
  contents["@step"] = scalar_item(frame.step);
  contents["@time"] = scalar_item(frame.time);
  contents["@stage"] = text_item(name_of(frame.stage));
  contents["@axial_strain"] = scalar_item(frame.axial_strain);
  contents["@seed"] = scalar_item(frame.seed);
  contents["@next_id"] = scalar_item(frame.next_id);
  contents["@friction"] = scalar_item(frame.friction);
  contents["@final"] = scalar_item(static_cast<std::int32_t>(frame.final));
  contents["@config_hash"] = text_item(frame.config_hash);

  // An array that is left out of an incomplete frame leaves no dataset behind.
  const auto put = [&](std::size_t rows) {
    return [&contents, rows](const char* path, const auto& values, const char* unit, const char* description, bool) {
      if (!values.empty() || rows == 0) put_column(contents, path, values, unit, description);
    };
  };
  particle_fields(frame.particles, put(frame.particles.size()));
  outline_fields(frame.particles, put(0));
  contact_fields(frame.contacts, put(frame.contacts.size()));
  if (frame.contacts.shear_displacement) {
    put_column(contents, kSlip, *frame.contacts.shear_displacement, "m", "tangential spring, along (-n_y, n_x)");
  }
  if (frame.contacts.rolling_moment) {
    put_column(contents, kRolling, *frame.contacts.rolling_moment, "N m", "of the rolling resistance, on b");
  }
  put_column(contents, kRing, frame.ring, "1", "ids of the boundary particles in order around the assembly");
  for (const Column& c : frame.history) put_column(contents, "history/" + c.name, c.values, c.unit, c.description);
  for (const Column& c : frame.checkpoint) {
    put_column(contents, "checkpoint/" + c.name, c.values, c.unit, c.description);
  }
  return contents;
}

std::string text_at(const Contents& contents, const std::string& path) {
  const auto found = contents.find(path);
  if (found == contents.end() || found->second.type != "string") return {};
  const std::vector<std::string> texts = texts_of(found->second);
  return texts.empty() ? std::string() : texts[0];
}

/// All datasets directly in `group`, ascending by name.
std::vector<Column> columns_in(const Contents& contents, const std::string& group, const Source& source) {
  std::vector<Column> columns;
  const std::string prefix = group + "/";
  for (auto at = contents.lower_bound(prefix); at != contents.end() && at->first.starts_with(prefix); ++at) {
    const std::string& path = at->first;
    if (path.find_first_of("/@", prefix.size()) != std::string::npos) continue;
    columns.push_back({path.substr(prefix.size()), text_at(contents, path + "@unit"),
                       text_at(contents, path + "@description"), get_column<double>(contents, path, source)});
  }
  return columns;
}

void read_attributes(const Contents& contents, bool all, const Source& source, Frame& frame) {
  std::string schema = kSchema;
  get_attribute(contents, "schema", all, source, schema);
  if (schema != kSchema) source.fail("attribute schema", fmt::format("is '{}', expected '{}'", schema, kSchema));
  get_attribute(contents, "frame", all, source, frame.frame);
  get_attribute(contents, "step", all, source, frame.step);
  get_attribute(contents, "time", all, source, frame.time);
  std::string stage = name_of(frame.stage);
  get_attribute(contents, "stage", all, source, stage);
  const std::optional<Stage> known = stage_named(stage);
  if (!known) {
    source.fail("attribute stage",
                fmt::format("is '{}', expected compaction, relaxation, confinement or shear", stage));
  }
  frame.stage = *known;
  get_attribute(contents, "axial_strain", all, source, frame.axial_strain);
  get_attribute(contents, "seed", all, source, frame.seed);
  get_attribute(contents, "next_id", all, source, frame.next_id);
  get_attribute(contents, "friction", all, source, frame.friction);
  std::int32_t final = 0;
  get_attribute(contents, "final", all, source, final);
  if (final != 0 && final != 1) source.fail("attribute final", fmt::format("is {}, expected 0 or 1", final));
  frame.final = final == 1;
  get_attribute(contents, "config_hash", all, source, frame.config_hash);
}

}  // namespace

const char* name_of(Stage stage) {
  constexpr std::array kNames = {"compaction", "relaxation", "confinement", "shear"};
  return kNames[static_cast<std::size_t>(stage)];
}

WrittenFile write_frame(const std::filesystem::path& path, Frame& frame, Durability durability) {
  const FrameContent content = is_complete(frame) ? FrameContent::everything : FrameContent::contact_state;
  validate(frame, content, {path.string(), ExitCode::numerical_failure});
  WrittenFile written = write_hdf5(path, contents_of(frame), durability);
  frame.payload_hash = written.payload_hash;
  return written;
}

Frame read_frame(const std::filesystem::path& path, FrameContent content) {
  const Source source{path.string(), ExitCode::bad_input};
  const bool all = content == FrameContent::everything;
  const bool only_state = content == FrameContent::contact_state;
  Frame frame;
  std::set<std::string> state;
  const auto list = [&state](const char* name, const auto&, const char*, const char*, bool needed) {
    if (needed) state.insert(name);
  };
  particle_fields(frame.particles, list);
  outline_fields(frame.particles, list);
  contact_fields(frame.contacts, list);
  const Contents contents = read_hdf5(path, only_state ? &state : nullptr);
  read_attributes(contents, all, source, frame);
  const auto get = [&](const char* name, auto& values, const char*, const char*, bool needed) {
    using Element = typename std::remove_reference_t<decltype(values)>::value_type;
    if (needed || all || (!only_state && contents.contains(name))) {
      values = get_column<Element>(contents, name, source);
    }
  };
  particle_fields(frame.particles, get);
  outline_fields(frame.particles, get);
  if (content != FrameContent::particles || contents.contains("contacts/a")) contact_fields(frame.contacts, get);
  if (!only_state) {
    if (contents.contains(kSlip)) frame.contacts.shear_displacement = get_column<double>(contents, kSlip, source);
    if (contents.contains(kRolling)) frame.contacts.rolling_moment = get_column<double>(contents, kRolling, source);
    get(kRing, frame.ring, "", "", false);
    frame.history = columns_in(contents, "history", source);
    frame.checkpoint = columns_in(contents, "checkpoint", source);
  }
  validate(frame, content, source);
  get_attribute(contents, "payload_hash", true, source, frame.payload_hash);
  return frame;
}

}  // namespace common
