#include "common/config/scene.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <map>
#include <set>

#include "scratch.hpp"

using namespace common;

namespace {

Scene scene_of(const scratch::Folder& folder, const std::string& text, const Overrides& overrides = {}) {
  return read_scene(folder.write("s.yaml", text), overrides);
}

// A change of each key that keeps the scene valid: what both scenes have, and what the changed one has on top.
struct Change {
  Overrides common;
  Overrides changed;
};

std::map<std::string, Change> changes(const scratch::Folder& folder) {
  const std::string triangle = "0,0,0\n0,1,0\n0,0,1\n";
  const std::string one = folder.write("one.csv", triangle).string();
  const std::string two = folder.write("two.csv", triangle).string();
  std::map<std::string, Change> result;
  const std::map<std::string, std::string> simple{
      {"seed", "2"},
      {"material.rock", folder.write("rock.yaml", "name: of a file\n").string()},
      {"material.name", "granite"},
      {"material.source", "a book"},
      {"material.density", "2600"},
      {"material.sigma_ci", "151e6"},
      {"material.m_i", "24"},
      {"material.young_modulus", "21e9"},
      {"material.poisson_ratio", "0.25"},
      {"material.plane_stress", "true"},
      {"material.fracture_toughness", "2e6"},
      {"assembly.particles", "1195"},
      {"assembly.diameter_min", "0.36"},
      {"assembly.diameter_max", "0.58"},
      {"assembly.grading", "[[0.37, 0], [0.57, 1]]"},
      {"assembly.shapes.types", "13"},
      {"assembly.shapes.corners_min", "4"},
      {"assembly.shapes.corners_max", "9"},
      {"assembly.shapes.roughness", "0.2"},
      {"assembly.shapes.aspect", "0.9"},
      {"contact.law", "potential"},
      {"contact.normal_stiffness", "2e9"},
      {"contact.tangential_stiffness", "1e9"},
      {"contact.friction", "0.4"},
      {"contact.rolling_friction", "0.2"},
      {"damping.local", "0.4"},
      {"damping.contact", "0.3"},
      {"gravity.acceleration", "[0, -1.62]"},
      {"mass_scaling.smallest_mass", "0.1"},
      {"time_step.safety", "0.2"},
      {"neighbours.skin", "0.1"},
      {"preparation.confining_pressure", "1e6"},
      {"preparation.void_ratio", "0.31"},
      {"preparation.definition", "e1"},
      {"preparation.void_ratio_tolerance", "0.003"},
      {"preparation.compaction_rate", "0.2"},
      {"preparation.initial_friction", "0.9"},
      {"preparation.unbalanced_force", "0.002"},
      {"preparation.from", "prepared.h5"},
      {"servo.modulus", "2e8"},
      {"servo.max_rate", "0.5"},
      {"shear.axial_strain", "0.1"},
      {"shear.strain_rate", "0.01"},
      {"shear.ramp_strain", "0.002"},
      {"shear.frame_interval", "0.01"},
      {"shear.history_interval", "50"},
      {"breakage.interval", "0.001"},
      {"breakage.nodes", "75"},
      {"breakage.initiation_radius", "0.05"},
      {"breakage.minimum_fragment", "0.05"},
      {"breakage.minimum_area", "0.01"},
      {"breakage.max_cracks", "2"},
      {"breakage.face_friction", "0.4"},
      {"breakage.literal", "true"},
      {"guards.unbalanced_force", "0.2"},
      {"guards.energy_residual", "0.1"},
      {"guards.servo_error", "0.5"},
      {"guards.overlap", "0.9"},
      {"guards.steps", "1e10"},
      {"guards.refusals", "continue"},
      {"output.durability", "every"},
      {"output.keep_frames", "10"},
  };
  for (const auto& [path, value] : simple) result[path] = {{}, {path + "=" + value}};
  result["effects"] = {{}, {"effects=[breakage]"}};
  result["assembly.shapes.source"] = {{}, {"assembly.shapes=[[[0,0],[1,0],[0,1]]]"}};
  result["assembly.shapes.outlines"] = {{"assembly.shapes=[[[0,0],[1,0],[0,1]]]"},
                                        {"assembly.shapes=[[[0,0],[1,0],[0,1.1]]]"}};
  result["assembly.shapes.file"] = {{"assembly.shapes=" + one}, {"assembly.shapes=" + two}};
  return result;
}

}  // namespace

