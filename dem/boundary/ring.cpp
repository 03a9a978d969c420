#include "dem/boundary/ring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/error.hpp"

namespace dem {
namespace {

using common::cross;
using common::Vec2;

/// Quarter turns within which two contacts of the ball count as simultaneous.
constexpr double kSameTurn = 1e-9;

/// Centres sorted into square cells of the ball's diameter. Cell numbers are doubles and only occupied cells are
/// stored, so a particle far away costs nothing.
class Cells {
 public:
  Cells(std::span<const Vec2> centres, double size) : size_(size) {
    entries_.reserve(centres.size());
    for (std::size_t i = 0; i < centres.size(); ++i) {
      entries_.push_back(entry(centres[i], static_cast<std::int32_t>(i)));
    }
    std::sort(entries_.begin(), entries_.end(),
              [](const Entry& l, const Entry& r) { return before(l, r) || (!before(r, l) && l.index < r.index); });
  }

  /// Calls visit(index, squared distance) for the other centres nearer to centre i, which is at `at`, than the cell
  /// size.
  template <typename Visit>
  void for_neighbours(std::int32_t i, const Vec2& at, Visit&& visit) const {
    const Entry own = entry(at, i);
    for (const double row : {own.row - 1, own.row, own.row + 1}) {
      for (auto e = first_of(row, own.column - 1); e != entries_.end() && in_row(*e, row, own.column + 1); ++e) {
        const double squared = (e->at - at).squaredNorm();
        if (e->index != i && squared < size_ * size_) visit(e->index, squared);
      }
    }
  }

  /// Calls visit(index, index) once for each pair of centres nearer to each other than the cell size.
  template <typename Visit>
  void for_pairs(Visit&& visit) const {
    auto above = entries_.begin();  // the first that may be a neighbour in the row above
    for (auto e = entries_.begin(); e != entries_.end(); ++e) {
      const auto test = [&](const Entry& other) {
        if ((other.at - e->at).squaredNorm() < size_ * size_) visit(e->index, other.index);
      };
      for (auto f = e + 1; f != entries_.end() && in_row(*f, e->row, e->column + 1); ++f) test(*f);
      while (above != entries_.end() && before(*above, {e->row + 1, e->column - 1, {}, 0})) ++above;
      for (auto f = above; f != entries_.end() && in_row(*f, e->row + 1, e->column + 1); ++f) test(*f);
    }
  }

 private:
  struct Entry {
    double row, column;
    Vec2 at;
    std::int32_t index;
  };
  static bool before(const Entry& l, const Entry& r) {
    return l.row < r.row || (l.row == r.row && l.column < r.column);
  }
  static bool in_row(const Entry& e, double row, double last_column) { return e.row == row && e.column <= last_column; }
  Entry entry(const Vec2& at, std::int32_t i) const {
    return {std::floor(at.y() / size_), std::floor(at.x() / size_), at, i};
  }
  std::vector<Entry>::const_iterator first_of(double row, double column) const {
    return std::lower_bound(entries_.begin(), entries_.end(), Entry{row, column, {}, 0}, before);
  }

  double size_;
  std::vector<Entry> entries_;
};

/// Counter-clockwise turn from unit vector `from` to `to` in quarter turns, [0, 4): monotone in the angle.
double turn(const Vec2& from, const Vec2& to) {
  const double s = cross(from, to);
  const double c = from.dot(to);
  double quarters = 0;
  if (s >= 0) {
    quarters = c >= 0 ? s / (s + c) : 1 - c / (s - c);
  } else {
    quarters = c < 0 ? 2 + s / (s + c) : 3 + c / (c - s);
  }
  return quarters > 4 - kSameTurn ? 0 : quarters;
}

struct Group {
  std::vector<std::uint8_t> member;
  std::size_t size = 0;
};

/// The largest set of centres that are linked by gaps which the ball cannot pass.
Group largest_group(std::size_t count, const Cells& cells) {
  std::vector<std::int32_t> head(count);  // a forest; each root is the lowest index of its set
  std::iota(head.begin(), head.end(), 0);
  const auto root = [&](std::int32_t i) {
    while (head[i] != i) i = head[i] = head[head[i]];
    return i;
  };
  cells.for_pairs([&](std::int32_t i, std::int32_t j) {
    const std::int32_t a = root(i);
    const std::int32_t b = root(j);
    head[std::max(a, b)] = std::min(a, b);
  });
  std::vector<std::size_t> size(count, 0);
  for (std::size_t i = 0; i < count; ++i) ++size[root(static_cast<std::int32_t>(i))];
  const auto largest = std::max_element(size.begin(), size.end());

  Group group;
  group.size = *largest;
  group.member.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    group.member[i] = root(static_cast<std::int32_t>(i)) == largest - size.begin();
  }
  return group;
}

/// Centres that the ball touches one after the other while it rolls around the group, counter-clockwise; empty if it
/// does not come back to its first step.
std::vector<std::int32_t> roll(std::span<const Vec2> centres, const Cells& cells, const Group& group, double radius) {
  std::int32_t lowest = -1;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    if (!group.member[i]) continue;
    if (lowest < 0 || centres[i].y() < centres[lowest].y() ||
        (centres[i].y() == centres[lowest].y() && centres[i].x() < centres[lowest].x())) {
      lowest = static_cast<std::int32_t>(i);
    }
  }

