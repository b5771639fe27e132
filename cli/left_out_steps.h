#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "cli/console.h"

namespace adamas {

/// The steps of a series that a run goes on without, since what there is of them is damaged.
class LeftOutSteps {
 public:
  /// Calls `work`, which reads a step, and returns whether it could; what it says otherwise is kept. Throws
  /// Cancelled, and what is no Error.
  bool read(std::size_t step, const std::function<void()>& work);
  [[nodiscard]] bool contains(std::size_t step) const { return problems_.contains(step); }
  [[nodiscard]] std::vector<std::size_t> numbers() const;
  /// Throws Error, with what the first one says, where no other step of so many is left.
  void check(std::size_t steps) const;
  /// A note for each.
  void note(Console& console) const;

 private:
  std::map<std::size_t, std::string> problems_;
};

}  // namespace adamas
