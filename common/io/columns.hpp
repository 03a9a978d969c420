// Arrays and attributes to and from Contents, with checks whose messages name file and dataset. For frame and split.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/error.hpp"
#include "common/io/contents.hpp"
#include "common/io/frame.hpp"

namespace common {

/// Where an error is reported: the file, and the exit code (bad input on reading, numerical failure on writing).
struct Source {
  std::string file;
  ExitCode code = ExitCode::bad_input;

  /// Throws "FILE: WHAT: TEXT".
  [[noreturn]] void fail(const std::string& what, const std::string& text) const {
    throw Error(code, file + ": " + what + ": " + text);
  }
  [[noreturn]] void fail_dataset(const std::string& path, const std::string& text) const {
    fail("dataset " + path, text);
  }
};

template <class T>
void put_column(Contents& contents, const std::string& path, const std::vector<T>& values, const std::string& unit,
                const std::string& description) {
  contents[path] = array_item(std::span<const T>(values));
  contents[path + "@unit"] = text_item(unit);
  contents[path + "@description"] = text_item(description);
}

/// The values of a numeric item as Scalar: any integer type that holds them for integers, float32 or float64 for
/// floating point.
template <class Scalar>
std::vector<Scalar> scalars_as(const Item& item, const Source& source, const std::string& what) {
  const auto convert = [&]<class Stored>(Stored) {
    std::vector<Stored> stored(item.bytes.size() / sizeof(Stored));
    if (!stored.empty()) std::memcpy(stored.data(), item.bytes.data(), item.bytes.size());
    if constexpr (std::is_same_v<Stored, Scalar>) {
      return stored;
    } else {
      std::vector<Scalar> values(stored.size());
      for (std::size_t i = 0; i < stored.size(); ++i) {
        if constexpr (std::is_integral_v<Scalar> && std::is_integral_v<Stored>) {
          if (!std::in_range<Scalar>(stored[i])) {
            source.fail(what, fmt::format("entry {} is {}, which does not fit {}", i, stored[i], type_name<Scalar>()));
          }
        }
        values[i] = static_cast<Scalar>(stored[i]);
      }
      return values;
    }
  };
  if constexpr (std::is_integral_v<Scalar>) {
    if (item.type == "int64") return convert(std::int64_t{});
    if (item.type == "int32") return convert(std::int32_t{});
    if (item.type == "int16") return convert(std::int16_t{});
    if (item.type == "int8") return convert(std::int8_t{});
    if (item.type == "uint64") return convert(std::uint64_t{});
    if (item.type == "uint32") return convert(std::uint32_t{});
    if (item.type == "uint16") return convert(std::uint16_t{});
    if (item.type == "uint8") return convert(std::uint8_t{});
  } else {
    if (item.type == "float64") return convert(double{});
    if (item.type == "float32") return convert(float{});
  }
  source.fail(what, fmt::format("type is {}, expected {}", item.type, type_name<Scalar>()));
}

inline std::string shape_text(const std::vector<std::uint64_t>& shape) {
  return fmt::format("({})", fmt::join(shape, ", "));
}

/// The array `path`, which has to be there, with as many rows as it has.
template <class T>
std::vector<T> get_column(const Contents& contents, const std::string& path, const Source& source) {
  const auto found = contents.find(path);
  if (found == contents.end()) source.fail_dataset(path, "missing");
  const Item& item = found->second;
  std::vector<std::uint64_t> expected = Layout<T>::trailing();
  expected.insert(expected.begin(), item.shape.empty() ? 0 : item.shape[0]);
  if (item.shape != expected) {
    const std::string trailing = fmt::format("{}", fmt::join(Layout<T>::trailing(), ", "));
    source.fail_dataset(path, fmt::format("shape is {}, expected (n{}{})", shape_text(item.shape),
                                          trailing.empty() ? "" : ", ", trailing));
  }
  using Scalar = typename Layout<T>::Scalar;
  const std::vector<Scalar> scalars = scalars_as<Scalar>(item, source, "dataset " + path);
  std::vector<T> values(expected[0]);
  static_assert(sizeof(T) % sizeof(Scalar) == 0);
  if (!values.empty()) {
    std::memcpy(static_cast<void*>(values.data()), scalars.data(), scalars.size() * sizeof(Scalar));
  }
  return values;
}

/// Reads the root attribute `name` into `value`; if it is absent, fails or leaves `value` alone.
template <class T>
void get_attribute(const Contents& contents, const std::string& name, bool required, const Source& source, T& value) {
  const std::string what = "attribute " + name;
  const auto found = contents.find("@" + name);
  if (found == contents.end()) {
    if (required) source.fail(what, "missing");
    return;
  }
  const Item& item = found->second;
  if constexpr (std::is_same_v<T, std::string>) {
    if (item.type != "string") source.fail(what, fmt::format("type is {}, expected string", item.type));
    const std::vector<std::string> texts = texts_of(item);
    if (texts.size() != 1) source.fail(what, fmt::format("has {} values, expected 1", texts.size()));
    value = texts[0];
  } else {
    const std::vector<T> values = scalars_as<T>(item, source, what);
    if (values.size() != 1) source.fail(what, fmt::format("has {} values, expected 1", values.size()));
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(values[0])) source.fail(what, fmt::format("is {}, expected a finite number", values[0]));
    }
    value = values[0];
  }
}

