#include "isosurface/storage/restore.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/base/error.h"

namespace adamas::isosurface {

namespace {

/// The coordinates of a part that a block of its LOD has along an axis: from `begin` to `end`, both included.
struct BlockSpan {
  std::int32_t begin, end;
  BlockSpan(std::int32_t block, std::int32_t first, std::int32_t last)
      : begin(std::max(first, PageGrid::kSide * block)),
        end(std::min(last, PageGrid::kSide * block + PageGrid::kSide - 1)) {}
};

/// Returns the first and the last sample of a part along one axis, in units of 2^lod; the first is greater
/// where there is none.
std::pair<std::int32_t, std::int32_t> samples_within(double low, double high, std::int32_t last) {
  // A sample on the region's border counts, even if its place is rounded.
  constexpr double kSlack = 1e-9;
  const double end = last;
  return {static_cast<std::int32_t>(std::clamp(std::ceil(low - kSlack), 0.0, end + 1)),
          static_cast<std::int32_t>(std::clamp(std::floor(high + kSlack), -1.0, end))};
}

/// Returns the part, and the first axis along which it has no sample; 3 if it has samples.
std::pair<RestoredPart, int> find_part(const VolumeGrid& volume, int lod, const std::optional<Box3>& region) {
  RestoredPart part;
  part.lod = lod;
  part.grid = volume;
  Vec3 first = volume.origin;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double step = std::ldexp(volume.spacing[axis], lod);
    part.last[axis] = static_cast<std::int32_t>(volume.dimensions[a] - 1) >> lod;
    if (region)
      std::tie(part.first[axis], part.last[axis]) =
          samples_within((region->min[axis] - volume.origin[axis]) / step,
                         (region->max[axis] - volume.origin[axis]) / step, part.last[axis]);
    if (part.first[axis] > part.last[axis]) return {part, axis};
    part.grid.dimensions[a] = static_cast<std::uint64_t>(part.last[axis] - part.first[axis] + 1);
    first[axis] += part.first[axis] * step;
    part.grid.spacing[axis] = step;
  }
  part.grid.origin = volume.in_space(first);
  return {part, 3};
}

}  // namespace

RestoredPart restored_part(const VolumeGrid& volume, int lod, const std::optional<Box3>& region,
                           const std::string& name) {
  const PageGrid pages(volume.dimensions);
  if (lod < 0 || lod > pages.top())
    fail("{}: expected an LOD from 0 to {}, found {}", name, pages.top(), lod);
  const auto [part, empty] = find_part(volume, lod, region);
  if (empty < 3)
    fail("{}: expected a region with samples of LOD {}, found none along {}", name, lod, "xyz"[empty]);
  return part;
}

std::vector<RestoredPart> restored_lods(const VolumeGrid& volume, int lod, const std::optional<Box3>& region,
                                        std::uint64_t enough, const std::string& name) {
  const int top = PageGrid(volume.dimensions).top();
  std::vector<RestoredPart> parts{restored_part(volume, lod, region, name)};
  while (parts.back().lod < top) {
    const auto& n = parts.back().grid.dimensions;
    if (*std::max_element(n.begin(), n.end()) <= enough) break;
    const auto [part, empty] = find_part(volume, parts.back().lod + 1, region);
    if (empty < 3) break;
    parts.push_back(part);
  }
  return parts;
}

template <class Sample>
SlabRestorer<Sample>::SlabRestorer(StoredPages<Word>& pages, const RestoredPart& part)
    : pages_(pages), part_(part), planes_(PageGrid::kSide * part.grid.plane_samples()) {}

template <class Sample>
void SlabRestorer<Sample>::copy_row(std::int32_t j, std::int32_t k) {
  const std::int32_t end = part_.last.i / PageGrid::kSide;
  for (std::int32_t i = part_.first.i / PageGrid::kSide; i <= end; ++i) copy({part_.lod, {i, j, k}});
}

template <class Sample>
std::size_t SlabRestorer<Sample>::plane_count(std::int32_t k) const {
  const BlockSpan z(k, part_.first.k, part_.last.k);
  return static_cast<std::size_t>(z.end - z.begin + 1);
}

template <class Sample>
void SlabRestorer<Sample>::copy(const PageId& id) {
  const PageSamples<Word>* page = pages_.samples(id);
  StoreFile& file = pages_.file();
  if (page == nullptr)
    throw DamagedPage(fmt::format("{}: {} is damaged{}, or one that it is predicted from", file.name(),
                                  page_name(id),
                                  file.steps() > 1 ? fmt::format(" at step {}", pages_.step()) : ""));
  const BlockSpan x(id.block.i, part_.first.i, part_.last.i), y(id.block.j, part_.first.j, part_.last.j),
      z(id.block.k, part_.first.k, part_.last.k);
  for (std::int32_t k = z.begin; k <= z.end; ++k) {
    for (std::int32_t j = y.begin; j <= y.end; ++j) {
      const std::size_t from = PageGrid::place({x.begin, j, k}, 0);
      const auto row = static_cast<std::size_t>(k - z.begin) * part_.grid.plane_samples() +
                       static_cast<std::size_t>(j - part_.first.j) * part_.grid.dimensions[0];
      Sample* to = planes_.data() + row + (x.begin - part_.first.i);
      for (std::int32_t i = 0; i <= x.end - x.begin; ++i)
        to[i] = from_ordered<Sample>(page->samples[from + static_cast<std::size_t>(i)]);
    }
  }
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(SlabRestorer);

template <class Word>
std::size_t restored_page_bytes(const PageGrid& grid, const RestoredPart& part) {
  // These are one row of pages of the part's LOD, each of which is needed once, and a few rows of coarser
  // ones. They count twice, since pages leave a cache in no strict order.
  std::size_t pages = 0;
  for (int lod = part.lod; lod <= grid.top(); ++lod) {
    const auto along = [&](int axis) {
      const std::int32_t span = (part.last[axis] - part.first[axis]) >> (lod - part.lod);
      return static_cast<std::size_t>(span / PageGrid::kSide + 3);
    };
    pages += lod == part.lod ? along(0) : 3 * along(0) * along(1);
  }
  return 2 * pages * sizeof(PageSamples<Word>);
}

ADAMAS_INSTANTIATE_FUNCTION_FOR_WORDS(restored_page_bytes);

std::uint64_t restored_slab_bytes(const RestoredPart& part) {
  return PageGrid::kSide * part.grid.plane_bytes();
}

}  // namespace adamas::isosurface
