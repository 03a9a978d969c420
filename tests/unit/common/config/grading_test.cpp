#include "common/config/grading.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "common/config/scene.hpp"
#include "scratch.hpp"

using namespace common;

namespace {

const std::string kList = "[[0.1, 0], [0.2, 0.3], [0.3, 0.3], [0.5, 1]]";
const Grading kCurve{{0.1, 0}, {0.2, 0.3}, {0.3, 0.3}, {0.5, 1}};
const std::string kCsv = "# sieved\nDiameter, Passing\n0.1,0\n\n0.2 , 0.3\r\n0.3,0.3\n0.5,1\n";

}  // namespace

TEST_CASE("A grading may be a list, a CSV file or a YAML file, and gives the diameters") {
  const scratch::Folder folder;
  folder.write("g.csv", kCsv);
  folder.write("g.yaml", "- [0.1, 0]\n- [0.2, 0.3]\n- [0.3, 0.3]\n- [0.5, 1]\n");
  for (const std::string& value : {kList, std::string("g.csv"), std::string("g.yaml")}) {
    const auto assembly = read_scene(folder.write("s.yaml", "assembly: {grading: " + value + "}\n")).assembly;
    CHECK(assembly.grading == kCurve);
    CHECK(assembly.diameter_min == 0.1);
    CHECK(assembly.diameter_max == 0.5);
  }
  CHECK(read_scene(folder.write("s.yaml", "assembly: {grading: uniform}\n")).assembly.grading.empty());
}

TEST_CASE("Sizes of which there are none are dropped from the ends of a grading") {
  const scratch::Folder folder;
  const auto file = folder.write("g.csv", "0.01,0\n0.1,0\n0.2,1\n0.5,1\n0.9,1\n");
  CHECK(read_grading_file(file) == Grading{{0.1, 0}, {0.2, 1}});
}

TEST_CASE("A grading counts by its content, wherever it stands") {
  const scratch::Folder folder;
  folder.write("g.csv", kCsv);
  const auto hash = [&](const std::string& value, UsedBy executable = UsedBy::dem) {
    return config_hash(read_scene(folder.write("s.yaml", "assembly: {grading: " + value + "}\n")), executable);
  };
  const std::string listed = hash(kList);
  CHECK(hash("g.csv") == listed);
  CHECK(hash("uniform") != listed);
  CHECK(hash("uniform", UsedBy::xfem) == hash("g.csv", UsedBy::xfem));
  folder.write("g.csv", "0.1,0\n0.2,0.31\n0.3,0.31\n0.5,1\n");
  CHECK(hash("g.csv") != listed);

  // The resolved scene holds the curve: the file is not asked for again.
  const Scene scene = read_scene(folder / "s.yaml");
  std::filesystem::remove(folder / "g.csv");
  CHECK(config_hash(read_scene(folder.write("case.yaml", to_yaml(scene))), UsedBy::dem) ==
        config_hash(scene, UsedBy::dem));
}

TEST_CASE("A grading on the command line replaces the scene's sizes") {
  const scratch::Folder folder;
  const auto file = folder.write("s.yaml", "assembly: {diameter_min: 0.37, diameter_max: 0.57}\n");
  const auto assembly = read_scene(file, {"assembly.grading=" + kList}).assembly;
  CHECK(assembly.grading == kCurve);
  CHECK(assembly.diameter_max == 0.5);
  const auto other = folder.write("o.yaml", "assembly: {grading: g.csv}\n");
  CHECK(read_scene(other, {"assembly.grading=uniform"}).assembly.grading.empty());
}

