#include "tests/robustness/geometry/families.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/robustness/geometry/draw.hpp"

namespace differential {
namespace {

using common::Vec2;

Vec2 vertex(const Outline& outline, int i) {
  return {outline.x[i], outline.y[i]};
}
Vec2 on_edge(const Outline& outline, int i, double t) {
  return vertex(outline, i) + t * (vertex(outline, outline.next(i)) - vertex(outline, i));
}
int any_vertex(Draw& draw, const Outline& outline) {
  return draw.integer(0, outline.size - 1);
}

void shift(Outline& outline, const Vec2& by) {
  for (int i = 0; i < outline.size; ++i) {
    outline.x[i] += by.x();
    outline.y[i] += by.y();
  }
}
void turn(Outline& outline, double cosine, double sine) {
  for (int i = 0; i < outline.size; ++i) {
    const Vec2 p = vertex(outline, i);
    outline.x[i] = cosine * p.x() - sine * p.y();
    outline.y[i] = sine * p.x() + cosine * p.y();
  }
}
void scale(Outline& outline, double factor) {
  for (int i = 0; i < outline.size; ++i) {
    outline.x[i] *= factor;
    outline.y[i] *= factor;
  }
}

/// `corners` corners on an ellipse about the origin with half axes `radius` and `radius / aspect`, turned at random.
Outline shape(Draw& draw, int corners, double radius, double aspect = 1) {
  Outline outline;
  for (int i = 0; i < corners; ++i) {
    const common::SinCos at = common::sin_cos(2 * std::numbers::pi * (i + draw.uniform(-0.35, 0.35)) / corners);
    outline.add(radius * at.cos, radius / aspect * at.sin);
  }
  const Vec2 direction = draw.direction();
  turn(outline, direction.x(), direction.y());
  return outline;
}
Outline shape(Draw& draw) {
  return shape(draw, draw.integer(3, 8), draw.uniform(0.15, 0.3));
}

/// Moves b along the outward normal of an edge of a until it penetrates that edge by `depth`; `along` shifts it along
/// the edge, 0 putting a vertex or edge opposite the middle.
void press(const Outline& a, int edge, Outline& b, double depth, double along) {
  const Vec2 p = vertex(a, edge);
  const Vec2 tangent = (vertex(a, a.next(edge)) - p).normalized();
  const Vec2 outward = -common::perpendicular(tangent);
  double lowest = outward.dot(vertex(b, 0) - p);
  Vec2 touching = vertex(b, 0);
  for (int i = 1; i < b.size; ++i) {
    const double height = outward.dot(vertex(b, i) - p);
    if (height < lowest) {
      lowest = height;
      touching = vertex(b, i);
    }
  }
  const double offset = tangent.dot(on_edge(a, edge, 0.5) - touching) + along;
  shift(b, (-lowest - depth) * outward + offset * tangent);
}

/// Turns b so that its first edge runs against an edge of a, off by `angle`.
void turn_against(const Outline& a, int edge, Outline& b, double angle) {
  const Vec2 t = (vertex(a, a.next(edge)) - vertex(a, edge)).normalized();
  const Vec2 s = (vertex(b, 1) - vertex(b, 0)).normalized();
  turn(b, -t.dot(s), -common::cross(s, t));
  for (int i = 0; i < b.size; ++i) {
    const Vec2 p = vertex(b, i);
    b.x[i] -= angle * p.y();
    b.y[i] += angle * p.x();
  }
}

/// Zero, or of any sign and order between 2^low and 2^high.
double zero_or(Draw& draw, int low, int high) {
  return draw.one_in(4) ? 0.0 : draw.sign() * draw.magnitude(low, high);
}

void random(Draw& draw, OutlinePair& pair) {
  pair.a = shape(draw);
  pair.b = shape(draw);
  shift(pair.b, draw.uniform(0, 0.55) * draw.direction());
}

void barely_touching(Draw& draw, OutlinePair& pair) {
  pair.a = shape(draw);
  pair.b = shape(draw);
  press(pair.a, any_vertex(draw, pair.a), pair.b, draw.magnitude(-58, -7), draw.uniform(-0.2, 0.2));
}

void rounding_gap(Draw& draw, OutlinePair& pair) {
  pair.a = shape(draw);
  pair.b = shape(draw);
  const int edge = any_vertex(draw, pair.a);
  if (draw.one_in(2)) turn_against(pair.a, edge, pair.b, 0);
  press(pair.a, edge, pair.b, draw.integer(-8, 8) * 0x1p-55, draw.uniform(-0.2, 0.2));
}

void parallel_edges(Draw& draw, OutlinePair& pair) {
  pair.a = shape(draw);
  pair.b = shape(draw);
  const int edge = any_vertex(draw, pair.a);
  turn_against(pair.a, edge, pair.b, zero_or(draw, -54, -9));
  press(pair.a, edge, pair.b, zero_or(draw, -58, -7), draw.uniform(-0.35, 0.35));
}

void vertex_on_vertex(Draw& draw, OutlinePair& pair) {
  pair.a = shape(draw);
  pair.b = shape(draw);
  shift(pair.b, vertex(pair.a, any_vertex(draw, pair.a)) - vertex(pair.b, any_vertex(draw, pair.b)) +
                    zero_or(draw, -58, -20) * draw.direction());
}

void vertex_on_edge(Draw& draw, OutlinePair& pair) {
  pair.a = shape(draw);
  pair.b = shape(draw);
  const Vec2 target = on_edge(pair.a, any_vertex(draw, pair.a), draw.uniform());
  shift(pair.b, target - vertex(pair.b, any_vertex(draw, pair.b)) + zero_or(draw, -58, -40) * draw.direction());
}

/// Two fragments of one particle, or two shapes on one edge, from either side or from the same one.
void shared_edge(Draw& draw, OutlinePair& pair) {
  if (draw.one_in(2)) {
    const Outline whole = shape(draw, draw.integer(4, 12), draw.uniform(0.15, 0.3));
    const int start = any_vertex(draw, whole);
    const int count = draw.integer(2, whole.size - 2);  // edges of the first piece
    const auto piece = [&whole](int first, int edges) {
      Outline outline;
      for (int k = 0; k <= edges; ++k) {
        const int i = (first + k) % whole.size;
        outline.add(whole.x[i], whole.y[i]);
      }
      return outline;
    };
    pair.a = piece(start, count);
    pair.b = piece(start + count, whole.size - count);
  } else {
    pair.a = shape(draw);
    const int edge = any_vertex(draw, pair.a);
    const int end = pair.a.next(edge);
    const Vec2 p = vertex(pair.a, edge);
    const Vec2 inward = common::perpendicular((vertex(pair.a, end) - p).normalized());
    const double factor = draw.sign() * (draw.one_in(3) ? 1.0 : draw.uniform(0.1, 2));
    pair.b.size = 0;
    for (int k = 0; k < pair.a.size; ++k) {
      const int i = factor > 0 ? k : pair.a.size - 1 - k;
      const Vec2 v = vertex(pair.a, i);
      const Vec2 moved = i == edge || i == end ? v : Vec2(v + (factor - 1) * inward.dot(v - p) * inward);
      pair.b.add(moved.x(), moved.y());
    }
  }
  if (draw.one_in(2)) shift(pair.b, draw.magnitude(-58, -7) * draw.direction());
}

void inclusion(Draw& draw, OutlinePair& pair) {
  pair.a = shape(draw, draw.integer(3, 8), 0.4);
  switch (draw.integer(0, 3)) {
    case 0:  // well inside
      pair.b = shape(draw, draw.integer(3, 8), draw.uniform(0.01, 0.1));
      shift(pair.b, draw.uniform(0, 0.1) * draw.direction());
      break;
    case 1: {  // a smaller copy in a corner
      pair.b = pair.a;
      const Vec2 corner = vertex(pair.a, any_vertex(draw, pair.a));
      shift(pair.b, -corner);
      scale(pair.b, draw.one_in(3) ? 0.5 : draw.uniform(0.05, 0.99));
      shift(pair.b, corner);
      break;
    }
    case 2: {  // corners on the edges
      pair.b.size = 0;
      for (int i = 0; i < pair.a.size; ++i) {
        const Vec2 p = on_edge(pair.a, i, draw.one_in(4) ? 0.5 : draw.uniform(0.05, 0.95));
        pair.b.add(p.x(), p.y());
      }
      break;
    }
    default: {  // some of the corners
      pair.b.size = 0;
      const int first = any_vertex(draw, pair.a);
      for (int k = 0; k < pair.a.size; ++k) {
        const int i = (first + k) % pair.a.size;
        const bool needed = pair.b.size + pair.a.size - k <= 3;
        if (needed || draw.one_in(2)) pair.b.add(pair.a.x[i], pair.a.y[i]);
      }
    }
  }
  if (draw.one_in(3)) shift(pair.b, draw.magnitude(-58, -7) * draw.direction());
}

void copies(Draw& draw, OutlinePair& pair) {
  pair.a = shape(draw);
  pair.b.size = 0;
  const int first = any_vertex(draw, pair.a);
  for (int k = 0; k < pair.a.size; ++k) {
    const int i = (first + k) % pair.a.size;
    pair.b.add(pair.a.x[i], pair.a.y[i]);
  }
  if (draw.one_in(3)) return;
  if (draw.one_in(2)) turn(pair.b, 1, zero_or(draw, -58, -7));
  shift(pair.b, zero_or(draw, -58, -7) * draw.direction());
}

void many_crossings(Draw& draw, OutlinePair& pair) {
  if (draw.one_in(2)) {
    pair.a = shape(draw, draw.integer(3, 8), 0.4, draw.uniform(3, 10));
    pair.b = shape(draw, draw.integer(3, 8), 0.4, draw.uniform(3, 10));
    shift(pair.b, draw.uniform(0, 0.1) * draw.direction());
    return;
  }
  const int corners = draw.integer(3, 32);
  pair.a = shape(draw, corners, 0.3);
  pair.b = pair.a;
  const common::SinCos half = common::sin_cos(std::numbers::pi * draw.uniform(0.2, 1) / corners);
  turn(pair.b, half.cos, half.sin);
  shift(pair.b, draw.magnitude(-40, -7) * draw.direction());
}

/// Needles and splinters, tip to tip, crossing, or against a block.
void slivers(Draw& draw, OutlinePair& pair) {
  pair.a = shape(draw, draw.integer(3, 8), 0.25, draw.uniform(20, 50));
  const int edge = any_vertex(draw, pair.a);
  switch (draw.integer(0, 2)) {
    case 0:
      pair.b = shape(draw, draw.integer(3, 8), draw.uniform(0.05, 0.25), draw.uniform(20, 50));
      shift(pair.b, draw.uniform(0, 0.3) * draw.direction());
      break;
    case 1:
      pair.b = shape(draw, draw.integer(3, 8), draw.uniform(0.05, 0.25), draw.uniform(20, 50));
      turn_against(pair.a, edge, pair.b, zero_or(draw, -54, -7));
      press(pair.a, edge, pair.b, zero_or(draw, -50, -8), draw.uniform(-0.2, 0.2));
      break;
    default:
      pair.b = shape(draw);
      press(pair.a, edge, pair.b, draw.magnitude(-50, -7), draw.uniform(-0.1, 0.1));
  }
}

void unequal_sizes(Draw& draw, OutlinePair& pair) {
  pair.a = shape(draw, draw.integer(3, 8), 0.45);
  pair.b = shape(draw, draw.integer(3, 8), 0.45 / draw.uniform(50, 100));
  const int edge = any_vertex(draw, pair.a);
  if (draw.one_in(3)) turn_against(pair.a, edge, pair.b, zero_or(draw, -54, -9));
  press(pair.a, edge, pair.b, draw.magnitude(-50, -7), draw.uniform(-0.3, 0.3));
}

void many_corners(Draw& draw, OutlinePair& pair) {
  pair.a = shape(draw, draw.integer(9, common::kMaxParticleVertices), 0.3);
  pair.b = shape(draw, draw.integer(9, common::kMaxParticleVertices), draw.uniform(0.05, 0.3));
  if (draw.one_in(3)) {
    shift(pair.b, draw.uniform(0, 0.6) * draw.direction());
  } else {
    const int edge = any_vertex(draw, pair.a);
    if (draw.one_in(2)) turn_against(pair.a, edge, pair.b, zero_or(draw, -54, -9));
    press(pair.a, edge, pair.b, zero_or(draw, -58, -7), draw.uniform(-0.02, 0.02));
  }
}

/// Corners of 180 degrees to rounding, on an edge that touches.
void flat_corners(Draw& draw, OutlinePair& pair) {
  const auto with_flat_corners = [&draw](const Outline& outline) {
    Outline result;
    for (int i = 0; i < outline.size; ++i) {
      result.add(outline.x[i], outline.y[i]);
      if (i > 0 && draw.one_in(2)) continue;
      const Vec2 p = on_edge(outline, i, draw.one_in(4) ? 0.5 : draw.uniform(0.1, 0.9));
      result.add(p.x(), p.y());
    }
    return result;
  };
  pair.a = with_flat_corners(shape(draw));
  pair.b = with_flat_corners(shape(draw));
  const int edge = any_vertex(draw, pair.a);
  turn_against(pair.a, edge, pair.b, zero_or(draw, -54, -9));
  press(pair.a, edge, pair.b, zero_or(draw, -58, -7), draw.uniform(-0.35, 0.35));
}

/// b's corner, or a place on its edge, on a's, to within a few last digits or deeper.
void bring_together(Draw& draw, const Outline& a, Outline& b) {
  const int i = any_vertex(draw, a), j = any_vertex(draw, b);
  const Vec2 target = draw.one_in(2) ? vertex(a, i) : on_edge(a, i, draw.uniform());
  shift(b, target - (draw.one_in(2) ? vertex(b, j) : on_edge(b, j, draw.uniform())));
  shift(b, zero_or(draw, -58, -7) * draw.direction());
}

/// Edges of 1e-3 to 1e-9 of the size at corners, going on nearly straight from a long edge: where the line along them
/// passes the far end of that edge is rounding over their length.
void short_edges(Draw& draw, OutlinePair& pair) {
  const auto with_short_edges = [&draw](const Outline& outline) {
    Outline result;
    for (int i = 0; i < outline.size; ++i) {
      const Vec2 p = vertex(outline, i);
      const Vec2 before = on_edge(outline, outline.previous(i), 1 - draw.magnitude(-30, -10));
      const Vec2 after = on_edge(outline, i, draw.magnitude(-30, -10));
      const int kind = draw.integer(0, 3);  // none, on one of the two edges, or on both without the corner
      if (kind == 1 || kind == 3) result.add(before.x(), before.y());
      if (kind != 3) result.add(p.x(), p.y());
      if (kind == 2 || kind == 3) result.add(after.x(), after.y());
    }
    return result;
  };
  pair.a = with_short_edges(shape(draw));
  pair.b = draw.one_in(2) ? shape(draw) : with_short_edges(shape(draw));
  if (draw.one_in(4)) scale(pair.b, 0.3);
  bring_together(draw, pair.a, pair.b);
}

/// Corners of 1e-1 to 1e-5 rad that touch something.
void needles(Draw& draw, OutlinePair& pair) {
  pair.a = shape(draw, draw.integer(3, 8), 0.25, std::ldexp(1, draw.integer(4, 17)));
  pair.b = draw.one_in(2) ? shape(draw) : shape(draw, draw.integer(3, 8), 0.25, std::ldexp(1, draw.integer(4, 17)));
  bring_together(draw, pair.a, pair.b);
}

/// Boxes, triangles, diamonds and octagons on a coarse lattice: coinciding vertices and collinear edges of every kind.
void lattice(Draw& draw, OutlinePair& pair) {
  const auto one = [&draw] {
    const double x = draw.integer(-3, 1) / 16.0;
    const double y = draw.integer(-3, 1) / 16.0;
    const double w = draw.integer(1, 4) / 16.0;
    const double h = draw.integer(1, 4) / 16.0;
    Outline o;
    switch (draw.integer(0, 3)) {
      case 0:
        o.add(x, y), o.add(x + w, y), o.add(x, y + h);
        break;
      case 1:
        o.add(x, y), o.add(x + w, y + h), o.add(x, y + 2 * h), o.add(x - w, y + h);
        break;
      case 2:
        o.add(x, y), o.add(x + w, y), o.add(x + w + h, y + h), o.add(x + w + h, y + h + w);
        o.add(x + w, y + 2 * h + w), o.add(x, y + 2 * h + w), o.add(x - h, y + h + w), o.add(x - h, y + h);
        break;
      default:
        o.add(x, y), o.add(x + w, y), o.add(x + w, y + h), o.add(x, y + h);
    }
    return o;
  };
  pair.a = one();
  pair.b = one();
  if (draw.one_in(4)) {
    const Vec2 direction = draw.direction();
    turn(pair.a, direction.x(), direction.y());
    turn(pair.b, direction.x(), direction.y());
  }
}

constexpr Family kFamilies[] = {
    {"random", random},
    {"barely_touching", barely_touching},
    {"rounding_gap", rounding_gap},
    {"parallel_edges", parallel_edges},
    {"vertex_on_vertex", vertex_on_vertex},
    {"vertex_on_edge", vertex_on_edge},
    {"shared_edge", shared_edge},
    {"inclusion", inclusion},
    {"copies", copies},
    {"many_crossings", many_crossings},
    {"slivers", slivers},
    {"unequal_sizes", unequal_sizes},
    {"many_corners", many_corners},
    {"flat_corners", flat_corners},
    {"short_edges", short_edges},
    {"needles", needles},
    {"lattice", lattice},
};

}  // namespace

std::span<const Family> families() {
  return kFamilies;
}

void make_pair(const Family& family, std::uint64_t seed, OutlinePair& pair) {
  Draw draw(seed);
  family.make(draw, pair);
  if (draw.one_in(2)) std::swap(pair.a, pair.b);
  if (draw.one_in(8)) {
    const double factor = std::ldexp(1.0, draw.integer(-20, 20));
    scale(pair.a, factor);
    scale(pair.b, factor);
  }
  pair.a.pad();
  pair.b.pad();
}

}  // namespace differential
