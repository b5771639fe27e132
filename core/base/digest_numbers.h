#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/hash.h"
#include "core/base/large_pages.h"

namespace adamas::inline core {

/// 128 bits that stand for something larger, and are as good as random.
struct Digest {
  std::uint64_t low = 0x243f6a8885a308d3, high = 0x13198a2e03707344;  ///< binary places of pi: of nothing yet
  bool operator==(const Digest&) const = default;

  /// Makes it stand for one more number, besides those before.
  void take(std::uint64_t word) {
    low = mix64(low + word + kGoldenRatio64);
    high = mix64((high ^ std::rotl(word, 32)) + 0xd1b54a32d192ed03);
  }
  void take(double number) { take(std::bit_cast<std::uint64_t>(number)); }
  void take(const Vec3& p) {
    take(p.x);
    take(p.y);
    take(p.z);
  }
};

/// A hash table from digests to numbers: with open addressing and without removal.
class DigestTable {
 public:
  /// Returns the number of a digest, and false; a digest without a number gets the number `fresh`, and true
  /// is returned with it.
  std::pair<std::uint32_t, bool> try_add(const Digest& digest, std::uint32_t fresh) {
    if (3 * (size_ + 1) > 2 * slots_.size()) grow();
    Slot& slot = slots_[place(digest)];
    const bool added = slot.number == kFree;
    if (added) {
      slot = {digest, fresh};
      ++size_;
    }
    return {slot.number, added};
  }
  /// Returns the number of a digest; none if it has none.
  [[nodiscard]] std::optional<std::uint32_t> find(const Digest& digest) const {
    if (size_ == 0) return {};
    const Slot& slot = slots_[place(digest)];
    return slot.number == kFree ? std::nullopt : std::optional(slot.number);
  }
  /// Gives a digest of the table another number.
  void set(const Digest& digest, std::uint32_t number) { slots_[place(digest)].number = number; }
  /// Calls visit(digest, number) for each digest.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (const Slot& slot : slots_) {
      if (slot.number != kFree) visit(slot.digest, slot.number);
    }
  }

 private:
  static constexpr std::uint32_t kFree = 0xffffffffu;
  struct Slot {
    Digest digest;
    std::uint32_t number = kFree;
  };

  [[nodiscard]] std::size_t place(const Digest& digest) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = digest.low & mask;
    while (slots_[at].number != kFree && slots_[at].digest != digest) at = (at + 1) & mask;
    return at;
  }
  void grow() {
    const std::vector<Slot> old = std::exchange(slots_, {});
    const std::size_t count = old.empty() ? 64 : 2 * old.size();
    reserve_in_large_pages(slots_, count);
    slots_.resize(count);
    for (const Slot& slot : old) {
      if (slot.number != kFree) slots_[place(slot.digest)] = slot;
    }
  }

  std::vector<Slot> slots_;  ///< a power of two of them
  std::size_t size_ = 0;
};

/// Numbers digests from 0 in the order in which they come first. Many are numbered at once on all threads,
/// with the same numbers as one after another.
class DigestNumbers {
 public:
  struct Added {
    std::vector<std::uint32_t> numbers;  ///< of each digest
    std::vector<std::uint32_t> firsts;   ///< the places of those that got new numbers, in their order
  };
  /// Numbers digests after those that have been numbered before; equal ones share a number. Together they may
  /// be fewer than 2^32.
  Added add(std::span<const Digest> digests);
  /// Returns the number of a digest; none if it has none.
  [[nodiscard]] std::optional<std::uint32_t> find(const Digest& digest) const {
    return tables_[part(digest)].find(digest);
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Returns the digests by their numbers.
  [[nodiscard]] std::vector<Digest> digests() const;
  void clear() { *this = {}; }

 private:
  static constexpr std::size_t kParts = 64;
  static std::size_t part(const Digest& digest) { return static_cast<std::size_t>(digest.high >> 58); }
  void add_in_order(std::span<const Digest> digests, Added& added);
  void add_in_parallel(std::span<const Digest> digests, Added& added);

  std::array<DigestTable, kParts> tables_;  ///< by part: each thread works on another one
  std::size_t size_ = 0;
};

}  // namespace adamas::inline core
