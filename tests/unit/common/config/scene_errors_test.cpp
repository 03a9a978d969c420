// Every way in which a scene can be wrong, with the exact place and message.
#include <catch2/catch.hpp>
#include <vector>

#include "common/config/scene.hpp"
#include "scratch.hpp"

using namespace common;

namespace {

std::string error_of(const std::string& text, const Overrides& overrides = {}) {
  const scratch::Folder folder;
  const auto file = folder.write("s.yaml", text);
  return scratch::message_of(folder, [&] { read_scene(file, overrides); });
}

const std::string kSections =
    "seed, effects, material, assembly, contact, damping, gravity, mass_scaling, time_step, neighbours, preparation, "
    "servo, shear, breakage, guards, output";
const std::string kStiffnessUnit = " [N/m for mean_depth and potential, N/m^2 for area and foundation]";

struct Case {
  std::string text;
  std::string message;
};

void check_all(const std::vector<Case>& cases) {
  for (const Case& one : cases) {
    INFO(one.text);
    CHECK(error_of(one.text) == one.message);
  }
}

}  // namespace

TEST_CASE("An unknown key is reported with the nearest valid one, or with all of its section") {
  check_all({
      {"contact:\n  normal_stifness: 1\n",
       "s.yaml:2:3: unknown key \"normal_stifness\" in contact; did you mean \"normal_stiffness\"?"},
      {"seed: 1\ncontat: {friction: 1}\n", "s.yaml:2:1: unknown key \"contat\"; did you mean \"contact\"?"},
      {"assembly: {shapes: {coners_min: 4}}\n",
       "s.yaml:1:21: unknown key \"coners_min\" in assembly.shapes; did you mean \"corners_min\"?"},
      {"zork: 1\n", "s.yaml:1:1: unknown key \"zork\"; expected one of " + kSections},
      {"material:\n  zork: 1\n",
       "s.yaml:2:3: unknown key \"zork\" in material; expected one of rock, name, source, density, sigma_ci, m_i, "
       "young_modulus, poisson_ratio, plane_stress, fracture_toughness"},
      {"friction: 0.5\n", "s.yaml:1:1: unknown key \"friction\"; did you mean \"contact.friction\"?"},
      {"contact.friction: 0.5\n",
       "s.yaml:1:1: unknown key \"contact.friction\"; expected it in its section, as in contact: {...}"},
      {"<<: {seed: 1}\n", "s.yaml:1:1: unknown key \"<<\"; expected one of " + kSections},
  });
}

TEST_CASE("A value of the wrong type is reported with what was found and expected") {
  check_all({
      {"contact:\n  friction: abc\n", "s.yaml:2:13: contact.friction: found \"abc\", expected a number >= 0"},
      {"contact: {friction: [1]}\n", "s.yaml:1:21: contact.friction: found a list, expected a number >= 0"},
      {"contact: {friction: {a: 1}}\n", "s.yaml:1:21: contact.friction: found a map, expected a number >= 0"},
      {"contact:\n  friction:\n", "s.yaml:2:3: contact.friction: found nothing, expected a number >= 0"},
      {"material: {m_i: \"25\"}\n", "s.yaml:1:17: material.m_i: found the quoted text \"25\", expected a number > 0"},
      {"contact: {tangential_stiffness: none}\n",
       "s.yaml:1:33: contact.tangential_stiffness: found \"none\", expected auto or a number > 0 [N/m]"},
      {"assembly: {particles: 3e2}\n",
       "s.yaml:1:23: assembly.particles: found 3e2, expected an integer in [1, 10000000], written in digits only"},
      {"assembly: {particles: 300.0}\n",
       "s.yaml:1:23: assembly.particles: found 300.0, expected an integer in [1, 10000000], written in digits only"},
      {"seed: -1\n", "s.yaml:1:7: seed: found -1, expected an integer in [0, 2^64 - 1], written in digits only"},
      {"seed: 1e3\n", "s.yaml:1:7: seed: found 1e3, expected an integer in [0, 2^64 - 1], written in digits only"},
      {"material: {plane_stress: yes}\n", "s.yaml:1:26: material.plane_stress: found \"yes\", expected true or false"},
      {"material: {plane_stress: 1}\n", "s.yaml:1:26: material.plane_stress: found 1, expected true or false"},
      {"material: {plane_stress: \"true\"}\n",
       "s.yaml:1:26: material.plane_stress: found the quoted text \"true\", expected true or false"},
      {"contact: {law: meandepth}\n",
       "s.yaml:1:16: contact.law: found \"meandepth\", expected one of mean_depth, area, potential, foundation; did "
       "you mean "
       "\"mean_depth\"?"},
      {"contact: {law: 3}\n",
       "s.yaml:1:16: contact.law: found 3, expected one of mean_depth, area, potential, foundation"},
      {"contact: {law: [area]}\n",
       "s.yaml:1:16: contact.law: found a list, expected one of mean_depth, area, potential, foundation"},
      {"preparation: {from: [1]}\n", "s.yaml:1:21: preparation.from: found a list, expected a file name"},
      {"output: {durability: sometimes}\n",
       "s.yaml:1:22: output.durability: found \"sometimes\", expected none, every or an integer >= 1"},
      {"output: {keep_frames: 0}\n", "s.yaml:1:23: output.keep_frames: found 0, expected all or an integer >= 1"},
      {"contact: [1, 2]\n",
       "s.yaml:1:10: contact: found a list, expected a map of keys (law, normal_stiffness, tangential_stiffness, "
       "friction, rolling_friction)"},
      {"contact: 3\n",
       "s.yaml:1:10: contact: found 3, expected a map of keys (law, normal_stiffness, tangential_stiffness, friction, "
       "rolling_friction)"},
      {"- seed\n", "s.yaml:1:1: found a list, expected a map of keys (" + kSections + ")"},
      {"hello\n", "s.yaml:1:1: found \"hello\", expected a map of keys (" + kSections + ")"},
      {"? [1, 2]\n: 3\n", "s.yaml:1:3: found a list as a key, expected a name"},
  });
}

