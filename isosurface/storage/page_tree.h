#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "isosurface/storage/page.h"

namespace adamas {

/// Pages of one volume in memory, least recently used ones leaving first. A page needs those of the next
/// coarser level round it, which are got in the same way.
template <class Word>
class PageTree {
 public:
  /// Fills the page's own points; those of coarser levels are there already. Returns false where it cannot
  /// be had.
  using Loader = std::function<bool(const PageId&, const PageShape&, const Surroundings<Word>&, Page<Word>&)>;

  /// Keeps `capacity` pages at most, but never less than kLeast.
  PageTree(const PageGrid& grid, std::size_t capacity, Loader loader);
  static constexpr std::size_t kLeast = 64;

  [[nodiscard]] const PageGrid& grid() const { return grid_; }

  /// The page, or null where it or one that it is predicted from cannot be had. Valid until the next call.
  /// `wanted`: the page is asked for itself, not to predict another.
  const Page<Word>* page(const PageId& id, bool wanted = true);

  /// What is known round a page of the next coarser level. Returns false where something cannot be had. Does
  /// nothing for a complete page.
  bool surroundings(const PageId& id, Surroundings<Word>& around);

  /// Copies the points of coarser levels into a page.
  static void fill_coarser(const PageShape& shape, const Surroundings<Word>& around, Page<Word>& page);

  /// Changes whenever a page that page() gave may have gone.
  [[nodiscard]] std::uint64_t generation() const { return generation_; }
  /// Number of pages that were loaded, again where they had left; and of those that only predicted others.
  [[nodiscard]] std::uint64_t loaded() const { return loaded_; }
  [[nodiscard]] std::uint64_t loaded_as_predictors() const { return predictors_; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Slot {
    PageId id;
    std::unique_ptr<Page<Word>> page;
    std::uint32_t newer = kNone, older = kNone;
    bool wanted = false;
  };

  [[nodiscard]] std::uint32_t& slot_of(const PageId& id);
  std::uint32_t free_slot();
  void unlink(std::uint32_t slot);
  void make_newest(std::uint32_t slot);

  PageGrid grid_;
  std::size_t capacity_;
  Loader loader_;
  std::vector<std::vector<std::uint32_t>> places_;  ///< by level and block: the slot
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_;
  std::uint32_t newest_ = kNone, oldest_ = kNone;
  std::uint64_t generation_ = 0, loaded_ = 0, predictors_ = 0;
};

extern template class PageTree<std::uint8_t>;
extern template class PageTree<std::uint16_t>;
extern template class PageTree<std::uint32_t>;

}  // namespace adamas