  struct Touch {
    std::int32_t index;
    double turn, squared;
    Vec2 arm;
  };
  std::vector<Touch> touches;
  std::vector<std::int32_t> walk{lowest};
  Vec2 arm(0, -1);  // from the pivot to the ball's centre, in radii
  while (walk.size() <= 6 * group.size + 1) {
    const std::int32_t pivot = walk.back();
    touches.clear();
    double least = std::numeric_limits<double>::infinity();
    cells.for_neighbours(pivot, centres[pivot], [&](std::int32_t j, double squared) {
      const double half = 0.5 * std::sqrt(squared) / radius;
      if (!group.member[j] || half < 1e-12) return;
      // The ball that touches both lies to the right of the way from pivot to j.
      const Vec2 along = (centres[j] - centres[pivot]) / (2 * half * radius);
      const Vec2 next = half * along - std::sqrt(1 - std::min(1.0, half * half)) * common::perpendicular(along);
      const double quarters = turn(arm, next);
      least = std::min(least, quarters);
      touches.push_back({j, quarters, squared, next});
    });
    if (touches.empty()) return {};
    const Touch* chosen = nullptr;  // of several that are touched at once, the nearest
    for (const Touch& touch : touches) {
      if (touch.turn > least + kSameTurn) continue;
      if (!chosen || touch.squared < chosen->squared ||
          (touch.squared == chosen->squared && touch.index < chosen->index)) {
        chosen = &touch;
      }
    }
    if (walk.size() > 1 && pivot == walk[0] && chosen->index == walk[1]) {
      walk.pop_back();
      return walk;
    }
    const Vec2 ball = centres[pivot] + radius * chosen->arm;
    arm = (ball - centres[chosen->index]) / radius;
    arm /= std::sqrt(arm.squaredNorm());
    walk.push_back(chosen->index);
  }
  return {};
}

double polygon_area(std::span<const Vec2> centres, std::span<const std::int32_t> loop) {
  double twice = 0;
  for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
    twice += cross(centres[loop[k]] - centres[loop[0]], centres[loop[k + 1]] - centres[loop[0]]);
  }
  return 0.5 * twice;
}

struct Loop {
  std::vector<std::int32_t> indices;
  double area = 0;   ///< [m^2]
  double total = 0;  ///< with the loops that were cut off [m^2]
};

/// Cuts a closed walk where it meets itself and keeps the simple loop of largest area.
Loop largest_loop(std::span<const Vec2> centres, const std::vector<std::int32_t>& walk) {
  Loop best;
  const auto offer = [&](std::span<const std::int32_t> loop) {
    const double area = polygon_area(centres, loop);
    best.total += std::max(area, 0.0);
    if (area > best.area) {
      best.area = area;
      best.indices.assign(loop.begin(), loop.end());
    }
  };
  std::vector<std::int32_t> place(centres.size(), -1);
  std::vector<std::int32_t> open;
  for (const std::int32_t i : walk) {
    if (place[i] >= 0) {
      const auto from = static_cast<std::size_t>(place[i]);
      offer(std::span(open).subspan(from));
      for (std::size_t k = from + 1; k < open.size(); ++k) place[open[k]] = -1;
      open.resize(from + 1);
    } else {
      place[i] = static_cast<std::int32_t>(open.size());
      open.push_back(i);
    }
  }
  offer(open);
  return best;
}

}  // namespace

std::vector<std::int32_t> find_ring(std::span<const Vec2> centres, double ball_radius) {
  if (!(ball_radius > 0)) {
    throw common::bad_input(fmt::format("find_ring: ball radius {} found, a positive length expected", ball_radius));
  }
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    if (!std::isfinite(centres[i].x()) || !std::isfinite(centres[i].y())) {
      throw common::numerical_failure(fmt::format("find_ring: the position of particle index {} is not finite", i));
    }
    low = low.cwiseMin(centres[i]);
    high = high.cwiseMax(centres[i]);
  }
  if (centres.size() < 3) return {};

  const double extent = (high - low).norm();
  for (double radius = ball_radius;; radius *= 1.25) {
    const Cells cells(centres, 2 * radius);
    const Group group = largest_group(centres.size(), cells);
    Loop loop = largest_loop(centres, roll(centres, cells, group, radius));
    const bool good = 2 * group.size > centres.size() && loop.area > 0.9 * loop.total;
    if (good || radius > extent) {
      std::rotate(loop.indices.begin(), std::min_element(loop.indices.begin(), loop.indices.end()), loop.indices.end());
      return loop.indices;
    }
  }
}

}  // namespace dem