TEST_CASE("A wrong grading is reported with its point and place") {
  const scratch::Folder folder;
  const auto error = [&](const std::string& value) {
    const auto file = folder.write("s.yaml", "assembly: {grading: " + value + "}\n");
    return scratch::message_of(folder, [&] { read_scene(file); });
  };
  const std::string key = "assembly.grading: ";
  const std::string kind = "uniform, a list, each item a point [diameter, passing], or the name of a file";
  CHECK(error("3") == "s.yaml:1:21: " + key + "found 3, expected " + kind);
  CHECK(error("{a: 1}") == "s.yaml:1:21: " + key + "found a map, expected " + kind);
  CHECK(error("[]") == "s.yaml:1:21: " + key + "found no point, expected two or more");
  CHECK(error("[[0.1, 0], [0.2]]") == "s.yaml:1:32: " + key + "found a list, expected a point [diameter, passing]");
  CHECK(error("[[0.1, 0], [0.2, a]]") == "s.yaml:1:38: " + key + "found \"a\", expected a number");
  const std::string point = key + "point 1 (counted from 0): found ";
  CHECK(error("[[0, 0]]") ==
        "s.yaml:1:22: " + key + "point 0 (counted from 0): found diameter 0.0, expected a number > 0 [m]");
  CHECK(error("[[0.1, 0.1], [0.2, 1]]") ==
        "s.yaml:1:22: " + key +
            "point 0 (counted from 0): found passing 0.1, expected 0 at the first point: nothing is finer");
  CHECK(error("[[0.1, 0], [0.2, 50]]") ==
        "s.yaml:1:32: " + point + "passing 50.0, expected a fraction by mass in [0, 1], not in percent");
  CHECK(error("[[0.1, 0], [0.05, 1]]") ==
        "s.yaml:1:32: " + point + "diameter 0.05, expected at least that of the point before, 0.1 [m]");
  CHECK(error("[[0.1, 0], [0.2, 0.5], [0.3, 0.4]]") ==
        "s.yaml:1:44: " + key +
            "point 2 (counted from 0): found passing 0.4, expected at least that of the point before, 0.5");
  CHECK(error("[[0.1, 0], [0.1, 0]]") ==
        "s.yaml:1:32: " + point + "diameter 0.1, expected another point than the one before");
  CHECK(error("[[0.1, 0], [0.2, 0.9]]") ==
        "s.yaml:1:32: " + point + "passing 0.9, expected 1 at the last point: everything is finer");

  const std::string place = "s.yaml:1:21: " + key;
  CHECK(error("none.csv") == place + "none.csv: the file does not exist");
  CHECK_THAT(error(std::string(300, 'x')), Catch::Matchers::EndsWith("x: the file cannot be read: File name too long"));
  folder.write("g.csv", "");
  CHECK(error("g.csv") == place + "g.csv: the file has no points of a curve, expected rows of diameter,passing");
  folder.write("g.csv", "d,p\n0.1,0\n0.2;1\n");
  CHECK(error("g.csv") == place + "g.csv:3: found \"0.2;1\", expected diameter,passing with 2 numbers");
  folder.write("g.csv", "d,p\n0.1,0\n0.2,100\n");
  CHECK(error("g.csv") ==
        place +
            "g.csv:3: grading: point 1 (counted from 0): found passing 100.0, expected a fraction by mass in [0, 1], "
            "not in percent");
}

TEST_CASE("A grading that contradicts other keys is refused") {
  const scratch::Folder folder;
  const auto error = [&](const std::string& keys) {
    const auto file = folder.write("s.yaml", "assembly:\n  grading: " + kList + "\n  " + keys + "\n");
    return scratch::message_of(folder, [&] { read_scene(file); });
  };
  CHECK(error("diameter_min: 0.2") ==
        "s.yaml:3:17: assembly.diameter_min: found 0.2, expected 0.1, the smallest diameter of assembly.grading, or no "
        "such key [m]");
  CHECK(error("diameter_max: 0.6") ==
        "s.yaml:3:17: assembly.diameter_max: found 0.6, expected 0.5, the largest diameter of assembly.grading, or no "
        "such key [m]");
  // By number the mean of d^2 is 1 / (0.3 / (0.1 0.2) + 0.7 / (0.3 0.5)) = 3/59; ten times 0.25 of it are 49.17.
  CHECK(
      error("particles: 49") ==
      "s.yaml:3:14: assembly.particles: found 49, expected at least 50 for this assembly.grading, so that one particle "
      "of the largest diameter is at most a tenth of the mass");
  CHECK(read_scene(folder.write("s.yaml", "assembly: {particles: 50, grading: " + kList + "}\n")).assembly.particles ==
        50);
}

TEST_CASE("The counted sizes of a grading hold its mass") {
  // Oracle: the mass d^2 of many particles at evenly spaced counts, summed.
  const int n = 200000;
  double all = 0, finer = 0;
  for (int i = 0; i < n; ++i) {
    const double d = diameter_at(kCurve, (i + 0.5) / n);
    CHECK((d <= 0.2 || d >= 0.3));
    all += d * d;
    if (d <= 0.15) finer += d * d;
  }
  CHECK(finer / all == Approx(0.15).epsilon(1e-4));
  CHECK(diameter_of_mean_area(kCurve) == Approx(std::sqrt(all / n)).epsilon(1e-5));
  CHECK(diameter_at(kCurve, 0) == 0.1);
  CHECK(diameter_at(kCurve, 1) == 0.5);
  const Grading one{{0.3, 0}, {0.3, 1}};
  CHECK(diameter_at(one, 0.7) == 0.3);
  CHECK(diameter_of_mean_area(one) == Approx(0.3));
}
