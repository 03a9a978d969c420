#include "dem/outlines.hpp"

#include <algorithm>

namespace dem {

void WorldOutlines::reset(const Particles& particles) {
  shapes_.clear();
  body_.clear();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const PolygonView outline = particles.outline(i);
    const int size = static_cast<int>(outline.size());
    const int padded = common::padded_size(size);
    shapes_.push_back(
        {static_cast<std::int32_t>(body_.size()), size, padded, common::radius_about(outline, Vec2::Zero())});
    for (int axis = 0; axis < 2; ++axis) {
      for (int k = 0; k < padded; k += 4) {
        Quad quad;
        for (int lane = 0; lane < 4; ++lane) quad.value[lane] = outline[std::min(k + lane, size - 1)][axis];
        body_.push_back(quad);
      }
    }
  }
  world_.resize(body_.size());
}

void WorldOutlines::place(const Particles& particles, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    const common::Rotation rotation(particles.angle[i]);
    const double px = particles.position[i].x();
    const double py = particles.position[i].y();
    const int quads = shapes_[i].padded / 4;
    const Quad* body = &body_[shapes_[i].first];
    Quad* world = &world_[shapes_[i].first];
    for (int q = 0; q < quads; ++q) {
      for (int lane = 0; lane < 4; ++lane) {
        const double x = body[q].value[lane];
        const double y = body[quads + q].value[lane];
        world[q].value[lane] = px + (rotation.cos * x - rotation.sin * y);
        world[quads + q].value[lane] = py + (rotation.sin * x + rotation.cos * y);
      }
    }
  }
}

}  // namespace dem
