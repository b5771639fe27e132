#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace adamas::inline core {

/// Objects that several threads take for a while and give back.
template <class T>
class SharedPool {
 public:
  /// `most`: the number of unused objects that are kept.
  explicit SharedPool(std::size_t most = std::numeric_limits<std::size_t>::max()) : most_(most) {}

  /// Takes an unused object; null where there is none.
  std::unique_ptr<T> take() {
    const std::lock_guard lock(mutex_);
    if (unused_.empty()) return nullptr;
    std::unique_ptr<T> taken = std::move(unused_.back());
    unused_.pop_back();
    return taken;
  }
  /// Gives an object back; null is ignored.
  void give(std::unique_ptr<T> object) {
    const std::lock_guard lock(mutex_);
    if (object != nullptr && unused_.size() < most_) unused_.push_back(std::move(object));
  }
  /// Calls visit(object) for each unused object.
  template <class Visit>
  void for_each(Visit&& visit) {
    const std::lock_guard lock(mutex_);
    for (const std::unique_ptr<T>& object : unused_) visit(*object);
  }

 private:
  const std::size_t most_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> unused_;
};

}  // namespace adamas::inline core
