#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/assert.h"
#include "core/lattice/lattice_point.h"

namespace adamas::inline core {

/// A key that is no point of a lattice, by which tables mark free entries.
template <class Key>
inline constexpr Key kNoKey = {};
template <>
inline constexpr LatticePoint kNoKey<LatticePoint>{std::numeric_limits<std::int32_t>::min(), 0, 0};

/// A hash table from lattice points, in one form or another, to small values: open addressing, linear
/// probing, and deletion that moves later entries back, so that it never fills with tombstones. Pointers into
/// it are valid until the next change. A key has a `hash_value` whose high bits are good, and a kNoKey. A
/// compact table grows by half where 70% of its entries are used; others double at 60%, which makes
/// insertions a tenth faster.
template <class Value, class Key = LatticePoint, bool kCompact = false>
class LatticeMap {
 public:
  LatticeMap() : entries_(kMinCapacity, kEmpty) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t bytes() const { return entries_.capacity() * sizeof(Entry); }

  /// Makes room for `size` entries.
  void reserve(std::size_t size) {
    const std::size_t capacity = 10 * size / (kCompact ? 7 : 6) + 1;
    if (capacity > entries_.size()) grow(capacity);
  }

  /// Removes all entries. Their memory stays.
  void clear() {
    if (size_ > 0) entries_.assign(entries_.size(), kEmpty);
    size_ = 0;
  }

  /// The value at p, or null.
  [[nodiscard]] Value* find(Key p) { return const_cast<Value*>(std::as_const(*this).find(p)); }
  [[nodiscard]] const Value* find(Key p) const {
    for (std::size_t slot = home(p);; slot = next(slot)) {
      const Entry& entry = entries_[slot];
      if (entry.key == p) return &entry.value;
      if (entry.key == kEmpty.key) return nullptr;
    }
  }

  /// Fetches the memory that a later find(p) or insert(p) will look at.
  void prefetch(Key p) const { __builtin_prefetch(&entries_[home(p)]); }

  /// The value at p, and whether this call has put it there, as a default value.
  std::pair<Value*, bool> insert(Key p) {
    ADAMAS_ASSERT(p != kEmpty.key);
    std::size_t slot = home(p);
    for (;; slot = next(slot)) {
      Entry& entry = entries_[slot];
      if (entry.key == p) return {&entry.value, false};
      if (entry.key == kEmpty.key) break;
    }
    if (10 * (size_ + 1) > (kCompact ? 7 : 6) * entries_.size()) {
      grow(entries_.size() + entries_.size() / (kCompact ? 2 : 1));
      slot = free_slot(p);
    }
    ++size_;
    entries_[slot].key = p;
    return {&entries_[slot].value, true};
  }

  /// Removes the entry at p; returns whether there was one.
  bool erase(Key p) {
    std::size_t hole = home(p);
    for (; entries_[hole].key != p; hole = next(hole)) {
      if (entries_[hole].key == kEmpty.key) return false;
    }
    for (std::size_t slot = next(hole); entries_[slot].key != kEmpty.key; slot = next(slot)) {
      // An entry may move back into the hole unless its home lies after the hole.
      if (way(home(entries_[slot].key), slot) >= way(hole, slot)) {
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
    Key key;
    Value value;
  };
  static constexpr std::size_t kMinCapacity = 64;
  static constexpr Entry kEmpty{kNoKey<Key>, Value{}};

  [[nodiscard]] std::size_t next(std::size_t slot) const {
    return slot + 1 == entries_.size() ? 0 : slot + 1;
  }
  /// The number of calls of next() from one place to another.
  [[nodiscard]] std::size_t way(std::size_t from, std::size_t to) const {
    return to >= from ? to - from : to + entries_.size() - from;
  }
  /// The hash as a fraction of 2^64, times the number of entries.
  [[nodiscard]] std::size_t home(Key p) const {
    __extension__ using Wide = unsigned __int128;
    return static_cast<std::size_t>(Wide{hash_value(p)} * entries_.size() >> 64);
  }
  [[nodiscard]] std::size_t free_slot(Key p) const {
    std::size_t slot = home(p);
    while (entries_[slot].key != kEmpty.key) slot = next(slot);
    return slot;
  }
  void grow(std::size_t capacity) {
    std::vector<Entry> old(capacity, kEmpty);
    old.swap(entries_);
    for (const Entry& entry : old) {
      if (entry.key != kEmpty.key) entries_[free_slot(entry.key)] = entry;
    }
  }

  std::vector<Entry> entries_;
  std::size_t size_ = 0;
};

}  // namespace adamas::inline core
