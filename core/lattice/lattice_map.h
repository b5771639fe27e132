#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/assert.h"
#include "core/lattice/lattice_point.h"

namespace adamas {

/// A hash table from lattice points to small values: open addressing, linear probing, and deletion that moves
/// later entries back, so that it never fills with tombstones. Pointers into it are valid until the next
/// change.
template <class Value>
class LatticeMap {
 public:
  LatticeMap() : entries_(kMinCapacity, kEmpty) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t bytes() const { return entries_.capacity() * sizeof(Entry); }

  /// The value at p, or null.
  [[nodiscard]] const Value* find(LatticePoint p) const {
    for (std::size_t slot = home(p);; slot = next(slot)) {
      const Entry& entry = entries_[slot];
      if (entry.key == p) return &entry.value;
      if (entry.key == kEmpty.key) return nullptr;
    }
  }

  /// Fetches the memory that a later find(p) or insert(p) will look at.
  void prefetch(LatticePoint p) const { __builtin_prefetch(&entries_[home(p)]); }

  /// The value at p, and whether it was put there by this call, being a default value then.
  std::pair<Value*, bool> insert(LatticePoint p) {
    ADAMAS_ASSERT(p != kEmpty.key);
    std::size_t slot = home(p);
    for (;; slot = next(slot)) {
      Entry& entry = entries_[slot];
      if (entry.key == p) return {&entry.value, false};
      if (entry.key == kEmpty.key) break;
    }
    if (5 * (size_ + 1) > 3 * entries_.size()) {
      grow();
      slot = free_slot(p);
    }
    ++size_;
    entries_[slot].key = p;
    return {&entries_[slot].value, true};
  }

  /// Removes the entry at p; returns whether there was one.
  bool erase(LatticePoint p) {
    std::size_t hole = home(p);
    for (; entries_[hole].key != p; hole = next(hole)) {
      if (entries_[hole].key == kEmpty.key) return false;
    }
    for (std::size_t slot = next(hole); entries_[slot].key != kEmpty.key; slot = next(slot)) {
      // An entry may move back into the hole unless its home lies after the hole.
      const std::size_t from_home = (slot - home(entries_[slot].key)) & mask();
      if (from_home >= ((slot - hole) & mask())) {
        entries_[hole] = entries_[slot];
        hole = slot;
      }
    }
    entries_[hole] = kEmpty;
    --size_;
    return true;
  }

  /// Calls fn(point, value) for all entries, in an order that depends on the table's history.
  template <class Fn>
  void for_each(Fn&& fn) const {
    for (const Entry& entry : entries_) {
      if (entry.key != kEmpty.key) fn(entry.key, entry.value);
    }
  }

 private:
  struct Entry {
    LatticePoint key;
    Value value;
  };
  static constexpr std::size_t kMinCapacity = 64;
  static constexpr Entry kEmpty{{std::numeric_limits<std::int32_t>::min(), 0, 0}, Value{}};

  [[nodiscard]] std::size_t mask() const { return entries_.size() - 1; }
  [[nodiscard]] std::size_t next(std::size_t slot) const { return (slot + 1) & mask(); }
  [[nodiscard]] std::size_t home(LatticePoint p) const {
    return static_cast<std::size_t>(hash_value(p) >> shift_);
  }
  [[nodiscard]] std::size_t free_slot(LatticePoint p) const {
    std::size_t slot = home(p);
    while (entries_[slot].key != kEmpty.key) slot = next(slot);
    return slot;
  }
  void grow() {
    std::vector<Entry> old(2 * entries_.size(), kEmpty);
    old.swap(entries_);
    --shift_;
    for (const Entry& entry : old) {
      if (entry.key != kEmpty.key) entries_[free_slot(entry.key)] = entry;
    }
  }

  std::vector<Entry> entries_;
  std::size_t size_ = 0;
  int shift_ = 64 - 6;  ///< capacity is 2^(64 - shift_)
};

}  // namespace adamas
