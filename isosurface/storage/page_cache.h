#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/stable_vector.h"
#include "isosurface/volume/page.h"

namespace adamas {

/// Pages of one volume in memory: the samples of those that were asked for, and the values of those of which
/// values were. Those leave first that nobody asked for since they were last considered (second chance, an
/// approximation of least recently used). Samples of a page need those of the pages of the next coarser LOD
/// round it, values those of the one that has its place, which are got in the same way.
template <class Word>
class PageCache {
 public:
  /// Fills parts of the page's own points; those of coarser LODs are there already, and the samples too
  /// where values are all that is wanted. `values` is null where they are not. Returns false where a part
  /// cannot be had.
  using Loader = std::function<bool(const PageId&, const PageShape&, const Surroundings<Word>&,
                                    PageParts parts, PageSamples<Word>& samples, PageBounds<Word>* values)>;

  /// Keeps pages of so many bytes at most, but never less than kLeast.
  PageCache(const PageGrid& grid, std::size_t memory, Loader loader);
  static constexpr std::size_t kLeast = 64;

  [[nodiscard]] const PageGrid& grid() const { return grid_; }

  /// A part of a page, or null where it or one that it is predicted from cannot be had. Valid until the next
  /// call.
  const PageSamples<Word>* samples(const PageId& id) {
    if (const PageSamples<Word>* found = find(id)) return found;
    const Slot* slot = get(id, PageParts::kSamples, true);
    return slot == nullptr ? nullptr : slot->samples;
  }
  const PageBounds<Word>* values(const PageId& id) {
    const Slot* slot = get(id, PageParts::kAll, true);
    return slot == nullptr ? nullptr : slot->values;
  }
  /// The samples of a page that is in memory; null for others. Valid until the next call.
  const PageSamples<Word>* find(const PageId& id) {
    const std::uint32_t found = slot_of(id);
    if (found == kNone || !slots_[found].wanted) return nullptr;
    slots_[found].used = true;
    return slots_[found].samples;
  }
  /// All of a page. Returns false where it cannot be had.
  bool copy(const PageId& id, Page<Word>& page);
  /// The values of the page will hardly be asked for again.
  void drop_bounds(const PageId& id);
  /// The same of all pages: their memory is free for others.
  void drop_bounds();

  /// What is known round a page of the next coarser LOD, or parts of it. Returns false where something
  /// cannot be had. Does nothing for a complete page.
  bool surroundings(const PageId& id, Surroundings<Word>& around, PageParts parts = PageParts::kAll);

  /// Number of pages that were loaded, again where they had left; and of those that only predicted others.
  [[nodiscard]] std::uint64_t loaded() const { return loaded_; }
  [[nodiscard]] std::uint64_t loaded_as_predictors() const { return predictors_; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Slot {
    PageId id;
    PageSamples<Word>* samples = nullptr;  ///< null where the slot is free
    PageBounds<Word>* values = nullptr;    ///< null where they are not there
    bool used = false, wanted = false;
  };
  /// Slots of the pages of an LOD, i running fastest.
  struct Lod {
    std::size_t row, plane;
    std::vector<std::uint32_t> slots;
  };
  /// Parts of pages, and those of them that have left.
  template <class Part>
  struct Parts {
    StableVector<Part> all;
    std::vector<Part*> free;
  };

  [[nodiscard]] std::uint32_t& slot_of(const PageId& id) {
    Lod& lod = lods_[static_cast<std::size_t>(id.lod)];
    const auto at = [](std::int32_t x) { return static_cast<std::size_t>(x); };
    return lod.slots[at(id.block.i) + lod.row * at(id.block.j) + lod.plane * at(id.block.k)];
  }
  /// `wanted`: the page is asked for itself, not to predict another. Null where it cannot be had.
  const Slot* get(const PageId& id, PageParts parts, bool wanted);
  const Slot* load(const PageId& id, PageParts parts, bool wanted);
  /// Copies the points of coarser LODs into parts of a page.
  void fill_coarser(const PageShape& shape, const Surroundings<Word>& around, PageParts parts,
                    PageSamples<Word>& samples, PageBounds<Word>* values) const;
  /// Room for a part, for which pages leave if need be.
  template <class Part>
  Part* room_for(Parts<Part>& parts);
  /// Makes the page leave that is the next in turn.
  void leave();
  std::uint32_t free_slot();

  PageGrid grid_;
  std::size_t memory_;
  Loader loader_;
  std::vector<Lod> lods_;
  Parts<PageSamples<Word>> samples_;
  Parts<PageBounds<Word>> values_;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_;  ///< slots
  std::size_t considered_ = 0;       ///< the slot whose page is the next that may leave
  std::uint64_t loaded_ = 0, predictors_ = 0;
};

extern template class PageCache<std::uint8_t>;
extern template class PageCache<std::uint16_t>;
extern template class PageCache<std::uint32_t>;

}  // namespace adamas
