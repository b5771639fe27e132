#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace adamas::inline core {

/// The values of an array on the sites of a grid, as a vector: its own, or borrowed from an owner that must
/// outlive this object. Borrowed values are copied before they are changed.
template <class T>
class SiteArray {
 public:
  SiteArray() = default;
  SiteArray(std::vector<T> own) : own_(std::move(own)) {}
  explicit SiteArray(std::size_t count, T value = {}) : own_(count, value) {}
  /// Makes an array of values that another object owns.
  static SiteArray borrowed(std::span<const T> values) {
    SiteArray result;
    result.borrowed_ = values;
    return result;
  }

  [[nodiscard]] std::size_t size() const { return borrowed_.data() ? borrowed_.size() : own_.size(); }
  [[nodiscard]] bool empty() const { return size() == 0; }
  [[nodiscard]] const T* data() const { return borrowed_.data() ? borrowed_.data() : own_.data(); }
  [[nodiscard]] const T* begin() const { return data(); }
  [[nodiscard]] const T* end() const { return data() + size(); }
  const T& operator[](std::size_t i) const { return data()[i]; }

  /// The values as a vector of this object's own, for changes; borrowed values are copied first.
  std::vector<T>& own() {
    if (borrowed_.data()) own_.assign(borrowed_.begin(), borrowed_.end());
    borrowed_ = {};
    return own_;
  }
  T* data() { return own().data(); }
  T& operator[](std::size_t i) { return own()[i]; }
  T* begin() { return own().data(); }
  T* end() { return own().data() + own_.size(); }
  void resize(std::size_t count) { own().resize(count); }
  void push_back(T value) { own().push_back(value); }
  void clear() { *this = {}; }
  void reserve(std::size_t count) { own().reserve(count); }
  void assign(std::size_t count, T value) { *this = std::vector<T>(count, value); }

  friend bool operator==(const SiteArray& a, const SiteArray& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  std::vector<T> own_;
  std::span<const T> borrowed_;  ///< without data unless the values are borrowed
};

}  // namespace adamas::inline core
