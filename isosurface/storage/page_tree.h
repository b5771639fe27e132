#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/arena.h"
#include "isosurface/storage/page.h"

namespace adamas {

/// Pages of one volume in memory. Those leave first that nobody asked for since they were last considered
/// (second chance, an approximation of least recently used). A page needs those of the next coarser level
/// round it, which are got in the same way.
template <class Word>
class PageTree {
 public:
  /// Fills the page's own points; those of coarser levels are there already. Returns false where it cannot
  /// be had.
  using Loader = std::function<bool(const PageId&, const PageShape&, const Surroundings<Word>&, Page<Word>&)>;

  /// Keeps `capacity` pages at most, but never less than kLeast. `parts`: what of pages is there.
  PageTree(const PageGrid& grid, PageParts parts, std::size_t capacity, Loader loader);
  static constexpr std::size_t kLeast = 64;

  [[nodiscard]] const PageGrid& grid() const { return grid_; }

  /// The page, or null where it or one that it is predicted from cannot be had. Valid until the next call.
  /// `wanted`: the page is asked for itself, not to predict another.
  const Page<Word>* page(const PageId& id, bool wanted = true);
  /// The same for a page that is in memory; null for others.
  const Page<Word>* find(const PageId& id) {
    const std::uint32_t found = slot_of(id);
    if (found == kNone || !slots_[found].wanted) return nullptr;
    slots_[found].used = true;
    return slots_[found].page;
  }

  /// What is known round a page of the next coarser level. Returns false where something cannot be had. Does
  /// nothing for a complete page.
  bool surroundings(const PageId& id, Surroundings<Word>& around);

  /// Copies the points of coarser levels into a page.
  void fill_coarser(const PageShape& shape, const Surroundings<Word>& around, Page<Word>& page) const;

  /// Number of pages that were loaded, again where they had left; and of those that only predicted others.
  [[nodiscard]] std::uint64_t loaded() const { return loaded_; }
  [[nodiscard]] std::uint64_t loaded_as_predictors() const { return predictors_; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Slot {
    PageId id;
    Page<Word>* page = nullptr;
    bool held = false, used = false, wanted = false;
  };
  /// Slots of the pages of a level, i running fastest.
  struct Level {
    std::size_t row, plane;
    std::vector<std::uint32_t> slots;
  };

  [[nodiscard]] std::uint32_t& slot_of(const PageId& id) {
    Level& level = levels_[static_cast<std::size_t>(id.level)];
    const auto at = [](std::int32_t x) { return static_cast<std::size_t>(x); };
    return level.slots[at(id.block.i) + level.row * at(id.block.j) + level.plane * at(id.block.k)];
  }
  std::uint32_t free_slot();

  PageGrid grid_;
  PageParts parts_;
  std::size_t capacity_;
  Loader loader_;
  std::vector<Level> levels_;
  Arena<Page<Word>> arena_;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_;
  std::size_t considered_ = 0;  ///< the slot whose page is the next that may leave
  std::uint64_t loaded_ = 0, predictors_ = 0;
};

extern template class PageTree<std::uint8_t>;
extern template class PageTree<std::uint16_t>;
extern template class PageTree<std::uint32_t>;

}  // namespace adamas
