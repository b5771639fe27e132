#pragma once

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>
#include <vector>

#include "isosurface/preprocessing/preprocess.h"
#include "isosurface/storage/page_cache.h"
#include "isosurface/volume/samples.h"

namespace adamas::test {

/// A volume in memory and all that preprocessing finds of it, by pages.
template <class Sample>
class PreparedVolume {
 public:
  using Word = OrderedWord<Sample>;

  /// `samples`: i running fastest. Lods below `depth` have no values, as with subtrees.
  PreparedVolume(const std::array<std::uint64_t, 3>& dimensions, const std::vector<Sample>& samples,
                 Vec3 spacing = {1, 1, 1}, int depth = 0)
      : tree_(PageGrid(dimensions), std::size_t{1} << 40,
              [this](const PageId& id, const PageShape& shape, const Surroundings<Word>&, PageParts parts,
                     PageSamples<Word>& found, PageBounds<Word>* values) {
                const Page<Word>& own = pages_.at(tree_.grid().number(id));
                for (std::size_t at = 0; at < PageGrid::kPoints; ++at) {
                  if (!shape.owns(point_at(at))) continue;
                  if (has_part(parts, PageParts::kSamples)) found.samples[at] = own.samples[at];
                  if (values == nullptr) continue;
                  values->low[at] = own.low[at];
                  values->high[at] = own.high[at];
                  values->errors[at] = own.errors[at];
                }
                return true;
              }) {
    VolumeGrid grid;
    grid.dimensions = dimensions;
    grid.spacing = spacing;
    grid.type = type();
    preprocess<Sample>(
        grid,
        [&](std::uint64_t k, std::span<std::byte> plane) {
          std::memcpy(plane.data(), samples.data() + k * grid.plane_samples(), plane.size());
        },
        [this](const PageId& id, const Page<Word>& page) { pages_[tree_.grid().number(id)] = page; },
        {depth});
  }

  [[nodiscard]] const PageGrid& grid() const { return tree_.grid(); }
  [[nodiscard]] PageShape shape(const PageId& id) const {
    return {grid().count(id), grid().is_complete(id), id.lod};
  }
  /// With the points of coarser LODs.
  [[nodiscard]] Page<Word> page(const PageId& id) const {
    Page<Word> found{};
    tree_.copy(id, found);
    return found;
  }
  [[nodiscard]] Surroundings<Word> around(const PageId& id) const {
    Surroundings<Word> result{};
    tree_.surroundings(id, result);
    return result;
  }

 private:
  static LatticePoint point_at(std::size_t place) {
    const auto at = [place](int shift) { return static_cast<std::int32_t>(place >> shift & 15); };
    return {at(0), at(4), at(8)};
  }
  static constexpr SampleType type() {
    if constexpr (std::is_same_v<Sample, float>) return SampleType::kFloat32;
    if constexpr (std::is_same_v<Sample, std::int16_t>) return SampleType::kInt16;
    return sizeof(Sample) == 1 ? SampleType::kUint8 : SampleType::kUint16;
  }

  std::map<std::uint64_t, Page<Word>> pages_;
  mutable PageCache<Word> tree_;
};

}  // namespace adamas::test