TEST_CASE("Keys that a scene does not give keep the defaults of the structs") {
  const scratch::Folder folder;
  const Scene scene = scene_of(folder, "seed: 7\n");
  const Scene defaults;
  CHECK(scene.seed == 7);
  CHECK(scene.file == folder / "s.yaml");
  CHECK_FALSE(scene.effects.friction);
  CHECK_FALSE(scene.effects.breakage);
  CHECK(scene.material.sigma_ci == 150e6);
  CHECK(scene.contact.law == ContactLaw::foundation);
  CHECK_FALSE(scene.contact.tangential_stiffness);
  CHECK(scene.preparation.from.empty());
  Scene seeded = defaults;
  seeded.seed = 7;
  CHECK(to_yaml(scene) == to_yaml(seeded));
}

TEST_CASE("Every kind of value is read into its member") {
  const scratch::Folder folder;
  const Scene scene = scene_of(folder, R"(
seed: 18446744073709551615
effects: [breakage, friction, gravity]
material: {sigma_ci: 1e8, m_i: 11, plane_stress: true}
assembly:
  particles: 30
  shapes: {types: 5, aspect: .5}
contact: {law: mean_depth, normal_stiffness: 1.0e+9, tangential_stiffness: 5e8}
gravity: {acceleration: [3, -9e0]}
preparation: {definition: e2, from: states/../p.h5}
servo: {max_rate: 0.1}
shear: {frame_interval: auto}
breakage:
output: {durability: 5, keep_frames: 3}
)");
  CHECK(scene.seed == 18446744073709551615ull);
  CHECK(scene.effects.breakage);
  CHECK(scene.effects.friction);
  CHECK(scene.effects.gravity);
  CHECK_FALSE(scene.effects.local_damping);
  CHECK_FALSE(scene.effects.energy_ledger);
  CHECK(scene.gravity.acceleration == Vec2(3, -9));
  CHECK(scene.material.sigma_ci == 1e8);
  CHECK(scene.material.m_i == 11);
  CHECK(scene.material.plane_stress);
  CHECK(scene.assembly.particles == 30);
  CHECK(scene.assembly.shapes.types == 5);
  CHECK(scene.assembly.shapes.aspect == 0.5);
  CHECK(scene.contact.law == ContactLaw::mean_depth);
  CHECK(scene.contact.normal_stiffness == 1e9);
  CHECK(scene.contact.tangential_stiffness == 5e8);
  CHECK(scene.preparation.definition == VoidRatioDefinition::e2);
  CHECK(scene.preparation.from == (folder / "p.h5").string());
  CHECK(scene.servo.max_rate == 0.1);
  CHECK_FALSE(scene.shear.frame_interval);
  CHECK(scene.output.durability.interval == 5);
  CHECK(scene.output.keep_frames == 3);
  CHECK(scene.frame_interval() == scene.breakage.interval);
  CHECK(scene_of(folder, "output: {durability: every, keep_frames: all}").output.durability.interval == 1);
  CHECK(scene_of(folder, "output: {durability: none}").output.durability.interval == 0);
  CHECK(scene_of(folder, "seed: &s 3\nassembly: {particles: *s}").assembly.particles == 3);
}

TEST_CASE("Overrides act after the file, in order, on keys and on whole sections") {
  const scratch::Folder folder;
  const Scene scene =
      scene_of(folder, "contact: {friction: 0.3, law: area}\neffects: [friction]\n",
               {"contact.friction=0.7", "contact={friction: 0.8, normal_stiffness: 1e9}", "effects=[]", "seed=4",
                "contact.tangential_stiffness=auto", "shear.axial_strain=0.01", "shear.axial_strain=0.02"});
  CHECK(scene.contact.friction == 0.8);
  CHECK(scene.contact.normal_stiffness == 1e9);
  CHECK(scene.contact.law == ContactLaw::area);
  CHECK_FALSE(scene.effects.friction);
  CHECK(scene.seed == 4);
  CHECK(scene.shear.axial_strain == 0.02);
  // A name from the command line is relative to the working directory, one from the file to the scene's folder.
  CHECK(scene_of(folder, "preparation: {from: a.h5}").preparation.from == (folder / "a.h5").string());
  CHECK(scene_of(folder, "seed: 1", {"preparation.from=a.h5"}).preparation.from ==
        (std::filesystem::current_path() / "a.h5").string());
  CHECK(scene_of(folder, "preparation: {from: a.h5}", {"preparation.from="}).preparation.from.empty());
}

