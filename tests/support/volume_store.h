#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <type_traits>
#include <vector>

#include "isosurface/extraction/surface_extractor.h"
#include "isosurface/storage/restore.h"
#include "isosurface/storage/store_options.h"
#include "isosurface/volume/samples.h"
#include "tests/support/build_store.h"
#include "tests/support/restored.h"
#include "tests/support/scratch.h"

namespace adamas::test {

using namespace isosurface;

using Dimensions = std::array<std::uint64_t, 3>;

template <class Sample>
constexpr SampleType type_of_samples() {
  if constexpr (std::is_same_v<Sample, std::uint8_t>) return SampleType::kUint8;
  if constexpr (std::is_same_v<Sample, std::uint16_t>) return SampleType::kUint16;
  if constexpr (std::is_same_v<Sample, std::int16_t>) return SampleType::kInt16;
  return SampleType::kFloat32;
}

/// A small volume, i running fastest.
template <class Sample>
struct MemoryVolume {
  VolumeGrid grid;
  std::vector<Sample> samples;

  /// Calls fn(p) for the sample at each point.
  template <class Fn>
  MemoryVolume(const Dimensions& dimensions, Fn&& fn, const Vec3& spacing = {1, 1, 1},
               const Vec3& origin = {}) {
    grid.dimensions = dimensions;
    grid.type = type_of_samples<Sample>();
    grid.spacing = spacing;
    grid.origin = origin;
    samples.reserve(grid.samples());
    const LatticePoint n = last() + LatticePoint{1, 1, 1};
    for (std::int32_t k = 0; k < n.k; ++k)
      for (std::int32_t j = 0; j < n.j; ++j)
        for (std::int32_t i = 0; i < n.i; ++i)
          samples.push_back(static_cast<Sample>(fn(LatticePoint{i, j, k})));
  }

  [[nodiscard]] LatticePoint last() const {
    const auto at = [this](std::size_t axis) { return static_cast<std::int32_t>(grid.dimensions[axis] - 1); };
    return {at(0), at(1), at(2)};
  }
  /// Returns the nearest sample.
  [[nodiscard]] Sample at(LatticePoint p) const {
    const LatticePoint end = last();
    const auto place = [&](int axis) { return static_cast<std::size_t>(std::clamp(p[axis], 0, end[axis])); };
    return samples[place(0) + grid.dimensions[0] * (place(1) + grid.dimensions[1] * place(2))];
  }
  [[nodiscard]] PlaneSource planes() const {
    return [this](std::uint64_t k, std::span<std::byte> to) {
      std::memcpy(to.data(), samples.data() + k * grid.plane_samples(), to.size());
    };
  }
};

template <class Sample>
StoreFigures build(const std::filesystem::path& path, const MemoryVolume<Sample>& volume,
                   const StoreOptions& options = {}) {
  return build_store(path, path.string(), volume.grid, volume.planes(), options);
}

/// Returns samples as bits, so that samples that are not numbers can be compared.
template <class Sample>
std::vector<OrderedWord<Sample>> bits_of(const std::vector<Sample>& samples) {
  std::vector<OrderedWord<Sample>> bits(samples.size());
  if (!samples.empty()) std::memcpy(bits.data(), samples.data(), samples.size() * sizeof(Sample));
  return bits;
}

/// Returns the bits of the samples that restore gives.
template <class Sample>
std::vector<OrderedWord<Sample>> restored(StoreFile& file, int lod = 0,
                                          const std::optional<Box3>& region = {},
                                          std::size_t memory = std::size_t{1} << 24) {
  const RestoredPart part = restored_part(file.header().grid, lod, region, file.name());
  std::vector<OrderedWord<Sample>> bits;
  restore(file, part, memory, [&](std::span<const std::byte> plane) {
    const std::size_t at = bits.size();
    bits.resize(at + plane.size() / sizeof(Sample));
    std::memcpy(bits.data() + at, plane.data(), plane.size());
  });
  return bits;
}

/// The store of a volume, opened for extraction.
template <class Sample>
class OpenStore {
 public:
  static constexpr std::size_t kMemory = std::size_t{1} << 26;

  explicit OpenStore(const MemoryVolume<Sample>& volume) : OpenStore() {
    build(path(), volume);
    open();
  }
  /// Makes no store; the test puts one at path().
  OpenStore() : folder_(std::make_unique<Scratch>()) {}

  [[nodiscard]] std::filesystem::path path() const { return *folder_ / "store.adm"; }
  void open(std::size_t memory = kMemory, Paging paging = Paging::kRead) {
    extractor_.reset();
    pages_.reset();
    file_ = std::make_unique<StoreFile>(path(), paging);
    pages_ = std::make_unique<StoredPages<OrderedWord<Sample>>>(*file_, 0, memory);
    extractor_ = std::make_unique<SurfaceExtractor<Sample>>(*pages_);
  }

  StoreFile& file() { return *file_; }
  StoredPages<OrderedWord<Sample>>& pages() { return *pages_; }
  SurfaceExtractor<Sample>& extractor() { return *extractor_; }
  ExtractedSurface extract(const SurfaceRequest& request) { return extractor_->extract(request); }
  ExtractedSurface extract(double isovalue, double error = 0) {
    SurfaceRequest request;
    request.isovalue = isovalue;
    request.error = error;
    return extract(request);
  }

 private:
  std::unique_ptr<Scratch> folder_;
  std::unique_ptr<StoreFile> file_;
  std::unique_ptr<StoredPages<OrderedWord<Sample>>> pages_;
  std::unique_ptr<SurfaceExtractor<Sample>> extractor_;
};

}  // namespace adamas::test
