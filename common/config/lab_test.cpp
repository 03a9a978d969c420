#include "common/config/lab_test.hpp"

#include "common/config/document.hpp"
#include "common/config/effects.hpp"
#include "common/config/outlines.hpp"
#include "common/config/sections.hpp"
#include "common/config/suggestion.hpp"
#include "common/config/values.hpp"
#include "common/error.hpp"

namespace common {
namespace {

const std::vector<std::string> kKinds{"brazilian", "uniaxial",   "confined",     "tension",
                                      "bending",   "point_load", "multi_contact"};

/// A list of [x, y]; `what` names it in messages. Unlike an outline it has no shape to check.
std::vector<Vec2> read_pairs(const Value& list, const std::string& path, const std::string& expected) {
  if (!list.is_list()) refuse(list, path, expected);
  std::vector<Vec2> pairs;
  for (const Value& item : list.items) {
    if (!item.is_list() || item.items.size() != 2) refuse(item, path, "a pair [x, y]");
    Vec2 pair;
    for (int c = 0; c < 2; ++c) {
      const Value& part = item.items[c];
      const auto number = part.is_scalar() && !part.quoted ? parse_number(part.text) : std::nullopt;
      if (!number) refuse(part, path, "a number");
      pair[c] = *number;
    }
    pairs.push_back(pair);
  }
  return pairs;
}

std::string print_pairs(const std::vector<Vec2>& pairs) {
  std::string text = "[";
  for (const Vec2& p : pairs) {
    if (text.size() > 1) text += ", ";
    text += '[';
    text += print_number(p.x());
    text += ", ";
    text += print_number(p.y());
    text += ']';
  }
  return text + ']';
}

void bind_pairs(Specification& keys, const std::string& path, std::vector<Vec2>& pairs, const std::string& unit,
                const std::string& description) {
  const std::string expected = "a list of pairs [x, y]";
  keys.custom(
      {path, unit, description, expected, UsedBy::xfem},
      [=, &pairs](const Value& value) { pairs = read_pairs(value, path, expected); },
      [&pairs](UsedBy) { return print_pairs(pairs); });
}

/// `[[x1, y1, x2, y2], ...]`.
void bind_cracks(Specification& keys, std::vector<std::array<Vec2, 2>>& cracks) {
  const std::string path = "specimen.cracks";
  const std::string expected = "a list of cracks [x1, y1, x2, y2]";
  keys.custom(
      {path, "m", "straight cracks that the specimen has from the start; the load acts along y, 0 is the centroid",
       expected, UsedBy::xfem},
      [=, &cracks](const Value& value) {
        cracks.clear();
        if (!value.is_list()) refuse(value, path, expected);
        for (const Value& item : value.items) {
          if (!item.is_list() || item.items.size() != 4) refuse(item, path, "a crack [x1, y1, x2, y2]");
          std::array<double, 4> ends;
          for (int i = 0; i < 4; ++i) {
            const Value& part = item.items[i];
            const auto number = part.is_scalar() && !part.quoted ? parse_number(part.text) : std::nullopt;
            if (!number) refuse(part, path, "a number");
            ends[i] = *number;
          }
          cracks.push_back({Vec2(ends[0], ends[1]), Vec2(ends[2], ends[3])});
          if (cracks.back()[0] == cracks.back()[1]) refuse(item, path, "a crack with two ends apart");
        }
      },
      [&cracks](UsedBy) {
        std::string text = "[";
        for (const auto& [from, to] : cracks) {
          if (text.size() > 1) text += ", ";
          text += '[';
          for (const double x : {from.x(), from.y(), to.x()}) {
            text += print_number(x);
            text += ", ";
          }
          text += print_number(to.y());
          text += ']';
        }
        return text + ']';
      });
}

void bind_specimen(Specification& keys, SpecimenOptions& specimen) {
  keys.number("specimen.diameter", specimen.diameter, kPositive, "m", UsedBy::xfem,
              "brazilian: disc diameter; point_load, multi_contact: longest distance between two vertices");
  keys.integer("specimen.sides", specimen.sides, 8, 10'000, "-", UsedBy::xfem,
               "brazilian: sides of the polygon that stands for the disc");
  keys.number("specimen.width", specimen.width, kPositive, "m", UsedBy::xfem,
              "uniaxial, confined, tension: width of the block; bending: length of the beam");
  keys.number("specimen.height", specimen.height, kPositive, "m", UsedBy::xfem,
              "uniaxial, confined, tension: height of the block; bending: depth of the beam");
  keys.optional_number("specimen.span", specimen.span, kPositive, "m", UsedBy::xfem,
                       "bending: distance of the supports; auto: 0.8 of the beam's length");
  keys.custom(
      {"specimen.outline", "any", "point_load, multi_contact: the particle, a list of [x, y], convex; none: generated",
       "a list of pairs [x, y]", UsedBy::xfem},
      [&specimen](const Value& value) {
        specimen.outline.clear();
        if (value.is_list() && value.items.empty()) return;
        Value one;
        one.kind = Value::Kind::list;
        one.where = value.where;
        one.items = {value};
        specimen.outline = read_outlines(one, "specimen.outline")[0];
      },
      [&specimen](UsedBy) { return print_pairs(specimen.outline); });
  keys.integer("specimen.corners", specimen.corners, 3, 32, "-", UsedBy::xfem, "generated particle: corners");
  keys.number("specimen.roughness", specimen.roughness, {0, 0.45}, "-", UsedBy::xfem,
              "generated particle: scatter of the corner angles, in spacings");
  keys.number("specimen.aspect", specimen.aspect, {0, 1, true, false}, "-", UsedBy::xfem,
              "generated particle: ratio of width to length of the ellipse on which the corners lie");
  bind_cracks(keys, specimen.cracks);
}

void bind_loading(Specification& keys, LabLoading& loading) {
  keys.number("loading.confining_stress", loading.confining_stress, kNonNegative, "Pa", UsedBy::xfem,
              "confined: lateral stress, held while the axial load grows");
  keys.number("loading.platen_friction", loading.platen_friction, kNonNegative, "-", UsedBy::xfem,
              "uniaxial: Coulomb coefficient of the rigid platens; 0: smooth");
  keys.number("loading.patch", loading.patch, {0, 1}, "De", UsedBy::xfem,
              "point forces: width over which each is spread, in De = sqrt(4 A / pi); 0: point load");
  keys.number("loading.direction", loading.direction, {-180, 180}, "deg", UsedBy::xfem,
              "point_load: angle of the load axis from the outline's y axis, counter-clockwise");
  keys.integer("loading.contacts", loading.contacts, 2, 100, "-", UsedBy::xfem,
               "multi_contact: number of random forces in balance");
  keys.number("loading.friction", loading.friction, kNonNegative, "-", UsedBy::xfem,
              "multi_contact: largest ratio of shear to normal of a random force");
  bind_pairs(keys, "loading.points", loading.points, "m",
             "multi_contact: where forces act, in the frame of the given outline; none: random");
  bind_pairs(keys, "loading.forces", loading.forces, "N", "multi_contact: the forces on these points, in balance");
  keys.number("loading.step", loading.step, {0, 1, true, false}, "-", UsedBy::xfem,
              "growth of the load from one analysis to the next after first failure: resolution of the breakage load");
  keys.number("loading.largest", loading.largest, {1, 1e6}, "-", UsedBy::xfem,
              "the test ends at this multiple of the load at first failure; 1: first failure alone");
}

/// `sweep: {key: [values]}` or `{name: {label: {key: value}}}`: pipeline/lab sets them, each value checked there.
void bind_sweep(Specification& keys, std::vector<std::string>& sweep) {
  const std::string expected = "a map: keys of this file, each with a list of values";
  keys.custom(
      {"sweep", "-", "pipeline/lab runs the test at all combinations of these values; xfem lab runs the file's own",
       expected, UsedBy::neither},
      [=, &sweep](const Value& value) {
        sweep.clear();
        if (value.is_null()) return;
        if (!value.is_map()) refuse(value, "sweep", expected);
        for (std::size_t i = 0; i < value.keys.size(); ++i) {
          const Value& values = value.items[i];
          if (values.is_map() ? values.keys.empty() : !values.is_list() || values.items.empty())
            refuse(values, "sweep." + value.keys[i].text, "a list of values, or labels with the keys of each");
          sweep.push_back(value.keys[i].text);
        }
      },
      [](UsedBy) { return "{}"; });
}

Specification specification(LabTest& test) {
  Specification keys;
  keys.choice("test", test.test, kKinds, UsedBy::xfem, "kind of test");
  keys.custom(
      {"seed", "-", "of a generated particle and of random forces", "an integer >= 0", UsedBy::xfem},
      [&test](const Value& value) {
        const auto number = value.is_scalar() && !value.quoted ? parse_unsigned(value.text) : std::nullopt;
        if (!number) refuse(value, "seed", "an integer >= 0");
        test.seed = *number;
      },
      [&test](UsedBy) { return std::to_string(test.seed); });
  bind_effects(keys, test.effects, EffectsOf::specimen);
  bind_material(keys, test.material, test.file);
  bind_specimen(keys, test.specimen);
  bind_mesh_nodes(keys, "mesh.nodes", test.mesh_nodes);
  keys.number("mesh.grading", test.mesh_grading, {1, 8}, "-", UsedBy::xfem,
              "edge length in the mesh's interior over that where the loads act; 1: even");
  bind_loading(keys, test.loading);
  bind_particle_breakage(keys, test.breakage);
  bind_sweep(keys, test.sweep);
  return keys;
}

/// A sweep's names that look like keys must be keys.
void check_sweep(Specification& keys, const LabTest& test) {
  for (const std::string& name : test.sweep) {
    if (name.find('.') == std::string::npos && name != "seed" && name != "test") continue;
    bool known = false;
    for (const Key& key : keys.keys()) known = known || key.path == name;
    if (!known) keys.fail({"sweep"}, "sweep: found \"" + name + "\", expected a key of a laboratory test");
  }
}

}  // namespace

const char* name_of(LabTestKind kind) {
  return kKinds[static_cast<std::size_t>(kind)].c_str();
}

LabTest read_lab_test(const std::filesystem::path& file, const Overrides& overrides) {
  LabTest test;
  test.file = file;
  Specification keys = specification(test);
  keys.read(load_document(file));
  keys.set(overrides);
  keys.finish();
  if (!keys.given("test")) keys.fail({}, "test: found nothing, expected the kind of test, one of " + join(kKinds));
  if (test.loading.points.size() != test.loading.forces.size()) {
    keys.fail({"loading.forces", "loading.points"}, "loading: found " + std::to_string(test.loading.points.size()) +
                                                        " points and " + std::to_string(test.loading.forces.size()) +
                                                        " forces, expected a force for each point");
  }
  check_literal(keys, test.effects, test.breakage);
  check_sweep(keys, test);
  keys.finish();
  return test;
}

std::string to_yaml(const LabTest& test) {
  LabTest copy = test;
  return specification(copy).to_yaml("# The resolved laboratory test: every key with its value, [unit] and meaning.\n");
}

std::string config_hash(const LabTest& test) {
  LabTest copy = test;
  return specification(copy).hash(UsedBy::xfem);
}

std::vector<Key> lab_test_keys() {
  LabTest test;
  return specification(test).keys();
}

}  // namespace common
