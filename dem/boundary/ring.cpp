#include "dem/boundary/ring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

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
  Cells(std::span<const Vec2> centres, double size) : centres_(centres), size_(size) {
    entries_.reserve(centres.size());
    for (std::size_t i = 0; i < centres.size(); ++i) entries_.push_back(entry(static_cast<std::int32_t>(i)));
    std::sort(entries_.begin(), entries_.end(),
              [](const Entry& l, const Entry& r) { return before(l, r) || (!before(r, l) && l.index < r.index); });
  }

  /// Calls visit(index, squared distance) for the other centres nearer to centre i than the cell size.
  template <typename Visit>
  void for_neighbours(std::int32_t i, Visit&& visit) const {
    const Entry at = entry(i);
    for (const double row : {at.row - 1, at.row, at.row + 1}) {
      const Entry first{row, at.column - 1, 0};
      for (auto e = std::lower_bound(entries_.begin(), entries_.end(), first, before);
           e != entries_.end() && e->row == row && e->column <= at.column + 1; ++e) {
        if (e->index == i) continue;
        const double squared = (centres_[e->index] - centres_[i]).squaredNorm();
        if (squared < size_ * size_) visit(e->index, squared);
      }
    }
  }

 private:
  struct Entry {
    double row, column;
    std::int32_t index;
  };
  static bool before(const Entry& l, const Entry& r) {
    return l.row < r.row || (l.row == r.row && l.column < r.column);
  }
  Entry entry(std::int32_t i) const {
    return {std::floor(centres_[i].y() / size_), std::floor(centres_[i].x() / size_), i};
  }

  std::span<const Vec2> centres_;
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
Group largest_group(std::span<const Vec2> centres, const Cells& cells) {
  std::vector<std::int32_t> label(centres.size(), -1);
  std::vector<std::int32_t> stack;
  Group largest;
  std::int32_t best = -1;
  for (std::size_t seed = 0; seed < centres.size(); ++seed) {
    if (label[seed] >= 0) continue;
    const auto name = static_cast<std::int32_t>(seed);
    std::size_t size = 0;
    label[seed] = name;
    stack.push_back(name);
    while (!stack.empty()) {
      const std::int32_t i = stack.back();
      stack.pop_back();
      ++size;
      cells.for_neighbours(i, [&](std::int32_t j, double) {
        if (label[j] >= 0) return;
        label[j] = name;
        stack.push_back(j);
      });
    }
    if (size > largest.size) {
      largest.size = size;
      best = name;
    }
  }
  largest.member.resize(centres.size());
  for (std::size_t i = 0; i < centres.size(); ++i) largest.member[i] = label[i] == best;
  return largest;
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
    cells.for_neighbours(pivot, [&](std::int32_t j, double squared) {
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
    const Group group = largest_group(centres, cells);
    Loop loop = largest_loop(centres, roll(centres, cells, group, radius));
    const bool good = 2 * group.size > centres.size() && loop.area > 0.9 * loop.total;
    if (good || radius > extent) {
      std::rotate(loop.indices.begin(), std::min_element(loop.indices.begin(), loop.indices.end()), loop.indices.end());
      return loop.indices;
    }
  }
}

}  // namespace dem
