#include "common/config/outlines.hpp"

#include <catch2/catch.hpp>

#include "common/config/scene.hpp"
#include "scratch.hpp"

using namespace common;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

const std::string kSquare = "[[0, 0], [1, 0], [1, 1], [0, 1]]";
const std::string kTriangle = "[[0, 0], [2, 0], [1, 1.5]]";

}  // namespace

TEST_CASE("Shapes may be a map, a list of outlines or the name of a file") {
  const scratch::Folder folder;
  const auto shapes = [&](const std::string& value, const Overrides& overrides = {}) {
    return read_scene(folder.write("s.yaml", "assembly: {shapes: " + value + "}\n"), overrides).assembly.shapes;
  };
  folder.write("o.yaml", "- " + kSquare + "\n- " + kTriangle + "\n");
  folder.write("o.csv", "# drawn by hand\ntype, x, y\n0,0,0\n0,1,0\n0,1,1\n0,0,1\n\n7,0,0\n7,2,0\r\n7,1,1.5\n");

  const ShapeOptions listed = shapes("[" + kSquare + ", " + kTriangle + "]");
  CHECK(listed.source == "outlines");
  REQUIRE(listed.outlines.size() == 2);
  CHECK(listed.outlines[0].size() == 4);
  CHECK(listed.outlines[1][2] == Vec2(1, 1.5));

  for (const char* name : {"o.yaml", "o.csv"}) {
    const ShapeOptions read = shapes(name);
    CHECK(read.source == "outlines");
    CHECK(read.file == (folder / name).string());
    CHECK(read.outlines == listed.outlines);
    CHECK(shapes("{file: " + std::string(name) + "}").outlines == listed.outlines);
    CHECK(shapes("{source: file, file: " + std::string(name) + "}").outlines == listed.outlines);
  }

  CHECK(shapes("{types: 5}").source == "generated");
  CHECK(shapes("generated").source == "generated");
  CHECK(shapes("o.csv", {"assembly.shapes=generated"}).outlines.empty());
  CHECK(shapes("o.csv", {"assembly.shapes=[" + kSquare + "]"}).outlines.size() == 1);
  const std::string other = folder.write("one.yaml", "- " + kSquare + "\n").string();
  CHECK(shapes("{source: outlines, outlines: [" + kTriangle + "]}", {"assembly.shapes.file=" + other})
            .outlines[0]
            .size() == 4);
}

TEST_CASE("A scene that was resolved does not need the file of its outlines again") {
  const scratch::Folder folder;
  folder.write("o.csv", "0,0,0\n0,1,0\n0,0.3,0.7\n");
  const Scene scene = read_scene(folder.write("s.yaml", "assembly: {shapes: o.csv}\n"));
  std::filesystem::remove(folder / "o.csv");
  const Scene again = read_scene(folder.write("case.yaml", to_yaml(scene)));
  CHECK(again.assembly.shapes.outlines == scene.assembly.shapes.outlines);
  CHECK(config_hash(again, UsedBy::dem) == config_hash(scene, UsedBy::dem));
}

TEST_CASE("A wrong outline is reported with its number, vertex and place") {
  const scratch::Folder folder;
  const auto error = [&](const std::string& value) {
    const auto file = folder.write("s.yaml", "assembly:\n  shapes: " + value + "\n");
    return scratch::message_of(folder, [&] { read_scene(file); });
  };
  const std::string key = "assembly.shapes.outlines: ";
  const std::string dented = error("\n    - " + kSquare + "\n    - [[0, 0], [2, 0], [1, 0.1], [1, 1]]");
  CHECK_THAT(dented, StartsWith("s.yaml:4:7: " + key + "outline 1 (counted from 0): "));
  CHECK_THAT(dented, Contains("not convex") && Contains("vertex 2"));
  CHECK_THAT(error("[[[0, 0], [0, 1], [1, 1], [1, 0]]]"), StartsWith("s.yaml:2:12: " + key + "outline 0"));
  CHECK_THAT(error("[[[0, 0], [1, 0]]]"), StartsWith("s.yaml:2:12: " + key + "outline 0 (counted from 0): "));
  CHECK(error("[[[0, 0], [1, a], [1, 1]]]") == "s.yaml:2:25: " + key + "found \"a\", expected a number");
  CHECK(error("[[[0, 0], [1, .nan], [1, 1]]]") == "s.yaml:2:25: " + key + "found .nan, expected a number");
  CHECK(error("[[[0, 0], [1], [1, 1]]]") == "s.yaml:2:21: " + key + "found a list, expected a vertex [x, y]");
  std::string round;  // 61 points on a parabola: convex, but more than contacts can take
  for (int i = -30; i <= 30; ++i)
    round += (round.empty() ? "[" : ", [") + std::to_string(i) + ", " + std::to_string(i * i) + "]";
  CHECK_THAT(error("[[" + round + "]]"), StartsWith("s.yaml:2:12: " + key + "outline 0") && Contains("60 vertices"));
  CHECK(error("[[0, 0], [1, 0]]") == "s.yaml:2:13: " + key + "found 0, expected a vertex [x, y]");
  CHECK(error("[3]") == "s.yaml:2:12: " + key + "found 3, expected an outline, which is a list of [x, y]");
  CHECK(error("{outlines: 3}") ==
        "s.yaml:2:22: " + key + "found 3, expected a list of outlines, each a list of [x, y]");
}

