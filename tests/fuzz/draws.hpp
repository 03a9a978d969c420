// Numbers and shapes drawn from the bytes of an input, one after another: near inputs give near structures, which is
// what lets a fuzzer climb. After the last byte every draw is the one of a zero byte.
// Two draws in one expression stand in braces: arguments in parentheses are evaluated in any order, and an input must
// mean the same with every compiler.
#pragma once

#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "common/geometry/polygon.hpp"
#include "tests/fuzz/targets.hpp"

namespace fuzz {

class Draws {
 public:
  explicit Draws(Input bytes) : bytes_(bytes) {}

  bool empty() const { return next_ >= bytes_.size(); }
  Input rest() const { return bytes_.subspan(std::min(next_, bytes_.size())); }

  std::uint8_t byte() { return empty() ? 0 : bytes_[next_++]; }
  template <class T>
  T bits() {
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) value = static_cast<T>(value | T{byte()} << (8 * i));
    return value;
  }

  /// In [low, high], from one byte; high - low <= 255.
  int integer(int low, int high) { return low + byte() % (high - low + 1); }
  bool flag() { return byte() & 1; }
  /// One in `n` of all bytes; false for a zero byte, hence at the end.
  bool one_in(int n) { return byte() % n == n - 1; }

  /// In [0, 1], both ends reached.
  double unit() { return bits<std::uint16_t>() / 65535.0; }
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  /// +-2^e with a mantissa of 8 bits, e in [low, high].
  double magnitude(int low, int high) {
    const std::uint8_t mantissa = byte();
    const double size = std::ldexp(1 + (mantissa >> 1) / 128.0, integer(low, high));
    return mantissa & 1 ? -size : size;
  }
  /// Usually an ordinary number, now and then zero, a tiny, a huge one, or any eight bytes.
  double number(double size) {
    switch (integer(0, 15)) {
      case 12:
        return 0;
      case 13:
        return magnitude(-128, 127) * size;
      case 14: {
        const double mantissa = magnitude(0, 3);
        return std::ldexp(mantissa, 8 * integer(-134, 127));
      }
      case 15:
        return std::bit_cast<double>(bits<std::uint64_t>());
      default:
        return uniform(-size, size);
    }
  }

  /// A convex polygon: 3 to `most` corners on an ellipse of unit half length, turned, sometimes with a corner moved.
  /// Not always an outline (rounding, corners that coincide): see common::outline_defect.
  common::Polygon polygon(int most) {
    const int corners = integer(3, most);
    const double aspect = one_in(8) ? std::ldexp(1, -integer(0, 10)) : uniform(0.2, 1);
    const common::Rotation turn(uniform(0, 6.283185307179586));
    std::vector<double> angles;
    double at = 0;
    for (int k = 0; k < corners; ++k)
      angles.push_back(at += one_in(16) ? std::ldexp(1, -integer(4, 30)) : 1 + 3 * unit());
    const double scale = 6.283185307179586 / (at + 1 + 3 * unit());
    common::Polygon polygon;
    for (const double angle : angles) {
      const common::Rotation on_circle(scale * angle);
      polygon.push_back(turn * common::Vec2(on_circle.cos, aspect * on_circle.sin));
    }
    if (one_in(8)) polygon[byte() % polygon.size()] += common::Vec2{magnitude(-54, -4), magnitude(-54, -4)};
    return polygon;
  }

 private:
  Input bytes_;
  std::size_t next_ = 0;
};

}  // namespace fuzz
