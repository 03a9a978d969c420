#include "common/config/scene.hpp"

#include <cmath>

#include "common/config/document.hpp"
#include "common/config/effects.hpp"
#include "common/config/outlines.hpp"
#include "common/config/sections.hpp"
#include "common/config/suggestion.hpp"
#include "common/config/values.hpp"
#include "common/error.hpp"

namespace common {
namespace {

constexpr int kMany = 10'000'000;
/// Of an assembly's mass in one particle: with more, a grading cannot be met.
constexpr double kLargestShare = 0.1;

void bind_assembly(Specification& keys, AssemblyOptions& assembly) {
  keys.integer("assembly.particles", assembly.particles, 1, kMany, "-", UsedBy::dem,
               "number of particles generated (Table 1: 1194)");
  keys.number("assembly.diameter_min", assembly.diameter_min, kPositive, "m", UsedBy::dem,
              "smallest diameter, the longest distance between two vertices (Table 1); with a grading, its smallest");
  keys.number("assembly.diameter_max", assembly.diameter_max, kPositive, "m", UsedBy::dem,
              "largest diameter (Table 1); with a grading, its largest");
  keys.custom(
      {"assembly.grading", "m, -",
       "sizes: uniform by number between the diameters, or a curve [diameter, fraction by mass finer], linear in "
       "between; "
       "from a list or a file (CSV diameter,passing or YAML), relative to the scene's folder",
       "uniform, a list, each item a point [diameter, passing], or the name of a file", UsedBy::dem},
      [&assembly](const Value& value) {
        assembly.grading.clear();
        assembly.grading_file.clear();
        if (value.is_list()) {
          assembly.grading = read_grading(value, "assembly.grading");
        } else if (!value.is_scalar() || value.text.empty() || (!value.quoted && parse_number(value.text))) {
          refuse(value, "assembly.grading",
                 "uniform, a list, each item a point [diameter, passing], or the name of a file");
        } else if (value.text != "uniform") {
          assembly.grading_file = value.text;
        }
      },
      [&assembly](UsedBy) { return assembly.grading.empty() ? "uniform" : print_grading(assembly.grading); });

  ShapeOptions& shapes = assembly.shapes;
  const std::vector<std::string> sources{"generated", "outlines", "file"};
  keys.named(
      "assembly.shapes.source", sources, [&shapes, sources](int i) { shapes.source = sources[i]; },
      [&shapes] { return shapes.source == "generated"  ? 0
                         : shapes.source == "outlines" ? 1
                                                       : 2; }, UsedBy::dem,
      "where the shape types come from; a file is read into `outlines`");
  keys.integer("assembly.shapes.types", shapes.types, 1, kMany, "-", UsedBy::dem,
               "generated: number of shape types drawn");
  keys.integer("assembly.shapes.corners_min", shapes.corners_min, 3, 32, "-", UsedBy::dem,
               "generated: fewest corners (the paper's figures show 5 to 8)");
  keys.integer("assembly.shapes.corners_max", shapes.corners_max, 3, 32, "-", UsedBy::dem, "generated: most corners");
  keys.number("assembly.shapes.roughness", shapes.roughness, {0, 0.45, false, false}, "-", UsedBy::dem,
              "generated: scatter of the corner angles, in spacings; 0: evenly spaced");
  keys.number("assembly.shapes.aspect", shapes.aspect, {0, 1, true, false}, "-", UsedBy::dem,
              "generated: smallest ratio of width to length drawn; 1: equant");
  keys.custom(
      {"assembly.shapes.outlines", "any", "outlines: each a list of [x, y], convex, counter-clockwise",
       "a list of outlines, each a list of [x, y]", UsedBy::dem},
      [&shapes](const Value& value) { shapes.outlines = read_outlines(value, "assembly.shapes.outlines"); },
      [&shapes](UsedBy) { return print_outlines(shapes.outlines); });
  keys.text("assembly.shapes.file", shapes.file, "a file name", UsedBy::neither,
            "file: outlines as CSV (type,x,y) or YAML; relative to the scene's folder");
  keys.shorthand("assembly.shapes", [](const Value& value) {
    const auto scalar = [&value](const std::string& text) {
      Value result;
      result.kind = Value::Kind::scalar;
      result.text = text;
      result.where = value.where;
      return result;
    };
    Value none = scalar("");
    none.kind = Value::Kind::list;
    Value map;
    map.kind = Value::Kind::map;
    map.where = value.where;
    map.keys = {scalar("source"), scalar("outlines"), scalar("file")};
    if (value.is_list()) {
      map.items = {scalar("outlines"), value, scalar("")};
    } else if (value.text == "generated") {
      map.items = {scalar("generated"), none, scalar("")};
    } else {
      map.items = {scalar("file"), none, value};
    }
    return map;
  });
}

void bind_contact(Specification& keys, Scene& scene) {
  keys.choice("contact.law", scene.contact.law, {"mean_depth", "area", "potential", "foundation"}, UsedBy::dem,
              "normal force: kn A / b, kn A, kn A b / L^2 (overlap area A, width b, mean diameter L), or kn A made "
              "conservative");
  keys.number("contact.normal_stiffness", scene.contact.normal_stiffness, kPositive,
              "N/m for mean_depth and potential, N/m^2 for area and foundation", UsedBy::dem,
              "normal stiffness kn; the paper's 2e7 N/m (Table 1) lets particles overlap far too much at 2 to 4 MPa");
  keys.optional_number("contact.tangential_stiffness", scene.contact.tangential_stiffness, kPositive, "N/m",
                       UsedBy::dem,
                       "tangential stiffness kt, with effect friction; auto: from the normal stiffness of the law");
  keys.number("contact.friction", scene.contact.friction, kNonNegative, "-", UsedBy::dem,
              "Coulomb coefficient in shear, with effect friction (Table 1)");
  keys.number("contact.rolling_friction", scene.contact.rolling_friction, {0, 1, true, false}, "-", UsedBy::dem,
              "largest rolling moment / (normal force * rolling radius), with effect rolling_resistance");
  keys.number("damping.local", scene.damping.local, {0, 1, false, true}, "-", UsedBy::dem,
              "Cundall local damping coefficient, with effect local_damping");
  keys.number("damping.contact", scene.damping.contact, {0, 1, true, false}, "-", UsedBy::dem,
              "viscous damping of a contact's normal motion, share of critical, with effect contact_damping");
  keys.vector("gravity.acceleration", scene.gravity.acceleration, "m/s^2", UsedBy::dem,
              "acceleration of free fall, with effect gravity");
  keys.number("mass_scaling.smallest_mass", scene.mass_scaling.smallest_mass, {0, 1, true, false}, "-", UsedBy::dem,
              "with effect mass_scaling, a lighter particle moves as if it had this share of the mean original mass");
  keys.number("time_step.safety", scene.time_step.safety, {0, 1, true, false}, "-", UsedBy::dem,
              "dt = safety sqrt(m_min / k_max); too large a value is unstable");
  keys.number("neighbours.skin", scene.neighbours.skin, {0, 2, true, false}, "diameter_min", UsedBy::dem,
              "how far particles may approach each other before pairs are searched anew; costs time, not accuracy");
}

void bind_preparation(Specification& keys, PreparationOptions& preparation) {
  keys.number("preparation.confining_pressure", preparation.confining_pressure, kPositive, "Pa", UsedBy::dem,
              "isotropic pressure before shear, and lateral stress in shear (the paper: 0.5, 1, 2, 4 MPa)");
  keys.number("preparation.void_ratio", preparation.void_ratio, {0, 2, true, false}, "-", UsedBy::dem,
              "target before shear, reached by lowering friction (Table 1: 0.30)");
  keys.choice(
      "preparation.definition", preparation.definition, {"e1", "e2", "e4"}, UsedBy::dem,
      "void ratio meant: ring polygon over e1 solids inside it, e2 the same less overlaps, e4 interior particles");
  keys.number("preparation.void_ratio_tolerance", preparation.void_ratio_tolerance, kPositive, "-", UsedBy::dem,
              "how near to the target is near enough");
  keys.number("preparation.compaction_rate", preparation.compaction_rate, kPositive, "1/s", UsedBy::dem,
              "strain rate of the affine compaction of the loose assembly");
  keys.number("preparation.initial_friction", preparation.initial_friction, kNonNegative, "-", UsedBy::dem,
              "friction coefficient during confinement, before it is lowered");
  keys.number("preparation.unbalanced_force", preparation.unbalanced_force, {0, 1, true, true}, "-", UsedBy::dem,
              "at rest: mean force sum of a free particle over mean normal contact force");
  // The frame itself records the configuration that prepared it, so its name says nothing that a hash should keep.
  keys.text("preparation.from", preparation.from, "a file name", UsedBy::neither,
            "start from this prepared frame; relative to the scene's folder (with --set: to the working directory)");
}

void bind_drives(Specification& keys, ServoOptions& servo, ShearOptions& shear) {
  keys.number("servo.modulus", servo.modulus, kPositive, "Pa", UsedBy::dem,
              "stiffness of the assembly that the servo's gains refer to");
  keys.custom(
      {"servo.max_rate", "1/s", "largest lateral strain rate; auto: from the pressure and the servo's gains",
       "auto or a number > 0", UsedBy::dem},
      [&servo](const Value& value) {
        const bool scalar = value.is_scalar() && !value.quoted;
        const auto number = scalar ? parse_number(value.text) : std::nullopt;
        const bool automatic = scalar && value.text == "auto";
        if (!automatic && (!number || *number <= 0)) refuse(value, "servo.max_rate", "auto or a number > 0 [1/s]");
        servo.max_rate = automatic ? 0 : *number;
      },
      [&servo](UsedBy) { return servo.max_rate > 0 ? print_number(servo.max_rate) : "auto"; });
  keys.number("shear.axial_strain", shear.axial_strain, {0, 1, true, true}, "-", UsedBy::dem,
              "axial strain at which the test ends, 1 - H/H0 (the paper: 0.173)");
  keys.number("shear.strain_rate", shear.strain_rate, kPositive, "1/s", UsedBy::dem,
              "axial strain rate; quasi-static while the inertial number stays below 1e-3");
  keys.number("shear.ramp_strain", shear.ramp_strain, {0, 1, false, true}, "-", UsedBy::dem,
              "axial strain over which the rate grows from zero");
  keys.optional_number("shear.frame_interval", shear.frame_interval, {0, 1, true, true}, "-", UsedBy::dem,
                       "axial strain between two frames without breakage; auto: 0.005");
  keys.integer("shear.history_interval", shear.history_interval, 1, kMany, "steps", UsedBy::dem,
               "steps between two rows of the history");
}

void bind_guards(Specification& keys, GuardOptions& guards) {
  keys.number(
      "guards.unbalanced_force", guards.unbalanced_force, kPositive, "-", UsedBy::neither,
      "stop if it is never below this between two frames, with local damping and slow loading; at most 0.021 in "
      "sound runs");
  keys.number("guards.energy_residual", guards.energy_residual, kPositive, "-", UsedBy::neither,
              "stop if the ledger misses this share of boundary work and stored energy");
  keys.number("guards.servo_error", guards.servo_error, kPositive, "-", UsedBy::neither,
              "stop if the lateral stress is off its target by more than this between two frames, and comes no nearer");
  keys.number("guards.overlap", guards.overlap, kPositive, "-", UsedBy::neither,
              "stop if two particles in contact overlap by more than this share of the smaller one's area");
  keys.number("guards.steps", guards.steps, kPositive, "-", UsedBy::neither,
              "stop if the rest of the test would take more steps than this");
  keys.choice("guards.refusals", guards.refusals, {"stop", "continue"}, UsedBy::neither,
              "a particle whose breakage analysis is refused stops the run, or stays as it is");
}

void bind_output(Specification& keys, OutputOptions& output) {
  // A word or a count: `word` stands for the count 0, and `one` (if any) for 1.
  const auto count = [&keys](const std::string& path, int& value, const std::string& word, const std::string& one,
                             const std::string& description) {
    const std::string expected = word + (one.empty() ? "" : ", " + one) + " or an integer >= 1";
    keys.custom(
        {path, "-", description, expected, UsedBy::neither},
        [=, &value](const Value& given) {
          const bool scalar = given.is_scalar() && !given.quoted;
          const auto number = scalar ? parse_integer(given.text) : std::nullopt;
          if (scalar && given.text == word) {
            value = 0;
          } else if (scalar && !one.empty() && given.text == one) {
            value = 1;
          } else if (number && *number >= 1 && *number <= kMany) {
            value = static_cast<int>(*number);
          } else {
            refuse(given, path, expected);
          }
        },
        [=, &value](UsedBy) {
          if (value == 0) return word;
          return value == 1 && !one.empty() ? one : std::to_string(value);
        });
  };
  count("output.durability", output.durability.interval, "none", "every",
        "fsync after every frame and split, every N-th, or none: a power cut may cost the newest, which --resume makes "
        "anew");
  count("output.keep_frames", output.keep_frames, "all", "",
        "frames that stay on disk; a run takes only all, since every frame holds a part of the history");
}

Specification specification(Scene& scene) {
  Specification keys;
  keys.custom(
      {"seed", "-", "seed of the generator: shapes, sizes, places", "an integer in [0, 2^64 - 1]", UsedBy::dem},
      [&scene](const Value& value) {
        const auto number = value.is_scalar() && !value.quoted ? parse_unsigned(value.text) : std::nullopt;
        if (!number) refuse(value, "seed", "an integer in [0, 2^64 - 1], written in digits only");
        scene.seed = *number;
      },
      [&scene](UsedBy) { return std::to_string(scene.seed); });
  bind_effects(keys, scene.effects, EffectsOf::scene);
  bind_material(keys, scene.material, scene.file);
  bind_assembly(keys, scene.assembly);
  bind_contact(keys, scene);
  bind_preparation(keys, scene.preparation);
  bind_drives(keys, scene.servo, scene.shear);
  keys.number("breakage.interval", scene.breakage.interval, {0, 1, true, true}, "-", UsedBy::dem,
              "axial strain between two breakage analyses, with effect breakage");
  bind_mesh_nodes(keys, "breakage.nodes", scene.breakage.nodes);
  bind_particle_breakage(keys, scene.breakage);
  bind_guards(keys, scene.guards);
  bind_output(keys, scene.output);
  return keys;
}

bool on_command_line(const Specification& keys, const std::string& path) {
  return keys.where(path).rfind("--set ", 0) == 0;
}

// Absolute path of a file named by key `path`: relative to the scene's folder, or to the working directory if it came
// from the command line.
std::string absolute_name(const Specification& keys, const std::string& path, const std::string& name,
                          const std::filesystem::path& scene_file) {
  if (name.empty()) return name;
  const std::filesystem::path folder = on_command_line(keys, path)
                                           ? std::filesystem::current_path()
                                           : std::filesystem::absolute(scene_file).parent_path();
  return (folder / name).lexically_normal().string();
}

// Settles where the shapes come from; afterwards `source` is generated or outlines, so that the resolved scene holds
// all that a run needs and its hash covers the outlines themselves.
void resolve_shapes(Specification& keys, ShapeOptions& shapes) {
  const std::string source = "assembly.shapes.source";
  const std::string file = "assembly.shapes.file";
  const std::string outlines = "assembly.shapes.outlines";
  const auto overridden = [&keys](const std::string& path) { return on_command_line(keys, path); };
  // A file named on the command line alone replaces what the scene has.
  const bool new_file = overridden(file) && !overridden(source) && !overridden(outlines) && !shapes.file.empty();
  if (new_file) {
    shapes.source = "file";
  } else if (!keys.given(source)) {
    if (!shapes.outlines.empty() && !shapes.file.empty()) {
      keys.fail({file}, file + ": found both a file and outlines, expected one or the other");
      return;
    }
    if (!shapes.outlines.empty()) shapes.source = "outlines";
    if (!shapes.file.empty()) shapes.source = "file";
  }
  if (shapes.source == "generated" && (!shapes.file.empty() || !shapes.outlines.empty())) {
    keys.fail({source, file, outlines}, source + ": found \"generated\" although " +
                                            (shapes.file.empty() ? outlines : file) +
                                            " is given, expected one or the other");
  } else if (shapes.source == "outlines" && shapes.outlines.empty()) {
    keys.fail({outlines, source}, outlines + ": found none, expected at least one outline");
  } else if (shapes.source == "file") {
    if (shapes.file.empty()) {
      keys.fail({source}, file + ": found nothing, expected the name of a file of outlines");
      return;
    }
    try {
      shapes.outlines = read_outline_file(shapes.file);
      shapes.source = "outlines";
    } catch (const Error& error) {
      keys.fail({file}, file + ": " + error.what());
    }
  }
}

// Reads the grading's file; the diameters become the ends of the curve.
void resolve_grading(Specification& keys, AssemblyOptions& assembly) {
  const std::string path = "assembly.grading";
  if (!assembly.grading_file.empty()) {
    try {
      assembly.grading = read_grading_file(assembly.grading_file);
    } catch (const Error& error) {
      keys.fail({path}, path + ": " + error.what());
    }
  }
  if (assembly.grading.empty()) return;
  const auto settle = [&](const char* key, double& value, double end, const char* which) {
    // A curve on the command line alone replaces the diameters of the scene.
    const bool replaced = on_command_line(keys, path) && !on_command_line(keys, key);
    if (keys.given(key) && !replaced && value != end) {
      keys.fail({key}, std::string(key) + ": found " + print_number(value) + ", expected " + print_number(end) +
                           ", the " + which + " diameter of assembly.grading, or no such key [m]");
    }
    value = end;
  };
  settle("assembly.diameter_min", assembly.diameter_min, assembly.grading.front().diameter, "smallest");
  settle("assembly.diameter_max", assembly.diameter_max, assembly.grading.back().diameter, "largest");

  const double ratio = assembly.diameter_max / assembly.mean_diameter();
  const double enough = std::ceil(ratio * ratio / kLargestShare);
  if (assembly.particles < enough) {
    keys.fail({"assembly.particles", path},
              "assembly.particles: found " + std::to_string(assembly.particles) + ", expected at least " +
                  std::to_string(static_cast<std::int64_t>(enough)) +
                  " for this assembly.grading, so that one particle of the largest diameter is at most a tenth of the "
                  "mass");
  }
}

void check_between_keys(Specification& keys, const Scene& scene) {
  const Effects& effects = scene.effects;
  if (effects.toughness && !effects.breakage) {
    keys.fail({"effects"}, "effects: found toughness without breakage, expected both");
  }
  if (effects.face_friction && !effects.breakage) {
    keys.fail({"effects"}, "effects: found face_friction without breakage, expected both");
  }
  check_literal(keys, effects, scene.breakage);
  const AssemblyOptions& assembly = scene.assembly;
  if (assembly.diameter_min > assembly.diameter_max) {
    keys.fail({"assembly.diameter_min", "assembly.diameter_max"},
              "assembly.diameter_min: found " + print_number(assembly.diameter_min) +
                  ", expected at most assembly.diameter_max = " + print_number(assembly.diameter_max) + " [m]");
  }
  if (assembly.shapes.corners_min > assembly.shapes.corners_max) {
    keys.fail({"assembly.shapes.corners_min", "assembly.shapes.corners_max"},
              "assembly.shapes.corners_min: found " + std::to_string(assembly.shapes.corners_min) +
                  ", expected at most assembly.shapes.corners_max = " + std::to_string(assembly.shapes.corners_max));
  }
}

}  // namespace

double AssemblyOptions::mean_diameter() const {
  return grading.empty() ? 0.5 * (diameter_min + diameter_max) : diameter_of_mean_area(grading);
}

Scene read_scene(const std::filesystem::path& file, const Overrides& overrides) {
  Scene scene;
  scene.file = file;
  Specification keys = specification(scene);
  keys.read(load_document(file));
  keys.set(overrides);
  keys.finish();
  scene.preparation.from = absolute_name(keys, "preparation.from", scene.preparation.from, file);
  scene.assembly.shapes.file = absolute_name(keys, "assembly.shapes.file", scene.assembly.shapes.file, file);
  scene.assembly.grading_file = absolute_name(keys, "assembly.grading", scene.assembly.grading_file, file);
  resolve_shapes(keys, scene.assembly.shapes);
  resolve_grading(keys, scene.assembly);
  check_between_keys(keys, scene);
  keys.finish();
  return scene;
}

std::string to_yaml(const Scene& scene) {
  Scene copy = scene;
  return specification(copy).to_yaml("# The resolved scene: every key with its value, [unit] and meaning. SI units.\n");
}

std::string config_hash(const Scene& scene, UsedBy executable) {
  Scene copy = scene;
  return specification(copy).hash(executable);
}

std::vector<Key> scene_keys() {
  Scene scene;
  return specification(scene).keys();
}

}  // namespace common
