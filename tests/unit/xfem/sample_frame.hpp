// A small contact state: four far-away boundary particles press on polygons of several shapes, sizes and angles.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "common/config/scene.hpp"
#include "common/io/frame.hpp"
#include "common/io/split.hpp"
#include "tests/unit/scratch_folder.hpp"

namespace sample {

using common::Polygon;
using common::Vec2;

constexpr int kWalls = 4;

inline Polygon regular(int corners, double radius, double squash = 1) {
  Polygon polygon;
  for (int k = 0; k < corners; ++k) {
    const Vec2 p = radius * (common::Rotation(6.283185307179586 * k / corners + 0.1) * Vec2{1, 0});
    polygon.push_back({p.x(), squash * p.y()});
  }
  const Vec2 c = common::centroid(polygon);
  for (Vec2& v : polygon) v -= c;
  return polygon;
}

/// Where the ray from the origin along `direction` leaves the polygon.
inline Vec2 exit_point(common::PolygonView polygon, const Vec2& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k], edge = polygon[(k + 1) % polygon.size()] - a;
    const double t = common::cross(a, edge) / common::cross(direction, edge);
    if (t > 0) nearest = std::min(nearest, t);
  }
  return nearest * direction;
}

inline void add_particle(common::Frame& frame, const Polygon& outline, const Vec2& position, double angle,
                         bool boundary) {
  common::Particles& p = frame.particles;
  const std::int64_t id = frame.next_id++;
  p.id.push_back(id);
  p.parent.push_back(-1);
  p.root.push_back(id);
  p.generation.push_back(0);
  p.type.push_back(0);
  p.position.push_back(position);
  p.velocity.push_back({0, 0});
  p.displacement.push_back({0, 0});
  p.angle.push_back(angle);
  p.angular_velocity.push_back(0);
  p.area.push_back(common::area(outline));
  p.mass.push_back(2500 * p.area.back());
  p.inertia.push_back(2500 * common::polar_moment(outline));
  p.boundary.push_back(boundary);
  p.vertices.insert(p.vertices.end(), outline.begin(), outline.end());
  p.vertex_offset.push_back(static_cast<std::int64_t>(p.vertices.size()));
}

struct Press {
  double force;     ///< [N] of the main pair
  double angle;     ///< of its direction, world [rad]
  double side = 0;  ///< force of the pair across it, as a part of the main one
};

/// Adds a particle pressed by two opposite pairs of forces along two lines through its centroid.
inline void add_pressed(common::Frame& frame, const Polygon& outline, const Vec2& position, double angle,
                        const Press& press) {
  add_particle(frame, outline, position, angle, false);
  if (press.force == 0) return;
  const common::Rotation to_world(angle);
  const Vec2 along = common::Rotation(press.angle) * Vec2{1, 0};
  const Vec2 directions[kWalls] = {along, -along, common::perpendicular(along), -common::perpendicular(along)};
  for (int wall = 0; wall < (press.side > 0 ? 4 : 2); ++wall) {
    common::Contacts& c = frame.contacts;
    const double size = wall < 2 ? press.force : press.side * press.force;
    c.a.push_back(wall);
    c.b.push_back(frame.next_id - 1);
    c.point.push_back(position + to_world * exit_point(outline, to_world.inverse(directions[wall])));
    c.normal.push_back(-directions[wall]);
    c.force.push_back(-size * directions[wall]);
    c.normal_force.push_back(size);
    c.shear_force.push_back(0);
    c.overlap_area.push_back(1e-6);
    c.overlap_width.push_back(1e-2);
  }
}

inline void sort_contacts(common::Contacts& c) {
  std::vector<std::size_t> order(c.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](auto i, auto j) { return std::pair(c.a[i], c.b[i]) < std::pair(c.a[j], c.b[j]); });
  const common::Contacts from = c;
  for (std::size_t i = 0; i < order.size(); ++i) {
    c.a[i] = from.a[order[i]];
    c.b[i] = from.b[order[i]];
    c.point[i] = from.point[order[i]];
    c.normal[i] = from.normal[order[i]];
    c.force[i] = from.force[order[i]];
    c.normal_force[i] = from.normal_force[order[i]];
  }
}

