#include "xfem/crack/separation.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace xfem {
namespace {

/// Disjoint sets with path halving.
class Pieces {
 public:
  explicit Pieces(int count) : parent_(count), count_(count) {
    for (int i = 0; i < count; ++i) parent_[i] = i;
  }
  void join(int a, int b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    parent_[std::max(a, b)] = std::min(a, b);
    --count_;
  }
  int count() const { return count_; }

 private:
  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  std::vector<int> parent_;
  int count_;
};

/// A crack that crosses a mesh edge, and where.
struct Crossing {
  double fraction;  ///< from the edge's node of lower index
  int crack;
  bool is_tip;  ///< it cuts only one of the edge's elements
};

/// Part of a cut element that holds the edge's portion beyond the first `passed` crossings, -1 if there is none.
int part_at(const Mesh& mesh, const Enrichment& enrichment, const CutElement& element, int first_node,
            std::span<const Crossing> crossings, std::size_t passed) {
  const auto& triangle = mesh.triangles[element.element];
  const int local = triangle[0] == first_node ? 0 : triangle[1] == first_node ? 1 : 2;
  ShortList<int, 4> side;
  for (const int index : element.segments) {
    const CrackSegment& segment = enrichment.segments[index];
    int value = segment.side[local];
    for (std::size_t i = 0; i < passed; ++i) {
      if (crossings[i].crack == segment.crack) value = -value;
    }
    side.push_back(value);
  }
  for (std::size_t p = 0; p < element.parts.size(); ++p) {
    if (std::equal(side.begin(), side.end(), element.parts[p].side.begin())) return static_cast<int>(p);
  }
  return -1;
}

/// A single crack that meets no other cannot cut anything off unless both its ends are mouths.
bool stands_alone(const Mesh& mesh, std::span<const Crack> cracks, const Enrichment& enrichment) {
  if (cracks.size() < 2) return true;
  for (const CutElement& element : enrichment.cut) {
    if (element.segments.size() > 1) return false;
  }
  std::vector<std::array<int, 2>> tips;
  for (const Crack& crack : cracks) {
    for (const CrackPoint* end : {&crack.points.front(), &crack.points.back()}) {
      if (!on_boundary(mesh, *end)) tips.push_back(end->edge);
    }
  }
  std::sort(tips.begin(), tips.end());
  return std::adjacent_find(tips.begin(), tips.end()) == tips.end();
}

}  // namespace

bool is_separated(const Mesh& mesh, std::span<const Crack> cracks, const Enrichment& enrichment) {
  if (cracks.empty()) return false;
  for (const Crack& crack : cracks) {
    if (on_boundary(mesh, crack.points.front()) && on_boundary(mesh, crack.points.back())) return true;
  }
  if (stands_alone(mesh, cracks, enrichment)) return false;

  const int elements = static_cast<int>(mesh.triangles.size());
  std::vector<int> first_part(elements + 1, 0), cut_index(elements, -1);
  for (std::size_t i = 0; i < enrichment.cut.size(); ++i) cut_index[enrichment.cut[i].element] = static_cast<int>(i);
  for (int t = 0; t < elements; ++t) {
    const int parts = cut_index[t] < 0 ? 1 : static_cast<int>(enrichment.cut[cut_index[t]].parts.size());
    first_part[t + 1] = first_part[t] + parts;
  }
  Pieces pieces(first_part[elements]);
  std::vector<Crossing> crossings;
  for (int t = 0; t < elements; ++t) {
    for (int k = 0; k < 3; ++k) {
      const int other = mesh.neighbours[t][k];
      if (other < t) continue;
      const int first_node = std::min(mesh.triangles[t][(k + 1) % 3], mesh.triangles[t][(k + 2) % 3]);
      const int last_node = std::max(mesh.triangles[t][(k + 1) % 3], mesh.triangles[t][(k + 2) % 3]);
      crossings.clear();
      for (const int element : {t, other}) {
        if (cut_index[element] < 0) continue;
        for (const int index : enrichment.cut[cut_index[element]].segments) {
          const CrackSegment& segment = enrichment.segments[index];
          for (const CrackPoint* end : {&segment.first, &segment.last}) {
            if (end->edge != std::array<int, 2>{first_node, last_node}) continue;
            const auto known = std::find_if(crossings.begin(), crossings.end(),
                                            [&](const Crossing& crossing) { return crossing.crack == segment.crack; });
            if (known == crossings.end()) {
              crossings.push_back({end->fraction, segment.crack, true});
            } else {
              known->is_tip = false;
            }
          }
        }
      }
      std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
        return a.fraction != b.fraction ? a.fraction < b.fraction : a.crack < b.crack;
      });
      for (std::size_t passed = 0; passed <= crossings.size(); ++passed) {
        // Between two cracks at one point there is nothing, unless both end there: tips hold together.
        if (passed > 0 && passed < crossings.size()) {
          const Crossing &before = crossings[passed - 1], &after = crossings[passed];
          if (before.fraction == after.fraction && !(before.is_tip && after.is_tip)) continue;
        }
        std::array<int, 2> part{first_part[t], first_part[other]};
        bool both = true;
        for (int i = 0; i < 2; ++i) {
          const int element = i == 0 ? t : other;
          if (cut_index[element] < 0) continue;
          const int found =
              part_at(mesh, enrichment, enrichment.cut[cut_index[element]], first_node, crossings, passed);
          both = both && found >= 0;
          part[i] += found;
        }
        if (both) pieces.join(part[0], part[1]);
      }
    }
  }
  return pieces.count() > 1;
}

}  // namespace xfem