TEST_CASE("A number out of its range is reported at each kind of bound") {
  check_all({
      {"contact: {normal_stiffness: -1}\n",
       "s.yaml:1:29: contact.normal_stiffness: found -1, expected a number > 0" + kStiffnessUnit},
      {"contact: {normal_stiffness: 0}\n",
       "s.yaml:1:29: contact.normal_stiffness: found 0, expected a number > 0" + kStiffnessUnit},
      {"contact: {friction: -0.1}\n", "s.yaml:1:21: contact.friction: found -0.1, expected a number >= 0"},
      {"contact: {tangential_stiffness: 0}\n",
       "s.yaml:1:33: contact.tangential_stiffness: found 0, expected auto or a number > 0 [N/m]"},
      {"material: {poisson_ratio: 0.5}\n",
       "s.yaml:1:27: material.poisson_ratio: found 0.5, expected a number in [0, 0.5)"},
      {"material: {m_i: 0}\n", "s.yaml:1:17: material.m_i: found 0, expected a number > 0"},
      {"time_step: {safety: 0}\n", "s.yaml:1:21: time_step.safety: found 0, expected a number in (0, 1]"},
      {"time_step: {safety: 1.01}\n", "s.yaml:1:21: time_step.safety: found 1.01, expected a number in (0, 1]"},
      {"breakage: {minimum_fragment: 0.51}\n",
       "s.yaml:1:30: breakage.minimum_fragment: found 0.51, expected a number in [0, 0.5]"},
      {"breakage: {nodes: 3}\n", "s.yaml:1:19: breakage.nodes: found 3, expected an integer in [12, 1000000]"},
      {"shear: {axial_strain: 1}\n", "s.yaml:1:23: shear.axial_strain: found 1, expected a number in (0, 1)"},
      {"servo: {max_rate: 0}\n", "s.yaml:1:19: servo.max_rate: found 0, expected auto or a number > 0 [1/s]"},
      {"assembly: {diameter_max: -0.5}\n", "s.yaml:1:26: assembly.diameter_max: found -0.5, expected a number > 0 [m]"},
      {"contact: {friction: 1e999}\n", "s.yaml:1:21: contact.friction: found 1e999, expected a number >= 0"},
  });
  CHECK(error_of("time_step: {safety: 1}\nmaterial: {poisson_ratio: 0}\nbreakage: {minimum_fragment: 0.5}\n") ==
        "no error");
}

