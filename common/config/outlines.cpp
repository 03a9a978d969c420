#include "common/config/outlines.hpp"

#include <string>

#include "common/config/csv.hpp"
#include "common/config/document.hpp"
#include "common/config/specification.hpp"
#include "common/config/values.hpp"
#include "common/error.hpp"
#include "common/geometry/overlap.hpp"

namespace common {
namespace {

// A fragment may have a vertex more than its parent; several generations must stay below the contacts' limit.
constexpr std::size_t kMostCorners = kMaxParticleVertices - 4;

double read_coordinate(const Value& value, const std::string& path) {
  const auto number = value.is_scalar() && !value.quoted ? parse_number(value.text) : std::nullopt;
  if (!number) refuse(value, path, "a number");
  return *number;
}

void check_outline(const Polygon& outline, std::size_t index, const std::string& where, const std::string& path) {
  std::string defect = outline_defect(outline);
  if (outline.size() > kMostCorners) defect = "has more than " + std::to_string(kMostCorners) + " vertices";
  if (defect.empty()) return;
  throw bad_input(where + ": " + path + ": outline " + std::to_string(index) + " (counted from 0): " + defect +
                  "; expected a convex outline, counter-clockwise");
}

std::vector<Polygon> outlines_of(const std::vector<CsvRow>& rows) {
  std::vector<Polygon> outlines;
  std::vector<std::string> starts;  // place of each outline's first row
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == 0 || rows[i].label != rows[i - 1].label) {
      outlines.emplace_back();
      starts.push_back(rows[i].where);
    }
    outlines.back().emplace_back(rows[i].numbers[0], rows[i].numbers[1]);
  }
  for (std::size_t i = 0; i < outlines.size(); ++i) check_outline(outlines[i], i, starts[i], "outlines");
  return outlines;
}

}  // namespace

std::vector<Polygon> read_outlines(const Value& list, const std::string& path) {
  if (!list.is_list()) refuse(list, path, "a list of outlines, each a list of [x, y]");
  std::vector<Polygon> outlines;
  for (const Value& points : list.items) {
    if (!points.is_list()) refuse(points, path, "an outline, which is a list of [x, y]");
    Polygon outline;
    for (const Value& point : points.items) {
      if (!point.is_list() || point.items.size() != 2) refuse(point, path, "a vertex [x, y]");
      const double x = read_coordinate(point.items[0], path);
      const double y = read_coordinate(point.items[1], path);
      outline.emplace_back(x, y);
    }
    check_outline(outline, outlines.size(), points.where, path);
    outlines.push_back(std::move(outline));
  }
  return outlines;
}

std::vector<Polygon> read_outline_file(const std::filesystem::path& file) {
  require_file(file, "outlines");
  if (file.extension() == ".csv") return outlines_of(read_csv(file, "type,x,y", true, "outlines"));
  std::vector<Polygon> outlines = read_outlines(load_document(file), "outlines");
  if (outlines.empty()) throw bad_input(file.string() + ": the list is empty, expected at least one outline");
  return outlines;
}

std::string print_outlines(const std::vector<Polygon>& outlines) {
  std::string text = "[";
  for (const Polygon& outline : outlines) {
    text += text.size() > 1 ? ", [" : "[";
    for (std::size_t i = 0; i < outline.size(); ++i) {
      text += (i > 0 ? ", [" : "[") + print_number(outline[i].x()) + ", " + print_number(outline[i].y()) + "]";
    }
    text += "]";
  }
  return text + "]";
}

}  // namespace common
