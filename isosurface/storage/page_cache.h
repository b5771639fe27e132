#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_set>
#include <vector>

#include "core/base/stable_vector.h"
#include "isosurface/volume/page.h"

namespace adamas::isosurface {

/// A page that a PageCache has to load: its missing parts, the data that predict it, and its memory.
template <class Word>
struct PageToLoad {
  PageId id;
  PageShape shape;
  PageParts parts;  ///< the parts that are missing
  const Surroundings<Word>& around;
  /// The samples; points of coarser LODs are filled already, and all points where only bounds are missing.
  PageSamples<Word>& samples;
  PageBounds<Word>* bounds;  ///< null where they are not among the parts
};

template <class Word>
class PageCache;

/// Memory for samples and bounds of pages, which caches of one grid may share: if it is full, a page of any
/// of them leaves.
template <class Word>
struct PageMemory {
  static constexpr std::size_t kLeast = 64;
  /// Makes a memory for parts of pages of at most `bytes` bytes, but never fewer than `least_parts` of each
  /// kind.
  explicit PageMemory(std::size_t bytes, std::size_t least_parts = kLeast)
      : limit(bytes), least(least_parts) {}

  /// All parts of one kind, and those that no page uses.
  template <class Part>
  struct Pool {
    StableVector<Part> all;
    std::vector<Part*> free;
  };

  [[nodiscard]] std::size_t taken() const {
    return samples.all.size() * sizeof(PageSamples<Word>) + bounds.all.size() * sizeof(PageBounds<Word>);
  }
  /// Returns whether there is room for which no page has to leave.
  template <class Part>
  [[nodiscard]] bool has_room_in(const Pool<Part>& pool) const {
    return !pool.free.empty() || taken() + sizeof(Part) <= limit || pool.all.size() < least;
  }

  std::size_t limit, least;
  bool keeps_bounds = false;  ///< keep bounds even if a reader drops them, since others may need them
  Pool<PageSamples<Word>> samples;
  Pool<PageBounds<Word>> bounds;
  std::vector<PageCache<Word>*> caches;  ///< the caches, those used least recently first
  std::size_t turn = 0;                  ///< the index of the cache from which the next page may leave
};

/// The memory of one volume's pages: the samples of requested pages, and the bounds of those whose bounds
/// were requested. The samples of a page need those of the pages of the next coarser LOD round it, and its
/// bounds need those of the one page that covers it there; the cache gets these pages in the same way. If
/// memory is full, a page leaves that was not used since its last turn (second chance, an approximation of
/// least recently used). Derived classes load pages.
template <class Word>
class PageCache {
 public:
  using Memory = PageMemory<Word>;
  /// Makes a cache with a memory of its own: pages of at most `memory` bytes.
  PageCache(const PageGrid& grid, std::size_t memory);
  /// Makes a cache with a memory that other caches share.
  PageCache(const PageGrid& grid, std::shared_ptr<Memory> memory);
  virtual ~PageCache();
  PageCache(const PageCache&) = delete;
  PageCache& operator=(const PageCache&) = delete;

  [[nodiscard]] const PageGrid& grid() const { return grid_; }
  /// Sets the limit. Pages that are in memory stay there until others need room.
  void set_memory(std::size_t bytes) { memory_->limit = bytes; }
  [[nodiscard]] const std::shared_ptr<Memory>& memory() const { return memory_; }
  /// Notes that, among the caches that share the memory, this one was used last, or just before another one.
  void touch(const PageCache* before = nullptr);
  /// Sets whether pages that are not in memory are loaded. Otherwise they are not available, and none leaves;
  /// then several threads may request samples and bounds.
  void set_loading(bool loads) { loads_ = loads; }
  [[nodiscard]] bool loads() const { return loads_; }

  /// Returns a part of a page, or null where it or one that it is predicted from is not available. Valid
  /// until the next call.
  const PageSamples<Word>* samples(const PageId& id) {
    if (const PageSamples<Word>* found = held(id)) return found;
    const Slot* slot = loads_ ? get(id, PageParts::kSamples, true) : slot_in_memory(id);
    return slot == nullptr ? nullptr : slot->samples;
  }
  const PageBounds<Word>* bounds(const PageId& id) {
    const Slot* slot = loads_ ? get(id, PageParts::kAll, true) : slot_in_memory(id);
    return slot == nullptr ? nullptr : slot->bounds;
  }
  /// Returns the samples of a page that is in memory; null if it is not. Valid until the next call.
  const PageSamples<Word>* held(const PageId& id) {
    const Slot* const slot = slot_in_memory(id);
    return slot == nullptr || !slot->wanted ? nullptr : slot->samples;
  }
  /// A page whose samples are in memory.
  struct HeldPage {
    PageId id;
    const PageSamples<Word>* samples;
  };
  /// Returns all pages whose samples are in memory. The result is valid until a page is requested that is not
  /// in memory.
  [[nodiscard]] std::vector<HeldPage> held_pages() const;
  /// Copies pages of another cache of the same volume that are not in memory here, as far as there is room.
  void copy_samples(std::span<const HeldPage> pages);
  /// Copies all of a page. Returns false where it is not available.
  bool copy(const PageId& id, Page<Word>& page);
  /// Frees the memory of the page's bounds, which will hardly be needed again, unless the memory keeps them.
  void drop_bounds(const PageId& id);
  /// Frees the memory of all bounds.
  void drop_bounds();

