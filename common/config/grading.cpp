#include "common/config/grading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/config/csv.hpp"
#include "common/config/document.hpp"
#include "common/config/specification.hpp"
#include "common/config/values.hpp"
#include "common/error.hpp"

namespace common {
namespace {

const char* const kPoint = "a point [diameter, passing]";

/// Takes points in their order and refuses those that cannot follow.
class Curve {
 public:
  explicit Curve(std::string path) : path_(std::move(path)) {}

  void add(const GradingPoint& point, const std::string& where) {
    const auto require = [&](bool good, const char* name, double found, const std::string& expected) {
      if (good) return;
      throw bad_input(fmt::format("{}: {}: point {} (counted from 0): found {} {}, expected {}", where, path_,
                                  points_.size(), name, print_number(found), expected));
    };
    require(point.diameter > 0, "diameter", point.diameter, "a number > 0 [m]");
    require(point.passing >= 0 && point.passing <= 1, "passing", point.passing,
            "a fraction by mass in [0, 1], not in percent");
    if (points_.empty()) {
      require(point.passing == 0, "passing", point.passing, "0 at the first point: nothing is finer");
    } else {
      const GradingPoint& last = points_.back();
      require(point.diameter >= last.diameter, "diameter", point.diameter,
              fmt::format("at least that of the point before, {} [m]", print_number(last.diameter)));
      require(point.passing >= last.passing, "passing", point.passing,
              fmt::format("at least that of the point before, {}", print_number(last.passing)));
      require(point.diameter > last.diameter || point.passing > last.passing, "diameter", point.diameter,
              "another point than the one before");
    }
    points_.push_back(point);
    last_where_ = where;
  }

  /// The points between the last of which nothing is finer and the first of which everything is.
  Grading take() {
    if (points_.back().passing != 1) {
      throw bad_input(
          fmt::format("{}: {}: point {} (counted from 0): found passing {}, expected 1 at the last point: "
                      "everything is finer",
                      last_where_, path_, points_.size() - 1, print_number(points_.back().passing)));
    }
    const auto first =
        std::find_if(points_.begin(), points_.end(), [](const GradingPoint& p) { return p.passing > 0; });
    const auto last = std::find_if(first, points_.end(), [](const GradingPoint& p) { return p.passing == 1; });
    return {first - 1, last + 1};
  }

 private:
  std::string path_;
  Grading points_;
  std::string last_where_;
};

double read_number(const Value& value, const std::string& path) {
  const auto number = value.is_scalar() && !value.quoted ? parse_number(value.text) : std::nullopt;
  if (!number) refuse(value, path, "a number");
  return *number;
}

/// Number of particles between points k - 1 and k, in the unit in which their sum is 1 / (mean of d^2).
double count_before(const Grading& grading, std::size_t k) {
  return (grading[k].passing - grading[k - 1].passing) / (grading[k - 1].diameter * grading[k].diameter);
}

}  // namespace

Grading read_grading(const Value& list, const std::string& path) {
  if (!list.is_list()) refuse(list, path, std::string("a list, each item ") + kPoint);
  if (list.items.empty())
    throw bad_input(fmt::format("{}: {}: found no point, expected two or more", list.where, path));
  Curve curve(path);
  for (const Value& point : list.items) {
    if (!point.is_list() || point.items.size() != 2) refuse(point, path, kPoint);
    curve.add({read_number(point.items[0], path), read_number(point.items[1], path)}, point.where);
  }
  return curve.take();
}

Grading read_grading_file(const std::filesystem::path& file) {
  require_file(file, "a grading curve");
  if (file.extension() != ".csv") return read_grading(load_document(file), "grading");
  Curve curve("grading");
  for (const CsvRow& row : read_csv(file, "diameter,passing", false, "points of a curve")) {
    curve.add({row.numbers[0], row.numbers[1]}, row.where);
  }
  return curve.take();
}

std::string print_grading(const Grading& grading) {
  std::string text = "[";
  for (const GradingPoint& point : grading) {
    text += fmt::format("{}[{}, {}]", text.size() > 1 ? ", " : "", print_number(point.diameter),
                        print_number(point.passing));
  }
  return text + "]";
}

double diameter_of_mean_area(const Grading& grading) {
  double count = 0;
  for (std::size_t k = 1; k < grading.size(); ++k) count += count_before(grading, k);
  return std::sqrt(1 / count);
}

double diameter_at(const Grading& grading, double number) {
  double all = 0;
  for (std::size_t k = 1; k < grading.size(); ++k) all += count_before(grading, k);
  double wanted = number * all;
  for (std::size_t k = 1; k < grading.size(); ++k) {
    const double count = count_before(grading, k);
    if (count == 0) continue;
    const double smaller = grading[k - 1].diameter;
    const double larger = grading[k].diameter;
    if (wanted <= count) {
      const double share = wanted / count;
      return std::clamp(1 / ((1 - share) / smaller + share / larger), smaller, larger);
    }
    wanted -= count;
  }
  return grading.back().diameter;
}

}  // namespace common
