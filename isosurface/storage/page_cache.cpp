#include "isosurface/storage/page_cache.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/base/assert.h"
#include "core/base/simd.h"
#include "isosurface/volume/page.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

namespace {

constexpr std::int32_t kSurroundingSide = Surroundings<std::uint8_t>::kSide;

/// The places of Surroundings along an axis in the pages of the next coarser LOD.
struct AxisPlaces {
  std::array<std::int32_t, 2> blocks{};  ///< the coordinates of these pages
  int block_count = 0;
  /// The place in its page of each place of Surroundings.
  std::array<std::uint8_t, kSurroundingSide> place{};
  /// The places that lie in one page: the first, their number, and whether they are consecutive there.
  struct Run {
    std::size_t first = 0, count = 0;
    bool is_run = true;
  };
  std::array<Run, 2> runs{};

  AxisPlaces(std::int32_t block, std::int32_t extent, std::int32_t first, std::int32_t last) {
    for (std::int32_t c = first; c <= last; ++c) {
      const std::int32_t at = std::clamp(8 * block + c - 1, 0, extent);
      const std::int32_t parent = at / PageGrid::kSide;
      if (block_count == 0 || blocks[static_cast<std::size_t>(block_count - 1)] != parent)
        blocks[static_cast<std::size_t>(block_count++)] = parent;
      place[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(at % PageGrid::kSide);
      Run& run = runs[static_cast<std::size_t>(block_count - 1)];
      if (run.count == 0) run.first = static_cast<std::size_t>(c);
      run.is_run = run.is_run && place[static_cast<std::size_t>(c)] == place[run.first] + run.count;
      ++run.count;
    }
  }
};

/// The places of Surroundings along all axes.
struct BoxPlaces {
  AxisPlaces x, y, z;

  BoxPlaces(LatticePoint block, LatticePoint extent, std::int32_t first, std::int32_t last)
      : x(block.i, extent.i, first, last),
        y(block.j, extent.j, first, last),
        z(block.k, extent.k, first, last) {}
};

/// The part of Surroundings that lies in one page of the next coarser LOD.
struct SurroundingPart {
  const BoxPlaces& places;
  std::array<int, 3> blocks;  ///< the index into AxisPlaces::blocks, by axis

