#include "isosurface/extraction/stored_diamonds.h"

#include <algorithm>

#include "isosurface/preprocessing/preprocess.h"

namespace adamas {

namespace {

Domain domain_of(const VolumeGrid& volume, int depth) {
  const double side = static_cast<double>(std::int32_t{1} << depth);
  return {Box3{volume.origin, volume.origin + side * volume.spacing}, {1, 1, 1}};
}

}  // namespace

template <class Sample>
StoredDiamonds<Sample>::StoredDiamonds(StoredPages<Word>& pages)
    : pages_(pages),
      grid_(pages.grid()),
      shift_(kRootBits - grid_.depth()),
      domain_(domain_of(pages.file().header().grid, grid_.depth())),
      recent_(static_cast<std::size_t>(grid_.top() + 1)) {
  const Vec3 spacing = pages.file().header().grid.spacing;
  for (int level = 0; level < std::max(1, grid_.depth()); ++level) {
    const ErrorScale scale = level_error_scale(spacing, level);
    for (int code = 0; code < ErrorScale::kCodes; ++code)
      errors_[static_cast<std::size_t>(code == 0 ? 0 : code + 4 * level)] =
          scale.decode(static_cast<std::uint8_t>(code));
  }
}

template <class Sample>
int StoredDiamonds<Sample>::rank_within(double error) const {
  const auto end = errors_.begin() + std::max(1, ErrorScale::kCodes + 4 * (grid_.depth() - 1));
  return static_cast<int>(std::upper_bound(errors_.begin(), end, error) - errors_.begin()) - 1;
}

template <class Sample>
const Page<typename StoredDiamonds<Sample>::Word>& StoredDiamonds<Sample>::page(const PageId& id) {
  if (generation_ != pages_.generation()) {
    for (Recent& recent : recent_) recent.id.level = -1;
    generation_ = pages_.generation();
  }
  Recent& recent = recent_[static_cast<std::size_t>(id.level)];
  if (recent.id != id) {
    const Page<Word>* found = pages_.page(id);
    if (found == nullptr) throw PageLost{id};
    recent.id = id;
    recent.page = found;
    if (generation_ != pages_.generation()) {
      for (Recent& other : recent_) {
        if (&other != &recent) other.id.level = -1;
      }
      generation_ = pages_.generation();
    }
  }
  return *recent.page;
}

template <class Sample>
const PageEntry& StoredDiamonds<Sample>::entry(const PageId& id) {
  Recent& recent = recent_[static_cast<std::size_t>(id.level)];
  if (recent.entry_id != id) {
    const std::optional<PageEntry> found = pages_.entry(id);
    if (!found) throw PageLost{id};
    recent.entry_id = id;
    recent.entry = *found;
  }
  return recent.entry;
}

template <class Sample>
double StoredDiamonds<Sample>::sample(LatticePoint p) {
  LatticePoint at = in_samples(p);
  if (!has_place(at, grid_.level(at))) {
    for (int axis = 0; axis < 3; ++axis) at[axis] = std::min(at[axis], grid_.last()[axis]);
  }
  const PageId id = grid_.page(at);
  return value(page(id).samples[PageGrid::place(at, id.level)]);
}

template <class Sample>
int StoredDiamonds<Sample>::rank_if_crossed(LatticePoint p, double isovalue) {
  const LatticePoint at = in_samples(p);
  const PageId id = grid_.page(at);
  if (!has_place(at, id.level)) return rank_by_parents(p, isovalue);
  const PageEntry& known = entry(id);
  if (!crosses(known.low, known.high, isovalue)) return 0;
  const Page<Word>& from = page(id);
  const std::size_t place = PageGrid::place(at, id.level);
  const int code = from.errors[place];
  return code == 0 || !crosses(from.low[place], from.high[place], isovalue) ? 0 : code + 4 * level(p);
}

template <class Sample>
int StoredDiamonds<Sample>::rank_by_parents(LatticePoint p, double isovalue) {
  const PageEntry& all = entry({grid_.top(), {0, 0, 0}});
  if (!crosses(all.low, all.high, isovalue)) return 0;
  int rank = ErrorScale::kCodes - 1 + 4 * level(p);
  for (const LatticePoint parent : Diamond(p).parents(domain_)) {
    if (is_stored(parent)) rank = std::min(rank, rank_if_crossed(parent, isovalue));
  }
  return rank;
}

template <class Sample>
std::array<double, 2> StoredDiamonds<Sample>::range() {
  const PageEntry& all = entry({grid_.top(), {0, 0, 0}});
  return {value(static_cast<Word>(all.low)), value(static_cast<Word>(all.high))};
}

template class StoredDiamonds<std::uint8_t>;
template class StoredDiamonds<std::uint16_t>;
template class StoredDiamonds<std::int16_t>;
template class StoredDiamonds<float>;

}  // namespace adamas
