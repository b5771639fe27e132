#include "isosurface/storage/page_comparison.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "core/base/checksum.h"
#include "isosurface/storage/page_payload.h"

namespace adamas::isosurface {

namespace {

/// Returns the bytes of a page that has the samples and bounds of the step before.
const std::vector<std::byte>& bytes_as_before() {
  static const std::vector<std::byte> kBytes = [] {
    const std::array samples{kAsBefore};
    return join_payload({samples, {}, {}, 0});
  }();
  return kBytes;
}

bool is_as_before(const PageEntry& entry) {
  // No other bytes of this size have the same checksum.
  return entry.size == bytes_as_before().size() && entry.checksum == crc32c(bytes_as_before());
}

}  // namespace

template <class Word>
bool PageComparison<Word>::has_same_samples(const PageId& page) {
  return has_same_points(page, {0, 0, 0}, page_shape(before_.grid(), page).count - LatticePoint{1, 1, 1});
}

template <class Word>
bool PageComparison<Word>::has_same_points(const PageId& id, LatticePoint first, LatticePoint last) {
  const PageGrid& grid = before_.grid();
  const bool may_load = loads() && (id.lod > 0 || grid.top() == 0);
  if (may_load) {
    before_.samples(id);
    after_.samples(id);
  }
  // They may share a memory, where one may have made room for the other.
  const PageSamples<Word>*const before = before_.held(id), *const after = after_.held(id);
  if (before != nullptr && after != nullptr) {
    for (std::int32_t k = first.k; k <= last.k; ++k) {
      for (std::int32_t j = first.j; j <= last.j; ++j) {
        const std::size_t row = PageGrid::place({0, j, k}, 0);
        const auto at = [&](const PageSamples<Word>& page, std::int32_t i) {
          return page.samples.begin() + static_cast<std::ptrdiff_t>(row) + i;
        };
        if (!std::equal(at(*before, first.i), at(*before, last.i + 1), at(*after, first.i))) return false;
      }
    }
    return true;
  }
  if (id.lod >= grid.top()) return false;
  // A cube whose only point belongs to coarser LODs has no page.
  if (grid.contains(id) && !is_same_by_directory(id)) return false;
  // Its other points belong to the page that covers it.
  const PageId parent{id.lod + 1, {id.block.i / 2, id.block.j / 2, id.block.k / 2}};
  const LatticePoint corner =
      PageGrid::kSide / 2 * LatticePoint{id.block.i % 2, id.block.j % 2, id.block.k % 2};
  LatticePoint from, to;
  for (int axis = 0; axis < 3; ++axis) {
    from[axis] = corner[axis] + (first[axis] + 1) / 2;
    to[axis] = corner[axis] + last[axis] / 2;
    if (from[axis] > to[axis]) return true;
  }
  return has_same_points(parent, from, to);
}

/// Returns whether the samples of a page's own points and of the cells round them are all equal. The value
/// must not be one that ranges leave out, and no sample may stand for others beyond the data.
template <class Word>
bool PageComparison<Word>::is_uniform(const PageId& id, const PageEntry& entry) const {
  if (sizeof(Word) > 2 || entry.size > 0 || entry.low != entry.high) return false;
  const LatticePoint last = before_.grid().last();
  for (int axis = 0; axis < 3; ++axis) {
    if ((std::int64_t{PageGrid::kSide} * (id.block[axis] + 1)) << id.lod > last[axis]) return false;
  }
  return true;
}

template <class Word>
bool PageComparison<Word>::is_same_by_directory(const PageId& id) {
  StoreFile& file = before_.file();
  const auto [first, last] = std::minmax({before_.step(), after_.step()});
  // Pages of whole steps give no information.
  if (last - first >= kWholeSteps) return false;
  const auto entry = [&](std::uint32_t step) -> std::optional<PageEntry> {
    if (!loads() && !file.has_entry(step, id)) return {};
    return file.entry(step, id);
  };
  std::optional<PageEntry> before = entry(first);
  for (std::uint32_t step = first + 1; step <= last; ++step) {
    const std::optional<PageEntry> now = entry(step);
    if (!before || !now) return false;
    const bool are_uniform = is_uniform(id, *before) && is_uniform(id, *now) && before->low == now->low;
    if (!are_uniform && (step == file.header(step).first_step || !is_as_before(*now))) return false;
    before = now;
  }
  return true;
}

template <class Word>
bool PageComparison<Word>::has_same_bounds(const PageId& id) {
  if (before_.has(id, PageParts::kAll) && after_.has(id, PageParts::kAll))
    return are_same_bounds(page_shape(before_.grid(), id), *before_.bounds(id), *after_.bounds(id));
  return is_same_by_directory(id);
}

ADAMAS_INSTANTIATE_FOR_WORDS(PageComparison);

}  // namespace adamas::isosurface
