// A list that keeps its first N values in itself and takes memory only when it grows longer.
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <utility>
#include <vector>

namespace xfem {

template <typename T, std::size_t N>
class ShortList {
 public:
  ShortList() = default;
  ShortList(std::initializer_list<T> values) {
    for (const T& value : values) push_back(value);
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* begin() { return size_ <= N ? own_.data() : more_.data(); }
  T* end() { return begin() + size_; }
  const T* begin() const { return size_ <= N ? own_.data() : more_.data(); }
  const T* end() const { return begin() + size_; }
  T& operator[](std::size_t i) { return begin()[i]; }
  const T& operator[](std::size_t i) const { return begin()[i]; }

  void push_back(T value) {
    if (size_ < N) {
      own_[size_] = std::move(value);
    } else {
      if (size_ == N) more_.assign(own_.begin(), own_.end());
      more_.push_back(std::move(value));
    }
    ++size_;
  }
  /// Before `place`, which may be the end; returns where the value stands.
  T* insert(T* place, T value) {
    std::size_t i = size_;
    const std::size_t at = static_cast<std::size_t>(place - begin());
    push_back(std::move(value));
    for (; i > at; --i) std::swap((*this)[i], (*this)[i - 1]);
    return begin() + at;
  }

  bool operator==(const ShortList& other) const {
    if (size_ != other.size_) return false;
    for (std::size_t i = 0; i < size_; ++i) {
      if (!((*this)[i] == other[i])) return false;
    }
    return true;
  }

 private:
  std::array<T, N> own_;
  std::vector<T> more_;  ///< all values, once there are more than N
  std::size_t size_ = 0;
};

}  // namespace xfem
