// The contents of an HDF5 file as plain values, and the hash that identifies them.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace common {

static_assert(std::endian::native == std::endian::little, "files and hashes hold little-endian bytes as they are");

/// One dataset or attribute.
struct Item {
  std::string type;                  ///< int8 ... int64, uint8 ... uint64, float32, float64, string; else "other"
  std::vector<std::uint64_t> shape;  ///< empty: a scalar
  std::string
      bytes;  ///< row-major little-endian values; of strings: for each its length (uint64), then its UTF-8 bytes
  bool operator==(const Item&) const = default;
};

/// Path -> item. "particles/id" is a dataset, "particles/id@unit" an attribute of it, "@frame" one of the root.
using Contents = std::map<std::string, Item>;

/// Hex XXH3-128 over every item outside `provenance` except "@payload_hash", in the order of the paths' bytes.
/// The hashed bytes are, for each item without separators: path, one zero byte, type, one zero byte, rank (uint64),
/// each dimension (uint64), then Item::bytes. Unsigned integers are little-endian. Items of type "other" are left out.
/// pipeline/rockbreak/run/payload_hash.py does the same.
std::string payload_hash(const Contents& contents);

/// How an array element lies in a file: its scalar type and the dimensions after the first.
template <class T>
struct Layout {
  static_assert(std::is_arithmetic_v<T>);
  using Scalar = T;
  static std::vector<std::uint64_t> trailing() { return {}; }
};
template <class T>
requires std::is_enum_v<T>
struct Layout<T> : Layout<std::underlying_type_t<T>> {
};
template <>
struct Layout<Vec2> {
  using Scalar = double;
  static std::vector<std::uint64_t> trailing() { return {2}; }
};
template <class T, std::size_t K>
struct Layout<std::array<T, K>> {
  using Scalar = typename Layout<T>::Scalar;
  static std::vector<std::uint64_t> trailing() {
    std::vector<std::uint64_t> dimensions = Layout<T>::trailing();
    dimensions.insert(dimensions.begin(), K);
    return dimensions;
  }
};

/// "int64", "float64", ...: numpy's names.
template <class T>
std::string type_name() {
  const std::string bits = std::to_string(8 * sizeof(T));
  if constexpr (std::is_floating_point_v<T>) return "float" + bits;
  return (std::is_signed_v<T> ? "int" : "uint") + bits;
}

template <class T>
Item scalar_item(T value) {
  return {type_name<T>(), {}, std::string(reinterpret_cast<const char*>(&value), sizeof(T))};
}

template <class T>
Item array_item(std::span<const T> values) {
  Item item{type_name<typename Layout<T>::Scalar>(), Layout<T>::trailing(), {}};
  item.shape.insert(item.shape.begin(), values.size());
  item.bytes.assign(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  return item;
}

Item text_item(const std::string& text);
Item text_array_item(std::span<const std::string> texts);
/// The strings of an item of type "string".
std::vector<std::string> texts_of(const Item& item);

}  // namespace common