inline common::Scene scene() {
  common::Scene scene;
  scene.effects.breakage = true;
  scene.breakage.nodes = 75;
  scene.breakage.minimum_area = 0.005;
  return scene;
}

inline common::Frame walls() {
  common::Frame frame;
  frame.frame = 7;
  frame.config_hash = "made in a test";
  for (int wall = 0; wall < kWalls; ++wall) add_particle(frame, regular(6, 0.3), {10.0 * wall, -50}, 0, true);
  return frame;
}

// Ids of `frame()`.
constexpr int kUnloaded = 4, kGentle = 5, kSmall = 6, kFirstCrushed = 7, kCrushed = 12;

/// One unloaded particle, one far from failure, one too small to break, and many pressed from 1 to 4 times the force
/// that splits a disc.
inline common::Frame frame() {
  common::Frame frame = walls();
  add_pressed(frame, regular(6, 0.25), {0, 0}, 0.3, {0, 0});
  add_pressed(frame, regular(7, 0.25), {1, 0}, 1.3, {1e4, 0.2});
  add_pressed(frame, regular(5, 0.05), {2, 0}, -0.7, {1e6, 1.2});
  for (int k = 0; k < kCrushed; ++k) {
    const double force = 3.1415 * 0.25 * 6e6 * (1 + 0.25 * k);
    add_pressed(frame, regular(5 + k % 4, 0.2 + 0.01 * k, 0.8 + 0.02 * k), {3.0 + k, 0.1 * k}, 0.4 * k,
                {force, 0.37 * k, k % 3 == 2 ? 0.3 : 0});
  }
  sort_contacts(frame.contacts);
  return frame;
}

/// The same particles a frame later, broken ones replaced by their fragments, forces grown by `factor`.
inline common::Frame next_frame(const common::Frame& frame, const common::Split& split, double factor) {
  common::Frame next;
  next.frame = frame.frame + 1;
  next.next_id = frame.next_id;
  next.config_hash = frame.config_hash;
  const std::set<std::int64_t> broken(split.broken.parent.begin(), split.broken.parent.end());
  const common::Particles& p = frame.particles;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (!broken.count(p.id[i])) {
      next.next_id = p.id[i];
      const auto outline = p.outline(i);
      add_particle(next, {outline.begin(), outline.end()}, p.position[i], p.angle[i], p.boundary[i]);
    }
  for (std::size_t f = 0; f < split.fragments.id.size(); ++f) {
    common::Polygon outline(split.fragments.vertices.begin() + split.fragments.vertex_offset[f],
                            split.fragments.vertices.begin() + split.fragments.vertex_offset[f + 1]);
    const Vec2 c = common::centroid(outline);
    for (Vec2& v : outline) v -= c;
    next.next_id = split.fragments.id[f];
    add_particle(next, outline, {100.0 + static_cast<double>(f), 0}, 0, false);
  }
  for (std::size_t c = 0; c < frame.contacts.size(); ++c) {
    if (broken.count(frame.contacts.b[c])) continue;
    next.contacts.a.push_back(frame.contacts.a[c]);
    next.contacts.b.push_back(frame.contacts.b[c]);
    next.contacts.point.push_back(frame.contacts.point[c]);
    next.contacts.normal.push_back(frame.contacts.normal[c]);
    next.contacts.force.push_back(factor * frame.contacts.force[c]);
    next.contacts.normal_force.push_back(factor * frame.contacts.normal_force[c]);
    next.contacts.shear_force.push_back(0);
    next.contacts.overlap_area.push_back(frame.contacts.overlap_area[c]);
    next.contacts.overlap_width.push_back(frame.contacts.overlap_width[c]);
  }
  return next;
}

}  // namespace sample
