#include "xfem/crack_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"

namespace xfem {

namespace {

bool has_particle(const common::Frame& frame, std::int64_t id) {
  return std::binary_search(frame.particles.id.begin(), frame.particles.id.end(), id);
}

/// True if the point stands on an edge of the mesh, where it says that it stands.
bool stands_on(const Mesh& mesh, const CrackPoint& point, double tolerance) {
  const int count = static_cast<int>(mesh.nodes.size());
  const auto [a, b] = point.edge;
  if (a < 0 || b < 0 || a >= count || b >= count) return false;
  bool is_edge = false;
  for (int k = mesh.element_offset[a]; k < mesh.element_offset[a + 1]; ++k)
    is_edge = is_edge || mesh.local_edge(mesh.node_elements[k], a, b) >= 0;
  const Vec2 expected = mesh.nodes[a] + point.fraction * (mesh.nodes[b] - mesh.nodes[a]);
  const Vec2 off = expected - point.position;
  return is_edge && off.dot(off) <= tolerance * tolerance;
}

}  // namespace

void check_previous(const common::Split& previous, const common::Frame& frame, const std::string& config_hash) {
  if (previous.config_hash != config_hash)
    throw common::bad_input(
        fmt::format("previous split: made with configuration {}, this one is {}; solve it again with this "
                    "configuration, or start without a previous split",
                    previous.config_hash, config_hash));
  if (previous.frame >= frame.frame)
    throw common::bad_input(
        fmt::format("previous split: belongs to frame {}, expected one before frame {}", previous.frame, frame.frame));
  for (std::int64_t id : previous.cracks.particle)
    if (!has_particle(frame, id))
      throw common::bad_input(
          fmt::format("previous split: its cracked particle {} is not in frame {}", id, frame.frame));
  for (std::int64_t id : previous.broken.parent)
    if (has_particle(frame, id))
      throw common::bad_input(fmt::format(
          "previous split: its broken particle {} is still in frame {}; the split was not applied", id, frame.frame));
}

CrackState stored_cracks(const common::Split& split) {
  CrackState state;
  const auto& stored = split.cracks;
  // Edges and tip states may be absent in a file made elsewhere: then the geometry alone counts.
  const bool on_edges = !stored.edge.empty() && !stored.edge_fraction.empty();
  for (std::size_t k = 0; k < stored.particle.size(); ++k) {
    Crack crack;
    for (std::int64_t p = stored.point_offset[k]; p < stored.point_offset[k + 1]; ++p) {
      CrackPoint point{{-1, -1}, 0, stored.points[p]};
      if (on_edges) point = {{stored.edge[p][0], stored.edge[p][1]}, stored.edge_fraction[p], stored.points[p]};
      crack.points.push_back(point);
    }
    if (!stored.tip_state.empty())
      crack.tips = {static_cast<TipState>(stored.tip_state[k][0]), static_cast<TipState>(stored.tip_state[k][1])};
    state[stored.particle[k]].push_back(std::move(crack));
  }
  return state;
}

std::optional<Crack> crack_on_mesh(const Mesh& mesh, const Crack& crack) {
  double extent = 0;
  for (const Vec2& node : mesh.nodes) extent = std::max({extent, std::abs(node.x()), std::abs(node.y())});
  const bool stands = std::all_of(crack.points.begin(), crack.points.end(),
                                  [&](const CrackPoint& point) { return stands_on(mesh, point, 1e-9 * extent); });
  if (stands && crack.points.size() >= 2) {
    // Where its edge says, to the last bit, so that it does not wander on its way through files.
    Crack same = crack;
    for (CrackPoint& point : same.points) {
      const Vec2& from = mesh.nodes[point.edge[0]];
      point.position = from + point.fraction * (mesh.nodes[point.edge[1]] - from);
    }
    return same;
  }
  std::vector<Vec2> polyline;
  for (const CrackPoint& point : crack.points) polyline.push_back(point.position);
  Crack placed = place_polyline(mesh, polyline, crack.tips);
  if (placed.points.size() < 2) return std::nullopt;
  return placed;
}

void append_cracks(common::Split& split, std::int64_t particle, const std::vector<Crack>& cracks) {
  auto& stored = split.cracks;
  for (const Crack& crack : cracks) {
    stored.particle.push_back(particle);
    for (const CrackPoint& point : crack.points) {
      stored.points.push_back(point.position);
      stored.edge.push_back({point.edge[0], point.edge[1]});
      stored.edge_fraction.push_back(point.fraction);
    }
    stored.point_offset.push_back(static_cast<std::int64_t>(stored.points.size()));
    stored.tip_state.push_back({static_cast<std::int32_t>(crack.tips[0]), static_cast<std::int32_t>(crack.tips[1])});
  }
}

std::vector<InheritedCrack> inherited_cracks(const std::vector<Crack>& cracks, const std::vector<int>& path_cracks,
                                             const std::array<Vec2, 2>& path, int side, const Vec2& fragment_centroid,
                                             double clearance) {
  const Vec2 along = path[1] - path[0];
  const double length = std::sqrt(along.dot(along));
  std::vector<InheritedCrack> inherited;
  for (std::size_t k = 0; k < cracks.size(); ++k) {
    if (std::find(path_cracks.begin(), path_cracks.end(), static_cast<int>(k)) != path_cracks.end()) continue;
    const Crack& crack = cracks[k];
    InheritedCrack own{{}, crack.tips};
    double nearest = std::numeric_limits<double>::infinity();
    for (const CrackPoint& point : crack.points) {
      nearest = std::min(nearest, side * common::cross(along, point.position - path[0]) / length);
      own.polyline.push_back(point.position - fragment_centroid);
    }
    if (nearest > clearance) inherited.push_back(std::move(own));
  }
  return inherited;
}

}  // namespace xfem
