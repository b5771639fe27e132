#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/data/site_array.h"

namespace adamas::inline core {

/// The values of a field: numbers of float or of double, as its source has them.
class FieldValues {
 public:
  FieldValues() = default;
  FieldValues(SiteArray<float> values) : floats_(std::move(values)) {}
  FieldValues(SiteArray<double> values) : doubles_(std::move(values)) {}
  FieldValues(std::vector<float> values) : floats_(std::move(values)) {}
  FieldValues(std::vector<double> values) : doubles_(std::move(values)) {}

  /// Calls call(array) with the array of floats or of doubles.
  template <class Call>
  decltype(auto) visit(const Call& call) const {
    return are_doubles() ? call(doubles_) : call(floats_);
  }
  template <class Call>
  decltype(auto) visit(const Call& call) {
    return are_doubles() ? call(doubles_) : call(floats_);
  }

  [[nodiscard]] std::size_t size() const {
    return visit([](const auto& values) { return values.size(); });
  }
  [[nodiscard]] bool empty() const { return size() == 0; }
  [[nodiscard]] bool are_doubles() const { return !doubles_.empty(); }
  double operator[](std::size_t i) const {
    return visit([i](const auto& values) { return static_cast<double>(values[i]); });
  }
  /// Sets a value, which is rounded where the values are floats.
  void set(std::size_t i, double value) {
    visit([i, value](auto& values) { values[i] = static_cast<std::decay_t<decltype(values[i])>>(value); });
  }

  friend bool operator==(const FieldValues&, const FieldValues&) = default;

 private:
  SiteArray<float> floats_;  ///< one of the two arrays is empty
  SiteArray<double> doubles_;
};

}  // namespace adamas::inline core