TEST_CASE("The resolved scene reads back as the same scene") {
  const scratch::Folder folder;
  int tried = 0;
  for (const auto& [path, change] : changes(folder)) {
    INFO(path);
    Overrides overrides = change.common;
    overrides.insert(overrides.end(), change.changed.begin(), change.changed.end());
    overrides.emplace_back("material.m_i=24.100000000000001");
    const Scene scene = scene_of(folder, "contact: {law: mean_depth}\n", overrides);
    const Scene again = read_scene(folder.write("case.yaml", to_yaml(scene)));
    CHECK(to_yaml(again) == to_yaml(scene));
    CHECK(config_hash(again, UsedBy::dem) == config_hash(scene, UsedBy::dem));
    CHECK(config_hash(again, UsedBy::xfem) == config_hash(scene, UsedBy::xfem));
    ++tried;
  }
  CHECK(tried > 40);
}

TEST_CASE("File names with quotes, spaces and line breaks survive the resolved scene") {
  const scratch::Folder folder;
  Scene scene;
  scene.preparation.from = "/a \"b\"\\ # c:\n\td/\xc3\xa9.h5";
  CHECK(read_scene(folder.write("case.yaml", to_yaml(scene))).preparation.from == scene.preparation.from);
}

TEST_CASE("PyYAML reads the resolved scene with the types of the keys") {
  const scratch::Folder folder;
  const Scene scene = scene_of(
      folder,
      "effects: [friction, breakage]\nassembly: {shapes: [[[0,0],[1e7,0],[0,1e7]], [[0,0],[1e-7,0],[0,1e-7]]]}\n",
      {"contact.tangential_stiffness=1e9"});
  const auto resolved = folder.write("case.yaml", to_yaml(scene));
  const auto script = folder.write("types.py", R"(
import sys, yaml
def walk(value, path):
    if isinstance(value, dict):
        for key, item in value.items():
            walk(item, path + '.' + key if path else key)
    else:
        print(path, type(value).__name__)
walk(yaml.safe_load(open(sys.argv[1])), '')
x = yaml.safe_load(open(sys.argv[1]))
assert x['material']['sigma_ci'] == 150e6 and x['contact']['tangential_stiffness'] == 1e9
assert x['assembly']['shapes']['outlines'] == [[[0, 0], [1e7, 0], [0, 1e7]], [[0, 0], [1e-7, 0], [0, 1e-7]]]
assert all(type(c) is float for o in x['assembly']['shapes']['outlines'] for p in o for c in p)
)");
  const auto output = folder / "types.txt";
  const std::string command = "/usr/bin/python3 " + script.string() + " " + resolved.string() + " > " + output.string();
  REQUIRE(std::system(command.c_str()) == 0);

  std::map<std::string, std::string> types;
  std::istringstream lines(scratch::content(output));
  for (std::string path, type; lines >> path >> type;) types[path] = type;
  const std::vector<Key> keys = scene_keys();
  CHECK(types.size() == keys.size());
  for (const Key& key : keys) {
    INFO(key.path << ": " << key.expected);
    std::set<std::string> allowed;
    if (key.expected.find("auto or") == 0)
      allowed = {"float", "str"};
    else if (key.expected.find("a number") == 0)
      allowed = {"float"};
    else if (key.expected.find("an integer") == 0)
      allowed = {"int"};
    else if (key.expected.find("true") == 0)
      allowed = {"bool"};
    else if (key.expected.find("a list") == 0)
      allowed = {"list"};
    else
      allowed = {"str"};
    CHECK(allowed.count(types[key.path]) == 1);
  }
}

TEST_CASE(
    "Each key changes exactly the configuration hashes of the executables that use it, and only with its effect") {
  const scratch::Folder folder;
  const std::map<std::string, Change> table = changes(folder);
  const std::string every =
      "friction, local_damping, contact_damping, rolling_resistance, gravity, mass_scaling, energy_ledger, breakage";
  const std::string specimen = ", toughness, face_friction";
  int of_effects = 0;
  for (const Key& key : scene_keys()) {
    INFO(key.path);
    REQUIRE(table.count(key.path) == 1);
    const auto changed = [&](const std::string& effects, UsedBy executable) {
      const std::string base = "effects: [" + effects + "]\ncontact: {law: mean_depth}\n";
      const Scene before = scene_of(folder, base, table.at(key.path).common);
      const Scene after = scene_of(folder, base, table.at(key.path).changed);
      CHECK(to_yaml(before) != to_yaml(after));
      return config_hash(before, executable) != config_hash(after, executable);
    };
    const bool dem = key.used_by == UsedBy::dem || key.used_by == UsedBy::both;
    const bool xfem = key.used_by == UsedBy::xfem || key.used_by == UsedBy::both;
    // The literal reading goes with neither effect on one particle.
    const std::string all = key.path == "breakage.literal" ? every : every + specimen;
    CHECK(changed(all, UsedBy::dem) == dem);
    CHECK(changed(all, UsedBy::xfem) == xfem);
    const bool of_effect = key.description.find("with effect ") != std::string::npos ||
                           key.path.starts_with("breakage.") || key.path == "preparation.initial_friction";
    of_effects += of_effect;
    CHECK(changed("", UsedBy::dem) == (dem && !of_effect));
    CHECK(changed("", UsedBy::xfem) == (xfem && !of_effect));
  }
  CHECK(of_effects == 17);
}

