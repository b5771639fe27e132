#include "adamas/volume_store.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "core/base/naming.h"
#include "core/base/output_file.h"
#include "core/data/volume_placement.h"
#include "isosurface/extraction/complete_surface.h"
#include "isosurface/storage/restore.h"
#include "isosurface/storage/store_builder.h"
#include "isosurface/storage/stored_pages.h"

namespace adamas {

using namespace isosurface;

namespace {

/// Throws Error where an isovalue or an error is none.
void check_numbers(const IsosurfaceRequest& request) {
  if (!std::isfinite(request.isovalue)) fail("expected a finite isovalue, found {}", request.isovalue);
  if (!std::isfinite(request.error) || request.error < 0)
    fail("expected an isosurface error of at least 0, found {}", request.error);
}

/// The request in the grid's frame.
SurfaceRequest to_surface_request(const std::string& name, const VolumeGrid& grid,
                                  const IsosurfaceRequest& request) {
  check_numbers(request);
  SurfaceRequest result;
  result.isovalue = grid.sample(request.isovalue);
  result.error = request.error / grid.greatest_stretch();
  result.max_triangles = request.max_triangles;
  result.strict = request.strict;
  result.join = !request.plain;
  result.others_follow = true;
  if (request.region) set_region(result, grid, *request.region);
  check_surface_request(name, grid, result, request.region);
  return result;
}

}  // namespace

/// A store that is open, whatever the type of its samples.
class VolumeStore::Contents {
 public:
  Contents(std::unique_ptr<StoreFile> file, std::size_t memory) : file_(std::move(file)), memory_(memory) {}
  virtual ~Contents() = default;

  StoreFile& file() { return *file_; }
  [[nodiscard]] std::size_t memory() const { return memory_; }
  [[nodiscard]] const VolumeGrid& grid() const { return file_->header().grid; }

  virtual std::optional<std::array<double, 2>> range() = 0;
  virtual Isosurface isosurface(const IsosurfaceRequest& request, Progress& progress) = 0;

 private:
  std::unique_ptr<StoreFile> file_;
  std::size_t memory_;
};

template <class Sample>
class VolumeStore::ContentsOf final : public Contents {
 public:
  using Contents::Contents;

  std::optional<std::array<double, 2>> range() override {
    const auto found = sample_range<Sample>(open().pages);
    if (!found)
      fail_as(ErrorKind::kDamaged, "expected to find the range of the samples, found the directory damaged");
    const auto [low, high] = *found;
    if (low > high) return std::nullopt;
    return std::array{grid().value(low), grid().value(high)};
  }

  Isosurface isosurface(const IsosurfaceRequest& request, Progress& progress) override {
    const SurfaceRequest wanted = to_surface_request(file().name(), grid(), request);
    try {
      return extract(wanted, request, progress);
    } catch (...) {
      // What was half done is not for the next call.
      opened_.reset();
      throw;
    }
  }

 private:
  struct Opened {
    explicit Opened(Contents& of) : pages(of.file(), 0, of.memory()), extractor(pages) {}
    StoredPages<OrderedWord<Sample>> pages;
    SurfaceExtractor<Sample> extractor;
  };

  Opened& open() {
    if (!opened_) opened_ = std::make_unique<Opened>(*this);
    return *opened_;
  }

  Isosurface extract(const SurfaceRequest& wanted, const IsosurfaceRequest& request, Progress& progress) {
    auto [found, distance, own] =
        extract_complete(open().extractor, wanted, request.certify, request.normals, progress);
    Isosurface result;
    if (distance) result.distance = {distance->certified, distance->found};
    result.max_error = grid().greatest_stretch() * found.max_error;
    result.tetrahedra = found.tetrahedra;
    result.diamonds = found.diamonds;
    result.bodies_left_out = found.bodies_left_out;
    result.surface.normals = std::move(own.normals);
    for (const PageId& page : own.lost) {
      if (std::find(found.lost.begin(), found.lost.end(), page) == found.lost.end())
        found.lost.push_back(page);
    }
    result.damaged_pages = found.lost.size();
    result.surface.points = std::move(found.contour.points);
    result.surface.triangles = std::move(found.contour.triangles);
    place_in_space(grid(), result.surface);
    return result;
  }