inline void check_rows(const std::string& path, std::size_t found, std::size_t expected, const Source& source) {
  if (found != expected) source.fail_dataset(path, fmt::format("has {} rows, expected {}", found, expected));
}

/// Every number finite; integers always are.
template <class T>
void check_finite(const std::string& path, const std::vector<T>& values, const Source& source) {
  using Scalar = typename Layout<T>::Scalar;
  if constexpr (std::is_floating_point_v<Scalar>) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      Scalar row[sizeof(T) / sizeof(Scalar)];
      std::memcpy(row, static_cast<const void*>(&values[i]), sizeof(T));
      for (const Scalar x : row) {
        if (!std::isfinite(x)) source.fail_dataset(path, fmt::format("entry {} is {}, expected a finite number", i, x));
      }
    }
  }
}

inline void check_ascending(const std::string& path, const std::vector<std::int64_t>& ids, const Source& source) {
  for (std::size_t i = 1; i < ids.size(); ++i) {
    if (ids[i] <= ids[i - 1]) {
      source.fail_dataset(path, fmt::format("entry {} is {} after {}, expected ascending ids", i, ids[i], ids[i - 1]));
    }
  }
}

/// Ascending ids that leave room for more.
inline void check_ids(const std::string& path, const std::vector<std::int64_t>& ids, const Source& source) {
  check_ascending(path, ids, source);
  if (!ids.empty() && ids.back() >= kLargestCount) {
    source.fail_dataset(
        path, fmt::format("entry {} is {}, expected less than {}", ids.size() - 1, ids.back(), kLargestCount));
  }
}

/// Offsets into an array of `rows` rows: 0 first, each larger than the one before, `rows` last.
inline void check_offsets(const std::string& path, const std::vector<std::int64_t>& offsets, std::size_t count,
                          std::size_t rows, const Source& source) {
  check_rows(path, offsets.size(), count + 1, source);
  if (offsets[0] != 0) source.fail_dataset(path, fmt::format("entry 0 is {}, expected 0", offsets[0]));
  for (std::size_t i = 1; i < offsets.size(); ++i) {
    if (offsets[i] <= offsets[i - 1]) {
      source.fail_dataset(
          path, fmt::format("entry {} is {} after {}, expected an ascending sequence", i, offsets[i], offsets[i - 1]));
    }
  }
  if (std::cmp_not_equal(offsets.back(), rows)) {
    source.fail_dataset(path, fmt::format("ends with {}, but there are {} rows", offsets.back(), rows));
  }
}

inline bool is_among(const std::vector<std::int64_t>& ascending_ids, std::int64_t id) {
  return std::binary_search(ascending_ids.begin(), ascending_ids.end(), id);
}

/// Every entry of `named` is in `ids`, which is the ascending dataset `ids_path`.
inline void check_known(const std::string& path, const std::vector<std::int64_t>& named, const std::string& ids_path,
                        const std::vector<std::int64_t>& ids, const Source& source) {
  for (std::size_t i = 0; i < named.size(); ++i) {
    if (!is_among(ids, named[i])) {
      source.fail_dataset(path, fmt::format("entry {} names particle {}, which is not in {}", i, named[i], ids_path));
    }
  }
}

}  // namespace common