  [[nodiscard]] AxisPlaces::Run run(const AxisPlaces& axis, std::size_t n) const {
    return axis.runs[static_cast<std::size_t>(blocks[n])];
  }
};

/// Copies the numbers of a part whose rows are N points side by side; with N = 0 those of any part, one by
/// one.
template <std::size_t N, class T>
void copy_part(const SurroundingPart& part, const PagePoints<T>& from,
               std::array<T, kSurroundingSide * kSurroundingSide * kSurroundingSide>& to) {
  const auto& [x, y, z] = part.places;
  const AxisPlaces::Run xs = part.run(x, 0), ys = part.run(y, 1), zs = part.run(z, 2);
  for (std::size_t k = zs.first; k < zs.first + zs.count; ++k) {
    for (std::size_t j = ys.first; j < ys.first + ys.count; ++j) {
      const T* row = from.data() + PageGrid::kSide * (y.place[j] + std::size_t{PageGrid::kSide} * z.place[k]);
      T* at = to.data() + kSurroundingSide * (j + kSurroundingSide * k);
      if constexpr (N > 0) {
        std::copy_n(row + x.place[xs.first], N, at + xs.first);
      } else {
        for (std::size_t c = xs.first; c < xs.first + xs.count; ++c) at[c] = row[x.place[c]];
      }
    }
  }
}

template <class T>
void copy_part(const SurroundingPart& part, const PagePoints<T>& from,
               std::array<T, kSurroundingSide * kSurroundingSide * kSurroundingSide>& to) {
  // Away from the data's ends rows have one of these numbers of points, which lie side by side.
  const AxisPlaces::Run xs = part.run(part.places.x, 0);
  if (xs.is_run && xs.count == 1) return copy_part<1>(part, from, to);
  if (xs.is_run && xs.count == 2) return copy_part<2>(part, from, to);
  if (xs.is_run && xs.count == 8) return copy_part<8>(part, from, to);
  if (xs.is_run && xs.count == 9) return copy_part<9>(part, from, to);
  if (xs.is_run && xs.count == 10) return copy_part<10>(part, from, to);
  copy_part<0>(part, from, to);
}

}  // namespace

template <class Word>
PageCache<Word>::PageCache(const PageGrid& grid, std::size_t memory)
    : PageCache(grid, std::make_shared<Memory>(memory)) {}

template <class Word>
PageCache<Word>::PageCache(const PageGrid& grid, std::shared_ptr<Memory> memory)
    : grid_(grid), memory_(std::move(memory)) {
  for (int lod = 0; lod <= grid_.top(); ++lod) {
    const LatticePoint n = grid_.blocks(lod);
    const auto row = static_cast<std::size_t>(n.i), plane = row * static_cast<std::size_t>(n.j);
    lods_.push_back({row, plane, std::vector<std::uint32_t>(plane * static_cast<std::size_t>(n.k), kNone)});
  }
  memory_->caches.push_back(this);
}

template <class Word>
PageCache<Word>::~PageCache() {
  std::erase(memory_->caches, this);
  for (const Slot& slot : slots_) {
    if (slot.samples != nullptr) memory_->samples.free.push_back(slot.samples);
    if (slot.bounds != nullptr) memory_->bounds.free.push_back(slot.bounds);
  }
}

template <class Word>
void PageCache<Word>::touch(const PageCache* before) {
  std::vector<PageCache*>& caches = memory_->caches;
  std::erase(caches, this);
  caches.insert(before == nullptr ? caches.end() : std::find(caches.begin(), caches.end(), before), this);
}

template <class Word>
const typename PageCache<Word>::Slot* PageCache<Word>::get(const PageId& id, PageParts parts, bool wanted) {
  const std::uint32_t found = slot_of(id);
  if (found == kNone) return fetch(id, parts, wanted);
  Slot& slot = slots_[found];
  slot.used = true;
  if (wanted && !slot.wanted) {
    slot.wanted = true;
    --predictors_;
  }
  return slot.bounds == nullptr && has_part(parts, PageParts::kBounds) ? fetch(id, parts, wanted) : &slot;
}

template <class Word>
const typename PageCache<Word>::Slot* PageCache<Word>::fetch(const PageId& id, PageParts parts, bool wanted) {
  if (!loads_) return nullptr;
  Surroundings<Word> around;
  if (!surroundings(id, around, parts)) return nullptr;
  // Pages that predict this one, and room for its bounds, may have removed other pages from memory, even this
  // one's samples. Only now it is known whether these are still there.
  PageBounds<Word>* const bounds = has_part(parts, PageParts::kBounds) ? room_in(memory_->bounds) : nullptr;
  const std::uint32_t known = slot_of(id);
  PageSamples<Word>* const samples = known != kNone ? slots_[known].samples : room_in(memory_->samples);
  const PageToLoad<Word> page{
      id, page_shape(grid_, id), known == kNone ? parts : PageParts::kBounds, around, *samples, bounds};
  if (!page.shape.complete) fill_coarser(page);
  // A cube whose only point belongs to coarser LODs has no page.
  const bool is_stored = grid_.contains(id);
  // Other caches may need room meanwhile.
  if (known != kNone) slots_[known].pinned = true;
  const bool is_loaded = !is_stored || load(page);
  if (known != kNone) slots_[known].pinned = false;
  if (!is_loaded) {
    if (known == kNone) memory_->samples.free.push_back(samples);
    if (bounds != nullptr) memory_->bounds.free.push_back(bounds);
    return nullptr;
  }
  if (known != kNone) {
    slots_[known].bounds = bounds;
    return &slots_[known];
  }
  if (is_stored) {
    ++loaded_;
    predictors_ += wanted ? 0 : 1;
  }
  const std::uint32_t fresh = free_slot();
  slot_of(id) = fresh;
  slots_[fresh] = {id, samples, bounds, true, wanted || !is_stored};
  return &slots_[fresh];
}

template <class Word>
bool PageCache<Word>::copy(const PageId& id, Page<Word>& page) {
  const Slot* slot = get(id, PageParts::kAll, true);
  if (slot == nullptr) return false;
  static_cast<PageSamples<Word>&>(page) = *slot->samples;
  static_cast<PageBounds<Word>&>(page) = *slot->bounds;
  return true;
}

template <class Word>
std::vector<typename PageCache<Word>::HeldPage> PageCache<Word>::held_pages() const {
  std::vector<HeldPage> found;
  for (const Slot& slot : slots_) {
    if (slot.samples != nullptr) found.push_back({slot.id, slot.samples});
  }
  return found;
}

template <class Word>
void PageCache<Word>::copy_samples(std::span<const HeldPage> pages) {
  for (const HeldPage& page : pages) {
    if (slot_of(page.id) != kNone) continue;
    if (!memory_->has_room_in(memory_->samples)) return;
    PageSamples<Word>* const samples = room_in(memory_->samples);
    *samples = *page.samples;
    const std::uint32_t fresh = free_slot();
    slot_of(page.id) = fresh;
    slots_[fresh] = {page.id, samples, nullptr, false, true};
  }
}

template <class Word>
bool PageCache<Word>::has(const PageId& id, PageParts parts) {
  const std::uint32_t found = slot_of(id);
  if (found == kNone) return false;
  Slot& slot = slots_[found];
  if (slot.bounds == nullptr && has_part(parts, PageParts::kBounds)) return false;
  if (!slot.wanted) --predictors_;
  slot.used = slot.wanted = true;
  return true;
}

template <class Word>
void PageCache<Word>::need(const PageId& id, int importance) {
  const std::uint32_t found = slot_of(id);
  if (found == kNone) return;
  Slot& slot = slots_[found];
  const bool is_known = std::exchange(slot.needed, needs_) == needs_;
  slot.importance = is_known ? std::max(slot.importance, importance) : importance;
}

template <class Word>
bool PageCache<Word>::put(const PageId& id, const PageSamples<Word>& samples, const PageBounds<Word>* bounds,
                          int importance) {
  if (slot_of(id) == kNone) {
    PageSamples<Word>* const room = room_in(memory_->samples, importance);
    if (room == nullptr) return false;
    *room = samples;
    const std::uint32_t fresh = free_slot();
    slot_of(id) = fresh;
    slots_[fresh] = {id, room, nullptr, true, true};
  }
  // The page itself must not leave for its bounds.
  need(id, importance);
  if (bounds == nullptr || slots_[slot_of(id)].bounds != nullptr) return true;
  PageBounds<Word>* const room = room_in(memory_->bounds, importance);
  if (room == nullptr) return false;
  *room = *bounds;
  slots_[slot_of(id)].bounds = room;
  return true;
}

template <class Word>
void PageCache<Word>::drop_bounds(const PageId& id) {
  if (memory_->keeps_bounds) return;
  const std::uint32_t found = slot_of(id);
  if (found == kNone || slots_[found].bounds == nullptr) return;
  memory_->bounds.free.push_back(std::exchange(slots_[found].bounds, nullptr));
}

template <class Word>
void PageCache<Word>::drop_bounds() {
  for (Slot& slot : slots_) {
    if (slot.bounds != nullptr) memory_->bounds.free.push_back(std::exchange(slot.bounds, nullptr));
  }
  if (memory_->caches.size() == 1) memory_->bounds = {};
}

template <class Word>
bool PageCache<Word>::surroundings(const PageId& id, Surroundings<Word>& around, PageParts parts) {
  if (grid_.is_complete(id)) return true;
  const LatticePoint extent = grid_.extent(id.lod + 1);
  constexpr std::int32_t kLast = Surroundings<Word>::kSide - 1;
  const BoxPlaces all(id.block, extent, 0, kLast), inner(id.block, extent, 1, kLast - 1);
  const LatticePoint parent{id.block.i / 2, id.block.j / 2, id.block.k / 2};
  if (has_part(parts, PageParts::kBounds)) {
    around.low.fill(0);
    around.high.fill(static_cast<Word>(~Word{0}));
    around.errors.fill(Surroundings<Word>::kNoBound);
  }
  for (int bz = 0; bz < all.z.block_count; ++bz) {
    for (int by = 0; by < all.y.block_count; ++by) {
      for (int bx = 0; bx < all.x.block_count; ++bx) {
        const auto block = [](const AxisPlaces& axis, int b) {
          return axis.blocks[static_cast<std::size_t>(b)];
        };
        const LatticePoint at{block(all.x, bx), block(all.y, by), block(all.z, bz)};
        const bool with_bounds = has_part(parts, PageParts::kBounds) && at == parent;
        const Slot* from = get({id.lod + 1, at}, with_bounds ? PageParts::kAll : PageParts::kSamples, false);
        if (from == nullptr) return false;
        copy_part(SurroundingPart{all, {bx, by, bz}}, from->samples->samples, around.samples);
        if (!with_bounds) continue;
        const SurroundingPart inner_part{inner, {0, 0, 0}};
        copy_part(inner_part, from->bounds->low, around.low);
        copy_part(inner_part, from->bounds->high, around.high);
        copy_part(inner_part, from->bounds->errors, around.errors);
      }
    }
  }
  return true;
}

template <class Word>
void PageCache<Word>::fill_coarser(const PageToLoad<Word>& page) {
  const LatticePoint count = page.shape.count;
  for (std::int32_t k = 0; k < count.k; k += 2) {
    for (std::int32_t j = 0; j < count.j; j += 2) {
      const std::size_t to = PageGrid::place({0, j, k}, 0), from = surrounding_place({0, j, k});
      const auto fill = [=](const auto& coarser, auto& numbers) {
        using Lanes = EightLanes<typename std::remove_reference_t<decltype(numbers)>::value_type>;
        const Lanes lanes = Lanes::load(coarser.data() + from);
        Lanes::store_by_turns(lanes, lanes, numbers.data() + to);
      };
      if (has_part(page.parts, PageParts::kSamples)) fill(page.around.samples, page.samples.samples);
      if (page.bounds == nullptr) continue;
      fill(page.around.low, page.bounds->low);
      fill(page.around.high, page.bounds->high);
      fill(page.around.errors, page.bounds->errors);
    }
  }
}

template <class Word>
template <class Part>
Part* PageCache<Word>::room_in(Pool<Part>& pool) {
  if (pool.free.empty() && memory_->has_room_in(pool)) return pool.all.add();
  while (pool.free.empty()) {
    // There are more pages than those that are being loaded.
    const bool is_out = evict_in_turn();
    ADAMAS_ASSERT(is_out);
  }
  Part* const part = pool.free.back();
  pool.free.pop_back();
  return part;
}

template <class Word>
template <class Part>
Part* PageCache<Word>::room_in(Pool<Part>& pool, int importance) {
  while (!memory_->has_room_in(pool)) {
    if (!evict_from_older() && !evict_less_than(std::numeric_limits<int>::min()) &&
        !evict_less_than(importance))
      return nullptr;
  }
  return room_in(pool);
}

template <class Word>
bool PageCache<Word>::evict_less_than(int importance) {
  // No page counts as used in the second round.
  for (std::size_t looks = 2 * slots_.size() + 1; looks > 0; --looks, next_turn()) {
    Slot& slot = slots_[turn_];
    // All other pages depend on the coarsest page.
    if (slot.samples == nullptr || slot.id.lod == grid_.top()) continue;
    if (slot.needed == needs_ && slot.importance >= importance) continue;
    if (std::exchange(slot.used, false)) continue;
    remove(slot);
    return true;
  }
  return false;
}

template <class Word>
bool PageCache<Word>::evict_in_turn() {
  const std::vector<PageCache*>& caches = memory_->caches;
  // No page counts as used in the second round.
  for (std::size_t looks = 2 * caches.size() + 1; looks > 0; --looks, ++memory_->turn) {
    if (caches[memory_->turn %= caches.size()]->evict()) return true;
  }
  return false;
}

template <class Word>
bool PageCache<Word>::evict_from_older() {
  for (PageCache* const cache : memory_->caches) {
    if (cache == this) return false;
    for (int round = 0; round < 3; ++round) {
      if (cache->evict()) return true;
    }
  }
  return false;
}

template <class Word>
bool PageCache<Word>::evict() {
  for (; turn_ < slots_.size(); ++turn_) {
    Slot& slot = slots_[turn_];
    if (slot.samples == nullptr || slot.pinned) continue;
    if (std::exchange(slot.used, false)) continue;
    remove(slot);
    return true;
  }
  turn_ = 0;
  return false;
}

template <class Word>
void PageCache<Word>::remove(Slot& slot) {
  memory_->samples.free.push_back(slot.samples);
  if (slot.bounds != nullptr) memory_->bounds.free.push_back(slot.bounds);
  slot_of(slot.id) = kNone;
  free_slots_.push_back(static_cast<std::uint32_t>(&slot - slots_.data()));
  slot = {};
  ++evicted_;
}

template <class Word>
std::uint32_t PageCache<Word>::free_slot() {
  if (free_slots_.empty()) {
    slots_.emplace_back();
    return static_cast<std::uint32_t>(slots_.size() - 1);
  }
  const std::uint32_t slot = free_slots_.back();
  free_slots_.pop_back();
  return slot;
}

ADAMAS_INSTANTIATE_FOR_WORDS(PageCache);

}  // namespace adamas::isosurface
