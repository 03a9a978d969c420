#include "dem/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dem {
namespace {

/// Cell numbers beyond this cannot be counted up one by one; whoever is that far away has no partner.
constexpr double kFarthestCell = 0x1p50;

}  // namespace

bool Neighbours::before(const Entry& l, const Entry& r) {
  if (l.level != r.level) return l.level < r.level;
  if (l.row != r.row) return l.row < r.row;
  return l.column != r.column ? l.column < r.column : l.index < r.index;
}

void Neighbours::sort_into_cells(const Particles& particles, const WorldOutlines& outlines) {
  const auto count = static_cast<std::int32_t>(particles.size());
  double smallest = std::numeric_limits<double>::infinity();
  for (std::int32_t i = 0; i < count; ++i) smallest = std::min(smallest, outlines.radius(i));

  entries_.clear();
  for (std::int32_t i = 0; i < count; ++i) {
    int level = 0;
    double largest = 2 * smallest;
    for (; outlines.radius(i) > largest; largest *= 2) ++level;
    const double cell = 2 * largest + skin_;
    const double row = std::floor(position_[i].y() / cell);
    const double column = std::floor(position_[i].x() / cell);
    if (std::abs(row) < kFarthestCell && std::abs(column) < kFarthestCell) entries_.push_back({level, row, column, i});
  }
  std::sort(entries_.begin(), entries_.end(), before);

  levels_.clear();
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    const int number = entries_[k].level;
    if (levels_.empty() || levels_.back().number != number) {
      const double largest = std::ldexp(smallest, number + 1);
      levels_.push_back({number, 2 * largest + skin_, largest, k, k});
    }
    levels_.back().last = k + 1;
  }
}

void Neighbours::rebuild(const Particles& particles, const WorldOutlines& outlines, std::vector<Pair>& pairs) {
  position_ = particles.position;
  sort_into_cells(particles, outlines);

  found_.clear();
  for (const Entry& entry : entries_) {
    const std::int32_t i = entry.index;
    const Vec2& at = position_[i];
    const double radius = outlines.radius(i);
    for (const Level& level : levels_) {
      if (level.number < entry.level) continue;
      const double reach = radius + level.radius + skin_;
      const double last_row = std::floor((at.y() + reach) / level.cell);
      const double first_column = std::floor((at.x() - reach) / level.cell);
      const double last_column = std::floor((at.x() + reach) / level.cell);
      const auto end = entries_.begin() + static_cast<std::ptrdiff_t>(level.last);
      for (double row = std::floor((at.y() - reach) / level.cell); row <= last_row; ++row) {
        auto e = std::lower_bound(entries_.begin() + static_cast<std::ptrdiff_t>(level.first), end,
                                  Entry{level.number, row, first_column, -1}, before);
        for (; e != end && e->row == row && e->column <= last_column; ++e) {
          const std::int32_t j = e->index;
          if (level.number == entry.level && j <= i) continue;
          const double touch = radius + outlines.radius(j) + skin_;
          if ((position_[j] - at).squaredNorm() > touch * touch) continue;
          if (particles.boundary[i] && particles.boundary[j]) continue;
          found_.push_back({std::min(i, j), std::max(i, j)});
        }
      }
    }
  }

  // Ascending by (a, b): counted by a, the few partners of each sorted.
  offset_.assign(particles.size() + 1, 0);
  for (const Pair& p : found_) ++offset_[p.a + 1];
  for (std::size_t i = 0; i < particles.size(); ++i) offset_[i + 1] += offset_[i];
  pairs.resize(found_.size());
  for (const Pair& p : found_) pairs[offset_[p.a]++] = p;
  std::size_t first = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const std::size_t last = offset_[i];
    std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.begin() + static_cast<std::ptrdiff_t>(last),
              [](const Pair& l, const Pair& r) { return l.b < r.b; });
    first = last;
  }
}

}  // namespace dem
