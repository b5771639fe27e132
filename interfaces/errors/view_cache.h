#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "interfaces/errors/field_error.h"

namespace adamas::interfaces {

/// Views of cells, worked out by whichever thread needs one first and kept.
class ViewCache {
 public:
  explicit ViewCache(std::size_t cells) : views_(cells) {}
  ~ViewCache() {
    for (const auto& view : views_) delete view.load();
  }
  ViewCache(const ViewCache&) = delete;
  ViewCache& operator=(const ViewCache&) = delete;

  template <class Make>
  const CellView& get(std::size_t cell, Make&& make) {
    std::atomic<const CellView*>& slot = views_[cell];
    if (const CellView* found = slot.load(std::memory_order_acquire)) return *found;
    auto fresh = std::make_unique<const CellView>(make());
    const CellView* expected = nullptr;
    if (slot.compare_exchange_strong(expected, fresh.get())) return *fresh.release();
    return *expected;
  }

 private:
  std::vector<std::atomic<const CellView*>> views_;
};

}  // namespace adamas::interfaces