  std::unique_ptr<Opened> opened_;  ///< none before anything is asked for
};

VolumeStore::VolumeStore(std::unique_ptr<Contents> contents) : contents_(std::move(contents)) {}
VolumeStore::VolumeStore(VolumeStore&&) noexcept = default;
VolumeStore& VolumeStore::operator=(VolumeStore&&) noexcept = default;
VolumeStore::~VolumeStore() = default;

VolumeStore VolumeStore::open(const std::filesystem::path& path, const OpenOptions& options) {
  auto file = std::make_unique<StoreFile>(path, options.mapped ? Paging::kMap : Paging::kRead);
  return with_sample_type(file->header().grid.type, [&](auto sample) {
    return VolumeStore(std::make_unique<ContentsOf<decltype(sample)>>(std::move(file), options.memory));
  });
}

void VolumeStore::build(const std::filesystem::path& path, const VolumeGrid& grid, const PlaneSource& planes,
                        const BuildOptions& options, Progress& progress) {
  grid.check(path.string());
  constexpr std::uint64_t kMost = (std::uint64_t{1} << PageGrid::kMaxDepth) + 1;
  for (const std::uint64_t n : grid.dimensions) {
    if (n > kMost) fail("{}: expected at most {} samples along each axis, found {}", path.string(), kMost, n);
  }
  StoreOptions how;
  how.coding = options.by_split_edges ? SampleCoding::kSplitEdge : SampleCoding::kInterpolation;
  how.gradients = options.gradients;
  if (!options.smooth_gradients) how.smoothing.reset();
  if (!options.scratch.empty()) how.scratch = options.scratch;
  OutputFile file(path);
  build_store(file.temporary(), path.string(), grid, planes, how, progress);
  file.commit();
}

void VolumeStore::build(const std::filesystem::path& path, const VolumeGrid& grid,
                        std::span<const std::byte> samples, const BuildOptions& options, Progress& progress) {
  grid.check(path.string());
  if (samples.size() != grid.bytes())
    fail("{}: expected {} bytes of samples, found {}", path.string(), grid.bytes(), samples.size());
  const std::size_t plane = grid.plane_bytes();
  const auto copy = [samples, plane](std::uint64_t k, std::span<std::byte> to) {
    std::memcpy(to.data(), samples.data() + k * plane, plane);
  };
  build(path, grid, copy, options, progress);
}

const VolumeGrid& VolumeStore::grid() const { return contents_->grid(); }

int VolumeStore::levels() const { return contents_->file().grid().top() + 1; }

std::uint64_t VolumeStore::file_bytes() const { return contents_->file().size(); }

std::optional<std::array<double, 2>> VolumeStore::range() {
  return naming(contents_->file().name(), [&] { return contents_->range(); });
}

Isosurface VolumeStore::isosurface(const IsosurfaceRequest& request, Progress& progress) {
  return naming(contents_->file().name(), [&] { return contents_->isosurface(request, progress); });
}

Volume VolumeStore::restore(const std::optional<Box3>& region, int level, Progress& progress) {
  std::optional<Box3> in_frame;
  if (region) in_frame = region_in_frame(grid(), *region).box;
  const std::string& name = contents_->file().name();
  const RestoredPart part = restored_part(grid(), level, in_frame, name);
  Volume volume{part.grid, {}};
  volume.samples.reserve(part.grid.bytes());
  const auto append = [&volume](std::span<const std::byte> plane) {
    volume.samples.insert(volume.samples.end(), plane.begin(), plane.end());
  };
  naming(name, [&] { isosurface::restore(contents_->file(), part, contents_->memory(), append, progress); });
  return volume;
}

}  // namespace adamas