TEST_CASE("Of the effects, xfem's configuration hash covers breakage alone") {
  const scratch::Folder folder;
  const Scene none = scene_of(folder, "effects: []\n");
  CHECK(config_hash(none, UsedBy::dem).size() == 32);
  for (const char* name : {"friction", "local_damping", "energy_ledger", "breakage"}) {
    INFO(name);
    const Scene one = scene_of(folder, "effects: [" + std::string(name) + "]\n");
    CHECK(config_hash(one, UsedBy::dem) != config_hash(none, UsedBy::dem));
    CHECK((config_hash(one, UsedBy::xfem) != config_hash(none, UsedBy::xfem)) == (std::string(name) == "breakage"));
  }
}

TEST_CASE("Effects on one particle count for xfem alone and need breakage, which is not the literal one") {
  const scratch::Folder folder;
  const Scene plain = scene_of(folder, "effects: [breakage]\n");
  for (const std::string name : {"toughness", "face_friction"}) {
    const Scene with = scene_of(folder, "effects: [breakage, " + name + "]\n");
    CHECK(config_hash(with, UsedBy::dem) == config_hash(plain, UsedBy::dem));
    CHECK(config_hash(with, UsedBy::xfem) != config_hash(plain, UsedBy::xfem));
    CHECK_THROWS_WITH(scene_of(folder, "effects: [" + name + "]\n"), Catch::Contains(name + " without breakage"));
    CHECK_THROWS_WITH(scene_of(folder, "effects: [breakage, " + name + "]\nbreakage: {literal: true}\n"),
                      Catch::Contains("expected false"));
  }
}

TEST_CASE("The configuration hash does not depend on how or where the scene is written") {
  const scratch::Folder folder;
  const Scene one = read_scene(folder.write("a.yaml", "contact: {friction: 0.50, law: foundation}\nseed: 1\n"));
  const Scene two = read_scene(folder.write("b.yaml", "# other order\nseed: 1\ncontact:\n  friction: 5e-1\n"));
  CHECK(config_hash(one, UsedBy::dem) == config_hash(two, UsedBy::dem));
  CHECK(config_hash(one, UsedBy::xfem) == config_hash(two, UsedBy::xfem));
}

TEST_CASE("Every key is documented, once, with a unit and what it expects") {
  std::set<std::string> paths;
  for (const Key& key : scene_keys()) {
    INFO(key.path);
    CHECK(paths.insert(key.path).second);
    CHECK_FALSE(key.unit.empty());
    CHECK(key.description.size() > 8);
    CHECK_FALSE(key.expected.empty());
  }
}

TEST_CASE("Every scene in configs is valid, and the paper's twins differ in their effects alone") {
  const std::filesystem::path configs = std::filesystem::path(ROCKBREAK_SOURCE_DIR) / "configs";
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(configs)) {
    // A scene; studies and campaigns have readers of their own.
    if (entry.path().extension() != ".yaml" ||
        scratch::content(entry.path()).find("\nassembly:") == std::string::npos) {
      continue;
    }
    INFO(entry.path());
    CHECK_NOTHROW(read_scene(entry.path()));
    ++scenes;
  }
  CHECK(scenes >= 3);
  Scene breakable = read_scene(configs / "biaxial_2MPa_breakable.yaml");
  const Scene twin = read_scene(configs / "biaxial_2MPa_nonbreakable.yaml");
  CHECK(breakable.effects.breakage);
  CHECK_FALSE(twin.effects.breakage);
  breakable.effects.breakage = false;
  CHECK(to_yaml(breakable) == to_yaml(twin));
}