  /// Returns whether parts of a page are in memory.
  bool has(const PageId& id, PageParts parts);
  /// Returns whether parts of a page are in memory. The call does not count as a use of the page.
  [[nodiscard]] bool holds(const PageId& id, PageParts parts) const {
    const std::uint32_t found = lods_[static_cast<std::size_t>(id.lod)].slots[place_in_lod(id)];
    return found != kNone && (slots_[found].bounds != nullptr || !has_part(parts, PageParts::kBounds));
  }
  /// Notes that a page, if it is in memory, is needed until forget_needs(), and its importance.
  void need(const PageId& id, int importance);
  void forget_needs() { ++needs_; }
  /// Puts a page of another cache of the same volume into memory, with its bounds if they are given. Pages
  /// that are not needed or less important leave for it. Returns false where that makes no room.
  bool put(const PageId& id, const PageSamples<Word>& samples, const PageBounds<Word>* bounds,
           int importance);
  /// Returns the number of pages that have left.
  [[nodiscard]] std::uint64_t evicted_pages() const { return evicted_; }
  /// Notes that a page can never be read.
  void note_lost(const PageId& id) { lost_.insert(grid_.number(id)); }
  [[nodiscard]] bool is_lost(const PageId& id) const {
    return !lost_.empty() && lost_.contains(grid_.number(id));
  }

  /// Fills the points of the next coarser LOD round a page, or parts of them. Returns false where some are
  /// not available. Does nothing for a complete page.
  bool surroundings(const PageId& id, Surroundings<Word>& around, PageParts parts = PageParts::kAll);

  /// Returns the number of pages that were loaded, each counted as often as it was loaded.
  /// loaded_as_predictors() returns the number of those that were loaded only to predict others.
  [[nodiscard]] std::uint64_t loaded() const { return loaded_; }
  [[nodiscard]] std::uint64_t loaded_as_predictors() const { return predictors_; }

 private:
  /// Fills the missing parts of the page's own points. Returns false where one of them is not available.
  virtual bool load(const PageToLoad<Word>& page) = 0;

  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Slot {
    PageId id;
    PageSamples<Word>* samples = nullptr;  ///< null where the slot is free
    PageBounds<Word>* bounds = nullptr;    ///< null where they are not in memory
    bool used = false;                     ///< whether it was used since the slot's last turn
    bool wanted = false;       ///< whether it was requested for its own sake, not only to predict another
    bool pinned = false;       ///< whether it cannot leave
    std::uint64_t needed = 0;  ///< value of needs_ when it was noted as needed last
    int importance = 0;        ///< its importance then
  };
  const Slot* slot_in_memory(const PageId& id) {
    const std::uint32_t found = slot_of(id);
    if (found == kNone) return nullptr;
    Slot& slot = slots_[found];
    // Other threads may store the same value.
    std::atomic_ref<bool>(slot.used).store(true, std::memory_order_relaxed);
    return &slot;
  }
  /// The slots of an LOD's pages, i running fastest, and the sizes of its rows and planes of pages.
  struct Lod {
    std::size_t row, plane;
    std::vector<std::uint32_t> slots;
  };
  [[nodiscard]] std::uint32_t& slot_of(const PageId& id) {
    return lods_[static_cast<std::size_t>(id.lod)].slots[place_in_lod(id)];
  }
  [[nodiscard]] std::size_t place_in_lod(const PageId& id) const {
    const Lod& lod = lods_[static_cast<std::size_t>(id.lod)];
    const auto at = [](std::int32_t x) { return static_cast<std::size_t>(x); };
    return at(id.block.i) + lod.row * at(id.block.j) + lod.plane * at(id.block.k);
  }
  /// Returns the slot of a page, which is loaded if need be; null where it is not available. `wanted`: it is
  /// requested for its own sake, not to predict another.
  const Slot* get(const PageId& id, PageParts parts, bool wanted);
  const Slot* fetch(const PageId& id, PageParts parts, bool wanted);
  /// Copies the points of coarser LODs into the missing parts of a page.
  static void fill_coarser(const PageToLoad<Word>& page);
  template <class Part>
  using Pool = typename Memory::template Pool<Part>;
  /// Takes memory from a pool; pages leave for it if need be.
  template <class Part>
  Part* room_in(Pool<Part>& pool);
  /// Takes memory for a part of this importance; null where no page leaves for it.
  template <class Part>
  Part* room_in(Pool<Part>& pool, int importance);
  /// Removes one page that is not needed or is less important. Returns false where there is none.
  bool evict_less_than(int importance);
  /// Removes one page of one of the caches. Returns false where none may leave.
  bool evict_in_turn();
  /// Removes one page of the caches that were used less recently than this one. Returns false where none may
  /// leave.
  bool evict_from_older();
  /// Removes one page of this cache, beginning with the slot whose turn it is. Returns false where none may
  /// leave.
  bool evict();
  void remove(Slot& slot);
  void next_turn() { turn_ = turn_ + 1 >= slots_.size() ? 0 : turn_ + 1; }
  std::uint32_t free_slot();

  PageGrid grid_;
  std::shared_ptr<Memory> memory_;
  std::vector<Lod> lods_;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_slots_;
  std::size_t turn_ = 0;  ///< the slot whose page may leave next
  std::uint64_t loaded_ = 0, predictors_ = 0;
  bool loads_ = true;
  std::uint64_t needs_ = 1, evicted_ = 0;
  std::unordered_set<std::uint64_t> lost_;  ///< numbers of pages that can never be read
};

}  // namespace adamas::isosurface
