#include "isosurface/storage/still_pages.h"

#include <algorithm>
#include <array>
#include <optional>

#include "core/base/checksum.h"
#include "isosurface/compression/time_codec.h"
#include "isosurface/storage/page_payload.h"

namespace adamas {

namespace {

/// What a page of a step after the first one of a block is like that has the bounds of the step before, and
/// samples of which one byte tells.
struct ShortPage {
  std::uint32_t size, checksum;

  explicit ShortPage(std::byte samples) {
    const std::array bytes{samples};
    const std::vector<std::byte> payload = join_payload({bytes, {}, {}, 0});
    size = static_cast<std::uint32_t>(payload.size());
    checksum = crc32c(payload);
  }
  /// Of so few bytes none have the checksum of others.
  [[nodiscard]] bool is(const PageEntry& entry) const {
    return entry.size == size && entry.checksum == checksum;
  }
};

}  // namespace

bool StillPages::is_still(const PageId& page, std::uint32_t from, std::uint32_t to, bool reads) {
  const auto [first, last] = std::minmax(from, to);
  // A whole step would end it.
  if (last - first >= kWholeSteps || file_.header().gradients) return false;
  for (std::uint32_t step = first + 1; step <= last; ++step) {
    if (!is_still_at(step, page, reads)) return false;
  }
  return true;
}

bool StillPages::is_still_at(std::uint32_t step, const PageId& page, bool reads) {
  const PageGrid& grid = file_.grid();
  // Cubes whose only point belongs to coarser LODs have no page.
  if (!grid.contains(page))
    return page.lod >= grid.top() ||
           is_still_at(step, {page.lod + 1, {page.block.i / 2, page.block.j / 2, page.block.k / 2}}, reads);
  if (step_ != step) known_.clear();
  step_ = step;
  const std::uint64_t number = grid.number(page);
  if (const auto known = known_.find(number); known != known_.end()) return known->second;
  const bool is_still = says_directory(step, page, reads);
  known_.emplace(number, is_still);
  return is_still;
}

bool StillPages::says_directory(std::uint32_t step, const PageId& page, bool reads) {
  static const ShortPage kSame(kAsBefore), kPredicted(std::byte{1});
  if (step == file_.header(step).first_step) return false;
  if (!reads && !file_.has_entry(step, page)) return false;
  const std::optional<PageEntry> before = file_.entry(step - 1, page), now = file_.entry(step, page);
  if (!before || !now) return false;
  const auto is_plain = [](const PageEntry& entry) { return entry.size == 0; };
  const bool are_plain =
      is_plain(*before) && is_plain(*now) && before->low == now->low && before->high == now->high;
  const bool are_predicted = kPredicted.is(*now) && (is_plain(*before) || kPredicted.is(*before));
  if (file_.grid().is_complete(page)) return are_plain || are_predicted || kSame.is(*now);
  // Its other points are those of the page that covers it.
  if (kSame.is(*now))
    return is_still_at(step, {page.lod + 1, {page.block.i / 2, page.block.j / 2, page.block.k / 2}}, reads);
  if (!are_plain && !are_predicted) return false;
  // What it is predicted from, as of Surroundings.
  const LatticePoint extent = file_.grid().extent(page.lod + 1);
  constexpr std::int32_t kSide = PageGrid::kSide;
  LatticePoint first, last;
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = std::max(0, kSide / 2 * page.block[axis] - 1) / kSide;
    last[axis] = std::min(extent[axis], kSide / 2 * (page.block[axis] + 1)) / kSide;
  }
  for (std::int32_t k = first.k; k <= last.k; ++k) {
    for (std::int32_t j = first.j; j <= last.j; ++j) {
      for (std::int32_t i = first.i; i <= last.i; ++i) {
        if (!is_still_at(step, {page.lod + 1, {i, j, k}}, reads)) return false;
      }
    }
  }
  return true;
}

}  // namespace adamas