TEST_CASE("NaN and infinity are no numbers") {
  check_all({
      {"contact: {friction: .nan}\n", "s.yaml:1:21: contact.friction: found .nan, expected a number >= 0"},
      {"contact: {friction: .inf}\n", "s.yaml:1:21: contact.friction: found .inf, expected a number >= 0"},
      {"contact: {friction: -.inf}\n", "s.yaml:1:21: contact.friction: found -.inf, expected a number >= 0"},
      {"contact: {friction: nan}\n", "s.yaml:1:21: contact.friction: found \"nan\", expected a number >= 0"},
      {"contact: {tangential_stiffness: .inf}\n",
       "s.yaml:1:33: contact.tangential_stiffness: found .inf, expected auto or a number > 0 [N/m]"},
  });
}

TEST_CASE("A duplicate key is reported with its first place, at every level") {
  check_all({
      {"seed: 1\nseed: 1\n", "s.yaml:2:1: duplicate key \"seed\", first given at s.yaml:1:1; expected each key once"},
      {"contact:\n  friction: 1\n  friction: 2\n",
       "s.yaml:3:3: duplicate key \"friction\" in contact, first given at s.yaml:2:3; expected each key once"},
      {"assembly: {shapes: {types: 3, types: 4}}\n",
       "s.yaml:1:31: duplicate key \"types\" in assembly.shapes, first given at s.yaml:1:21; expected each key once"},
      {"contact: {law: area}\nseed: 3\ncontact: {friction: 1}\n",
       "s.yaml:3:1: duplicate key \"contact\", first given at s.yaml:1:1; expected each key once"},
  });
}

TEST_CASE("Syntax errors are reported with line and column") {
  check_all({
      {"contact: {friction: 0.5\n", "s.yaml:2:1: syntax error: end of map flow not found, expected valid YAML"},
      {"contact:\n\tfriction: 0.5\n", "s.yaml:2:1: syntax error: found a tab in the indentation, expected spaces"},
      {"contact:\n  law: area\n \tfriction: 0.5\n",
       "s.yaml:3:2: syntax error: found a tab in the indentation, expected spaces"},
      {"seed: 1\n---\nseed: 2\n", "s.yaml:2:1: found a second YAML document, expected one"},
      {": \n%\n,", "s.yaml:3:1: found a second YAML document, expected one"},  // without end for yaml-cpp
      {"effects: *nothing\n", "s.yaml:1:10: syntax error: the referenced anchor is not defined, expected valid YAML"},
      {"effects: &a [*a]\n", "s.yaml:1:10: the document is nested or repeated too often, expected at most 32 levels"},
      {std::string(100, '['), "s.yaml:1:1: syntax error: end of sequence flow not found, expected valid YAML"},
  });
}

TEST_CASE("A file that cannot be a scene is named") {
  const scratch::Folder folder;
  const auto read = [&](const std::filesystem::path& file) {
    return scratch::message_of(folder, [&] { read_scene(file); });
  };
  CHECK(read(folder / "none.yaml") == "none.yaml: the file does not exist");
  std::filesystem::create_directory(folder / "dir.yaml");
  CHECK(read(folder / "dir.yaml") == "dir.yaml: found a directory, expected a YAML file");
  for (const char* text : {"", "\n\n", "# only a comment\n", "---\n"}) {
    CHECK(read(folder.write("e.yaml", text)) == "e.yaml: the file is empty, expected YAML with at least one key");
  }
}

TEST_CASE("Effects are a list of known names, each once") {
  const std::string list =
      "a list of friction, local_damping, contact_damping, rolling_resistance, gravity, mass_scaling, energy_ledger, "
      "breakage, toughness, face_friction";
  check_all({
      {"effects: [friction, zork]\n", "s.yaml:1:21: effects: found \"zork\", expected " + list},
      {"effects: [frictoin]\n",
       "s.yaml:1:11: effects: found \"frictoin\", expected " + list + "; did you mean \"friction\"?"},
      {"effects: [friction, breakage, friction]\n",
       "s.yaml:1:31: effects: found \"friction\" twice, expected each effect once"},
      {"effects: friction\n", "s.yaml:1:10: effects: found \"friction\", expected " + list},
      {"effects: [[friction]]\n", "s.yaml:1:11: effects: found a list, expected " + list},
  });
}

