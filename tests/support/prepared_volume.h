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

using namespace isosurface;

/// A volume in memory and all that preprocessing finds of it, page by page.
template <class Sample>
class PreparedVolume {
 public:
  using Word = OrderedWord<Sample>;

  /// Prepares a volume whose `samples` have i running fastest.
  PreparedVolume(const std::array<std::uint64_t, 3>& dimensions, const std::vector<Sample>& samples,
                 Vec3 spacing = {1, 1, 1}, NoiseBounds noise = NoiseBounds::kOwn)
      : pages_(dimensions) {
    VolumeGrid grid;
    grid.dimensions = dimensions;
    grid.spacing = spacing;
    grid.type = type();
    preprocess<Sample>(
        grid,
        [&](std::uint64_t k, std::span<std::byte> plane) {
          std::memcpy(plane.data(), samples.data() + k * grid.plane_samples(), plane.size());
        },
        [this](const PageId& id, const Page<Word>& page) { pages_.own[pages_.grid().number(id)] = page; },
        SilentProgress::instance(), noise);
  }

  [[nodiscard]] const PageGrid& grid() const { return pages_.grid(); }
  [[nodiscard]] PageShape shape(const PageId& id) const {
    return {grid().count(id), grid().is_complete(id), id.lod};
  }
  /// Returns a page with the points that it shares with coarser LODs.
  [[nodiscard]] Page<Word> page(const PageId& id) const {
    Page<Word> found{};
    pages_.copy(id, found);
    return found;
  }
  [[nodiscard]] Surroundings<Word> around(const PageId& id) const {
    Surroundings<Word> result{};
    pages_.surroundings(id, result);
    return result;
  }

 private:
  /// All pages, completed from those that preprocessing gave.
  struct Pages : PageCache<Word> {
    std::map<std::uint64_t, Page<Word>> own;  ///< by number

    explicit Pages(const std::array<std::uint64_t, 3>& dimensions)
        : PageCache<Word>(PageGrid(dimensions), std::size_t{1} << 40) {}

   private:
    bool load(const PageToLoad<Word>& page) override {
      const Page<Word>& from = own.at(this->grid().number(page.id));
      for (std::size_t at = 0; at < PageGrid::kPoints; ++at) {
        if (!page.shape.owns(point_at(at))) continue;
        if (has_part(page.parts, PageParts::kSamples)) page.samples.samples[at] = from.samples[at];
        if (page.bounds == nullptr) continue;
        page.bounds->low[at] = from.low[at];
        page.bounds->high[at] = from.high[at];
        page.bounds->errors[at] = from.errors[at];
      }
      return true;
    }
  };

  static LatticePoint point_at(std::size_t place) {
    const auto at = [place](int shift) { return static_cast<std::int32_t>(place >> shift & 15); };
    return {at(0), at(4), at(8)};
  }
  static constexpr SampleType type() {
    if constexpr (std::is_same_v<Sample, float>) return SampleType::kFloat32;
    if constexpr (std::is_same_v<Sample, std::int16_t>) return SampleType::kInt16;
    return sizeof(Sample) == 1 ? SampleType::kUint8 : SampleType::kUint16;
  }

  mutable Pages pages_;
};

}  // namespace adamas::test
