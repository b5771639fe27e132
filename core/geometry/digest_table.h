#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace adamas {

/// Numbers by 128-bit digests whose bits are as good as random: open addressing, no removal.
class DigestTable {
 public:
  struct Digest {
    std::uint64_t low = 0, high = 0;
    bool operator==(const Digest&) const = default;
  };

  /// The number of a digest; `fresh`, which becomes its number, where it has none. The flag tells which.
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
  void clear() {
    slots_ = {};
    size_ = 0;
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
    const std::vector<Slot> old =
        std::exchange(slots_, std::vector<Slot>(slots_.empty() ? 64 : 2 * slots_.size()));
    for (const Slot& slot : old) {
      if (slot.number != kFree) slots_[place(slot.digest)] = slot;
    }
  }

  std::vector<Slot> slots_;  ///< a power of two of them
  std::size_t size_ = 0;
};

}  // namespace adamas