TEST_CASE("An acceleration is a list of two finite numbers") {
  const std::string expected = "s.yaml:1:25: gravity.acceleration: found ";
  check_all({
      {"gravity: {acceleration:  -9.81}\n",
       "s.yaml:1:26: gravity.acceleration: found -9.81, expected a list of two "
       "numbers [m/s^2]"},
      {"gravity: {acceleration: [0]}\n", expected + "a list, expected a list of two numbers [m/s^2]"},
      {"gravity: {acceleration: [0, -1, 0]}\n", expected + "a list, expected a list of two numbers [m/s^2]"},
      {"gravity: {acceleration: [0, down]}\n",
       "s.yaml:1:29: gravity.acceleration: found \"down\", expected a number [m/s^2]"},
      {"gravity: {acceleration: [.nan, 0]}\n",
       "s.yaml:1:26: gravity.acceleration: found .nan, expected a number [m/s^2]"},
  });
}

TEST_CASE("Keys that contradict each other are reported where the first of them stands") {
  check_all({
      {"assembly: {diameter_min: 0.6}\n",
       "s.yaml:1:26: assembly.diameter_min: found 0.6, expected at most assembly.diameter_max = 0.57 [m]"},
      {"assembly: {diameter_max: 0.2}\n",
       "s.yaml:1:26: assembly.diameter_min: found 0.37, expected at most assembly.diameter_max = 0.2 [m]"},
      {"assembly: {shapes: {corners_min: 9}}\n",
       "s.yaml:1:34: assembly.shapes.corners_min: found 9, expected at most assembly.shapes.corners_max = 8"},
  });
}

TEST_CASE("All errors of a scene are reported at once") {
  CHECK(error_of("seed: x\ncontact:\n  lav: area\n  friction: -1\n", {"shear.axial_strain=2"}) ==
        "s.yaml:1:7: seed: found \"x\", expected an integer in [0, 2^64 - 1], written in digits only\n"
        "s.yaml:3:3: unknown key \"lav\" in contact; did you mean \"law\"?\n"
        "s.yaml:4:13: contact.friction: found -1, expected a number >= 0\n"
        "--set shear.axial_strain=2: shear.axial_strain: found 2, expected a number in (0, 1)");
}

TEST_CASE("Overrides are validated like the file and name themselves") {
  const auto error = [](const std::string& assignment) { return error_of("seed: 1\n", {assignment}); };
  CHECK(error("contact.friction=-1") ==
        "--set contact.friction=-1: contact.friction: found -1, expected a number >= 0");
  CHECK(error("contact.friction=.nan") ==
        "--set contact.friction=.nan: contact.friction: found .nan, expected a number >= 0");
  CHECK(error("contact.fricton=1") ==
        "--set contact.fricton=1: unknown key \"fricton\" in contact; did you mean \"friction\"?");
  CHECK(error("contat.friction=1") == "--set contat.friction=1: unknown key \"contat\"; did you mean \"contact\"?");
  CHECK(error("zork=1") == "--set zork=1: unknown key \"zork\"; expected one of " + kSections);
  CHECK(error("contact.friction") == "--set contact.friction: expected KEY=VALUE, for example --set seed=2");
  CHECK(error("=1") == "--set =1: expected KEY=VALUE, for example --set seed=2");
  CHECK(error("contact.friction=") ==
        "--set contact.friction=: contact.friction: found nothing, expected a number >= 0");
  CHECK(error("contact.friction=[1") ==
        "--set contact.friction=[1: syntax error: end of sequence flow not found, expected valid YAML");
  CHECK(error("contact.friction.x=1") ==
        "--set contact.friction.x=1: unknown key \"x\" in contact.friction; expected a value of contact.friction, "
        "which has no keys below it");
  CHECK(error("contact..friction=1").find("--set contact..friction=1: unknown key \"\" in contact; ") == 0);
  CHECK(error("contact={law: aera}") ==
        "--set contact={law: aera}: contact.law: found \"aera\", expected one of mean_depth, area, potential, "
        "foundation; did you "
        "mean \"area\"?");
  CHECK(error("contact={friction: 1, friction: 2}") ==
        "--set contact={friction: 1, friction: 2}: duplicate key \"friction\" in contact, first given at --set "
        "contact={friction: 1, friction: 2}; expected each key once");
  CHECK(error("effects=[breakage, breakage]") ==
        "--set effects=[breakage, breakage]: effects: found \"breakage\" twice, expected each effect once");
  CHECK(error("assembly.diameter_min=0.6") ==
        "--set assembly.diameter_min=0.6: assembly.diameter_min: found 0.6, expected at most assembly.diameter_max = "
        "0.57 [m]");
}