TEST_CASE("Sources of shapes that contradict each other are refused") {
  const scratch::Folder folder;
  folder.write("o.csv", "0,0,0\n0,1,0\n0,0.3,0.7\n");
  const auto error = [&](const std::string& value) {
    const auto file = folder.write("s.yaml", "assembly: {shapes: " + value + "}\n");
    return scratch::message_of(folder, [&] { read_scene(file); });
  };
  CHECK(error("{source: outlines}") ==
        "s.yaml:1:29: assembly.shapes.outlines: found none, expected at least one outline");
  CHECK(error("[]") == "s.yaml:1:20: assembly.shapes.outlines: found none, expected at least one outline");
  CHECK(error("{source: file}") ==
        "s.yaml:1:29: assembly.shapes.file: found nothing, expected the name of a file of outlines");
  CHECK(error("{source: generated, file: o.csv}") ==
        "s.yaml:1:29: assembly.shapes.source: found \"generated\" although assembly.shapes.file is given, expected one "
        "or the other");
  CHECK(error("{file: o.csv, outlines: [" + kSquare + "]}") ==
        "s.yaml:1:27: assembly.shapes.file: found both a file and outlines, expected one or the other");
}

TEST_CASE("A file of outlines is checked with its lines") {
  const scratch::Folder folder;
  const auto error = [&](const std::string& name, const std::string& text) {
    folder.write(name, text);
    const auto file = folder.write("s.yaml", "assembly: {shapes: " + name + "}\n");
    return scratch::message_of(folder, [&] { read_scene(file); });
  };
  const std::string place = "s.yaml:1:20: assembly.shapes.file: ";
  std::filesystem::create_directory(folder / "d.csv");
  const auto scene = folder.write("s.yaml", "assembly: {shapes: none.csv}\n");
  CHECK(scratch::message_of(folder, [&] { read_scene(scene); }) == place + "none.csv: the file does not exist");
  CHECK(scratch::message_of(folder, [&] { read_outline_file(folder / "d.csv"); }) ==
        "d.csv: found a directory, expected a file of outlines");
  CHECK(error("o.csv", "") == place + "o.csv: the file has no outlines, expected rows of type,x,y");
  CHECK(error("o.csv", "type,x,y\n0,0,0\n0,a,0\n") ==
        place + "o.csv:3: found \"0,a,0\", expected type,x,y with 2 numbers");
  CHECK(error("o.csv", "0,0,0\n0,1\n") == place + "o.csv:2: found \"0,1\", expected type,x,y with 2 numbers");
  CHECK_THAT(error("o.csv", "0,0,0\n0,1,0\n0,0,1\n1,0,0\n1,2,0\n1,1,0.1\n1,1,1\n"),
             StartsWith(place + "o.csv:4: outlines: outline 1 (counted from 0): ") && Contains("vertex 2"));
  CHECK(error("o.yaml", "[]") == place + "o.yaml: the list is empty, expected at least one outline");
  CHECK(error("o.yaml", "a: 1") ==
        place + "o.yaml:1:1: outlines: found a map, expected a list of outlines, each a list of [x, y]");
}
