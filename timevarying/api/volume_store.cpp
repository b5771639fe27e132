#include "adamas/volume_store.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "adamas/text.h"
#include "core/base/naming.h"
#include "core/base/notes.h"
#include "core/base/output_file.h"
#include "core/data/stored_type.h"
#include "core/data/volume_placement.h"
#include "isosurface/extraction/complete_surface.h"
#include "isosurface/storage/number_remainders.h"
#include "isosurface/storage/restore.h"
#include "isosurface/storage/store_options.h"
#include "isosurface/storage/stored_pages.h"
#include "isosurface/volume/page_grid.h"
#include "timevarying/api/build_options.h"
#include "timevarying/api/open_store.h"
#include "timevarying/api/surface_options.h"
#include "timevarying/restore_steps.h"
#include "timevarying/series_builder.h"
#include "timevarying/step_pages.h"
#include "timevarying/verify_store.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

/// Converts the request to the grid's frame.
SurfaceRequest to_surface_request(const std::string& name, const VolumeGrid& grid,
                                  const IsosurfaceRequest& request) {
  SurfaceRequest result;
  result.isovalue = grid.sample(request.isovalue);
  result.error = surface_error(request.error, grid) / grid.greatest_stretch();
  result.max_triangles = request.max_triangles;
  result.strict = request.strict;
  result.join = !request.plain;
  result.others_follow = true;
  if (request.region) set_region(result, grid, *request.region);
  check_surface_request(name, grid, result, request.region);
  return result;
}

/// The reason why there is no triangle. `range`: least and greatest sample; unknown if the first one is
/// greater.
std::string reason_for_none(const SurfaceRequest& request, const VolumeGrid& grid,
                            const std::array<double, 2>& range) {
  if (range[0] > range[1]) return "no sample is a finite number";
  if (request.isovalue <= range[0] || request.isovalue > range[1])
    return fmt::format("samples are from {:.6g} to {:.6g}", grid.value(range[0]), grid.value(range[1]));
  if (request.max_triangles) return "so few triangles do not show it";
  const std::string where = request.region ? "nothing of it is in the region" : "";
  if (request.error == 0) return where;
  return (where.empty() ? "" : where + ", or ") + "it is smaller than the error";
}

/// Notes what is missing from a surface, whose points and errors are in the grid's frame. `range`: see
/// reason_for_none.
void note_surface(const SurfaceRequest& request, const CompleteSurface& complete, const VolumeGrid& grid,
                  const std::array<double, 2>& range, Progress& progress) {
  const ExtractedSurface& surface = complete.surface;
  const double isovalue = grid.value(request.isovalue), wanted = grid.greatest_stretch() * request.error;
  if (complete.distance && wanted > 0 && complete.distance->certified > wanted) {
    note(progress,
         "the surface at isovalue {:.6g} is certified to be within {:.4g} of that of all samples, not {:.4g}",
         isovalue, complete.distance->certified, wanted);
  }
  if (surface.contour.triangles.empty()) {
    const std::string reason = reason_for_none(request, grid, range);
    note(progress, "no surface at isovalue {:.6g}{}{}", isovalue, reason.empty() ? "" : ": ", reason);
  } else if (surface.max_error > request.error && surface.lost.empty() &&
             (!request.max_triangles || request.error > 0)) {
    note(progress, "the error wanted was not reached{}: {:.4g} instead of {:.4g}",
         request.max_triangles ? " with so few triangles" : "", grid.greatest_stretch() * surface.max_error,
         wanted);
  }
  if (surface.bodies_left_out > 0) {
    note(progress, "with so few triangles {} small bod{} of the surface at isovalue {:.6g} {} left out",
         surface.bodies_left_out, surface.bodies_left_out == 1 ? "y" : "ies", isovalue,
         surface.bodies_left_out == 1 ? "is" : "are");
  }
  if (!surface.lost.empty()) {
    progress.note(NoteKind::kIncomplete, fmt::format("{}: the surface at isovalue {:.6g} is coarser there",
                                                     counted(surface.lost.size(), "damaged page"), isovalue));
  }
}

/// Notes the pages without which normals are less exact, except those that the surface itself lacks; returns
/// how many there are.
std::size_t note_normals(const CompleteSurface& complete, double isovalue, Progress& progress) {
  const std::vector<PageId>& lost = complete.surface.lost;
  const auto count =
      static_cast<std::size_t>(std::ranges::count_if(complete.normals.lost, [&lost](const PageId& page) {
        return std::ranges::find(lost, page) == lost.end();
      }));
  if (count > 0)
    progress.note(NoteKind::kIncomplete,
                  fmt::format("{}: normals of the surface at isovalue {:.6g} are less exact there",
                              counted(count, "damaged page"), isovalue));
  return count;
}

/// Appends the surface of one isovalue to those of the isovalues before.
void append_surface(CompleteSurface complete, double isovalue, TriangleSurface& surface) {
  Contour& contour = complete.surface.contour;
  std::vector<Vec3>& normals = complete.normals.normals;
  const auto first = surface.points.size();
  if (first + contour.points.size() > ~std::uint32_t{0})
    fail("the surfaces have more than 2^32 - 1 points: choose fewer isovalues or a greater error");
  if (first == 0) {
    surface.points = std::move(contour.points);
    surface.normals = std::move(normals);
    surface.triangles = std::move(contour.triangles);
  } else {
    surface.points.insert(surface.points.end(), contour.points.begin(), contour.points.end());
    surface.normals.insert(surface.normals.end(), normals.begin(), normals.end());
    for (auto triangle : contour.triangles) {
      for (std::uint32_t& p : triangle) p += static_cast<std::uint32_t>(first);
      surface.triangles.push_back(triangle);
    }
  }
  surface.values.resize(surface.points.size(), static_cast<float>(isovalue));
}

/// Throws Error if there are no times, or if they do not ascend.
void check_times(const std::string& name, const std::vector<double>& times) {
  if (times.empty()) fail("{}: expected at least one step, found none", name);
  if (times.size() > kMostSteps)
    fail("{}: expected at most {} steps, found {}", name, kMostSteps, times.size());
  for (std::size_t n = 0; n < times.size(); ++n) {
    if (!std::isfinite(times[n]) || (n > 0 && !(times[n - 1] < times[n])))
      fail("{}: expected finite times that ascend, found {} for step {}", name, times[n], n);
  }
}

/// Throws Error if numbers do not have the samples that the grid says, or cannot be asked for.
void check_numbers(const std::string& name, const SeriesSource& series) {
  if (!series.numbers) return;
  if (sample_type_for(*series.numbers) != series.grid.type)
    fail("{}: expected samples of type {} for numbers of type {}, found {}", name,
         sample_name(sample_type_for(*series.numbers)), to_string(*series.numbers),
         sample_name(series.grid.type));
  if (has_remainders(*series.numbers) && !series.number_planes)
    fail("{}: expected a function for planes of numbers of type {}, found none", name,
         to_string(*series.numbers));
}

StoreFacts::Coding coding_of(SampleCoding coding, bool is_plain) {
  using Coding = StoreFacts::Coding;
  if (coding == SampleCoding::kRanks) return Coding::kRanks;
  if (coding == SampleCoding::kInterpolation) return Coding::kInterpolation;
  return is_plain ? Coding::kNone : Coding::kSplitEdge;
}

}  // namespace

/// An open store, for any type of samples.
class VolumeStore::Contents {
 public:
  Contents(std::unique_ptr<StoreFile> file, std::size_t memory) : file_(std::move(file)), memory_(memory) {}
  virtual ~Contents() = default;

  StoreFile& file() { return *file_; }
  [[nodiscard]] std::size_t memory() const { return memory_; }
  [[nodiscard]] const std::string& name() const { return file_->name(); }
  [[nodiscard]] const VolumeGrid& grid() const { return file_->header().grid; }
  [[nodiscard]] RestoredPart part(const VolumePart& wanted) const {
    std::optional<Box3> in_frame;
    if (wanted.region) in_frame = region_in_frame(grid(), *wanted.region).box;
    return restored_part(grid(), wanted.lod, in_frame, name());
  }
  void check(const StepRange& steps) const { check_steps(steps, file_->steps(), name()); }

  /// The least and the greatest sample of all steps, the first one greater if there is none; empty if the
  /// part of the file that states them is damaged.
  virtual std::optional<std::array<double, 2>> sample_range() = 0;
  virtual Isosurface isosurfaces(std::span<const double> isovalues, const IsosurfaceRequest& request,
                                 bool others_follow, Progress& progress) = 0;

 private:
  std::unique_ptr<StoreFile> file_;
  std::size_t memory_;
};

template <class Sample>
class VolumeStore::ContentsOf final : public Contents {
 public:
  using Contents::Contents;

  std::optional<std::array<double, 2>> sample_range() override {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::uint32_t step = 0; step < file().steps(); ++step) {
      SeriesPages<OrderedWord<Sample>> pages(file(), step, 0);
      const auto found = isosurface::sample_range<Sample>(pages);
      if (!found) return std::nullopt;
      low = std::min(low, (*found)[0]);
      high = std::max(high, (*found)[1]);
    }
    return std::array{low, high};
  }

  Isosurface isosurfaces(std::span<const double> isovalues, const IsosurfaceRequest& request,
                         bool others_follow, Progress& progress) override {
    check_isovalues(isovalues);
    std::vector<SurfaceRequest> wanted;
    for (const double isovalue : isovalues) {
      IsosurfaceRequest each = request;
      each.isovalue = isovalue;
      wanted.push_back(to_surface_request(name(), grid(), each));
    }
    if (!wanted.empty()) wanted.back().others_follow = others_follow;
    const std::uint32_t step = wanted_step(request.step, file(), progress);
    try {
      return extract(isovalues, wanted, request, step, progress);
    } catch (...) {
      // The next call must not continue what failed halfway.
      opened_.reset();
      throw;
    }
  }

 private:
  struct Opened {
    Opened(Contents& store, std::uint32_t step)
        : pages(store.file(), step, store.memory()), extractor(pages) {}
    SeriesPages<OrderedWord<Sample>> pages;
    SurfaceExtractor<Sample> extractor;
  };

  Opened& open(std::uint32_t step) {
    if (!opened_ || opened_->pages.step() != step) {
      opened_.reset();
      opened_ = std::make_unique<Opened>(*this, step);
    }
    return *opened_;
  }

  Isosurface extract(std::span<const double> isovalues, const std::vector<SurfaceRequest>& wanted,
                     const IsosurfaceRequest& request, std::uint32_t step, Progress& progress) {
    Isosurface result;
    Opened& opened = open(step);
    for (std::size_t n = 0; n < wanted.size(); ++n) {
      const SurfaceRequest& each = wanted[n];
      CompleteSurface found = naming(name(), [&] {
        return extract_complete(opened.extractor, each, request.certify, request.normals, progress);
      });
      add(found, each, opened.extractor.range(), result, progress);
      append_surface(std::move(found), isovalues[n], result.surface);
      result.ends.push_back(result.surface.triangles.size());
    }
    place_in_space(grid(), result.surface);
    result.reads = opened.pages.counts();
    return result;
  }

  void add(const CompleteSurface& found, const SurfaceRequest& request, const std::array<double, 2>& range,
           Isosurface& result, Progress& progress) const {
    if (found.distance) {
      if (!result.distance) result.distance = Isosurface::Distance{};
      result.distance->certified = std::max(result.distance->certified, found.distance->certified);
      result.distance->found = std::max(result.distance->found, found.distance->found);
    }
    const ExtractedSurface& surface = found.surface;
    result.max_error = std::max(result.max_error, grid().greatest_stretch() * surface.max_error);
    result.tetrahedra += surface.tetrahedra;
    result.diamonds += surface.diamonds;
    result.bodies_left_out += surface.bodies_left_out;
    result.damaged_pages += surface.lost.size();
    note_surface(request, found, grid(), range, progress);
    result.damaged_pages += note_normals(found, grid().value(request.isovalue), progress);
  }

  std::unique_ptr<Opened> opened_;  ///< null before the first request
};

VolumeStore::VolumeStore(std::unique_ptr<Contents> contents) : contents_(std::move(contents)) {}
VolumeStore::VolumeStore(VolumeStore&&) noexcept = default;
VolumeStore& VolumeStore::operator=(VolumeStore&&) noexcept = default;
VolumeStore::~VolumeStore() = default;

VolumeStore VolumeStore::open(const std::filesystem::path& path, const OpenOptions& options) {
  auto file = open_store_file(path, options);
  return with_sample_type(file->header().grid.type, [&](auto sample) {
    return VolumeStore(std::make_unique<ContentsOf<decltype(sample)>>(std::move(file), options.memory));
  });
}

BuildReport VolumeStore::build(const std::filesystem::path& path, const SeriesSource& series,
                               const BuildOptions& options, Progress& progress) {
  const std::string name = path.string();
  series.grid.check(name);
  check_volume_dimensions(name, series.grid);
  check_times(name, series.times);
  check_numbers(name, series);
  const StoreOptions how = store_options(options);
  OutputFile file(path);
  const StoreFigures figures = build_series(file.temporary(), name, series, how, progress);
  file.commit();
  return build_report(figures);
}

BuildReport VolumeStore::build(const std::filesystem::path& path, const VolumeGrid& grid,
                               const PlaneSource& planes, const BuildOptions& options, Progress& progress) {
  return build(path, {grid, {0}, [&planes](std::uint32_t) { return planes; }}, options, progress);
}

BuildReport VolumeStore::build(const std::filesystem::path& path, const VolumeGrid& grid,
                               std::span<const std::byte> samples, const BuildOptions& options,
                               Progress& progress) {
  grid.check(path.string());
  if (samples.size() != grid.bytes())
    fail("{}: expected {} bytes of samples, found {}", path.string(), grid.bytes(), samples.size());
  const std::size_t plane = grid.plane_bytes();
  const auto copy = [samples, plane](std::uint64_t k, std::span<std::byte> to) {
    std::memcpy(to.data(), samples.data() + k * plane, plane);
  };
  return build(path, grid, copy, options, progress);
}

BuildReport VolumeStore::append(const std::filesystem::path& path, const SeriesSource& series,
                                const BuildOptions& options, Progress& progress) {
  const std::string name = path.string();
  check_times(name, series.times);
  check_numbers(name, series);
  const StoreOptions how = store_options(options);
  const StoreLock lock(path);
  check_options_of_store(options, StoreFile(path).header(), name);
  return build_report(append_series(lock, series, how, progress));
}

const VolumeGrid& VolumeStore::grid() const { return contents_->grid(); }

StoredType VolumeStore::number_type() const { return contents_->file().header().numbers.type; }

const std::string& VolumeStore::array() const { return contents_->file().header().numbers.array; }

std::uint32_t VolumeStore::steps() const { return contents_->file().steps(); }

std::vector<double> VolumeStore::times() const { return contents_->file().times(); }

int VolumeStore::lods() const { return contents_->file().grid().top() + 1; }

std::uint64_t VolumeStore::file_bytes() const { return contents_->file().size(); }

StoreFacts VolumeStore::facts() const {
  const StoreFile& file = contents_->file();
  const StoreHeader& header = file.header();
  const StoreBytes bytes = file.bytes();
  StoreFacts facts;
  facts.coding = coding_of(header.coding, bytes.samples >= header.grid.bytes() * file.steps());
  facts.gradients = header.gradients;
  facts.pages = file.grid().page_count();
  facts.blocks = file.blocks();
  facts.group_pages = header.group_pages;
  facts.number_bytes = header.grid.samples() * stored_bytes(header.numbers.type) * file.steps();
  facts.bytes = {bytes.samples, bytes.bounds, bytes.gradients, bytes.remainders};
  facts.file_bytes = file.size();
  facts.unfinished_bytes = file.unfinished_bytes();
  return facts;
}

bool VolumeStore::has_range() {
  return naming(contents_->name(), [&] { return contents_->sample_range().has_value(); });
}

std::optional<std::array<double, 2>> VolumeStore::range() {
  return naming(contents_->name(), [&]() -> std::optional<std::array<double, 2>> {
    const auto found = contents_->sample_range();
    if (!found)
      fail_as(ErrorKind::kDamaged, "expected to find the range of the samples, found the directory damaged");
    const auto [low, high] = *found;
    if (low > high) return std::nullopt;
    return std::array{grid().value(low), grid().value(high)};
  });
}

Isosurface VolumeStore::isosurface(const IsosurfaceRequest& request, Progress& progress) {
  return naming(contents_->name(), [&] {
    Isosurface result = contents_->isosurfaces(std::span(&request.isovalue, 1), request, true, progress);
    result.surface.values.clear();
    return result;
  });
}

Isosurface VolumeStore::isosurfaces(std::span<const double> isovalues, const IsosurfaceRequest& request,
                                    Progress& progress) {
  Isosurface result = contents_->isosurfaces(isovalues, request, false, progress);
  result.surface.value_name = "isovalue";
  return result;
}

Volume VolumeStore::restore(const VolumePart& part, const std::optional<std::uint64_t>& step,
                            Progress& progress) {
  const std::uint32_t number = wanted_step(step, contents_->file(), progress);
  Volume volume{part_grid(part), {}};
  volume.samples.reserve(volume.grid.bytes());
  const auto append = [&volume](std::uint32_t, std::span<const std::byte> plane) {
    volume.samples.insert(volume.samples.end(), plane.begin(), plane.end());
  };
  restore_steps({number, number}, part, append, progress);
  return volume;
}

std::vector<Vec3> VolumeStore::gradients(const VolumePart& part, const std::optional<std::uint64_t>& step,
                                         Progress& progress) {
  const std::uint32_t number = wanted_step(step, contents_->file(), progress);
  const RestoredPart wanted = contents_->part(part);
  std::vector<Vec3> directions;
  StoredGradients stored(contents_->file(), number, contents_->memory());
  directions.reserve(wanted.grid.samples());
  for (std::int32_t k = wanted.first.k; k <= wanted.last.k; ++k) {
    progress.step("reading gradients",
                  static_cast<double>(k - wanted.first.k) / static_cast<double>(wanted.grid.dimensions[2]));
    for (std::int32_t j = wanted.first.j; j <= wanted.last.j; ++j) {
      for (std::int32_t i = wanted.first.i; i <= wanted.last.i; ++i) {
        const auto direction = stored.direction({i << wanted.lod, j << wanted.lod, k << wanted.lod});
        if (!direction)
          throw Error(fmt::format("{}: {} is damaged", contents_->name(), page_name(stored.last_damaged())),
                      ErrorKind::kDamaged);
        directions.push_back(*direction);
      }
    }
  }
  return directions;
}

StoreFile& timevarying::StoreAccess::file(VolumeStore& store) { return store.contents_->file(); }
std::size_t timevarying::StoreAccess::memory(VolumeStore& store) { return store.contents_->memory(); }

VolumeGrid VolumeStore::part_grid(const VolumePart& part) const { return contents_->part(part).grid; }

PageReads VolumeStore::restore_steps(const StepRange& steps, const VolumePart& part, const StepSink& sink,
                                     Progress& progress) {
  contents_->check(steps);
  const RestoredPart restored = contents_->part(part);
  return naming(contents_->name(), [&] {
    return timevarying::restore_steps(contents_->file(), steps, restored, contents_->memory(), sink,
                                      progress);
  });
}

PageReads VolumeStore::restore_numbers(const StepRange& steps, const VolumePart& part, const StepSink& sink,
                                       Progress& progress) {
  contents_->check(steps);
  const RestoredPart restored = contents_->part(part);
  return naming(contents_->name(), [&] {
    return timevarying::restore_numbers(contents_->file(), steps, restored, contents_->memory(), sink,
                                        progress);
  });
}

std::vector<std::uint32_t> VolumeStore::damaged_steps(const StepRange& steps, const VolumePart& part,
                                                      Progress& progress) {
  contents_->check(steps);
  const RestoredPart restored = contents_->part(part);
  return naming(contents_->name(), [&] {
    return timevarying::damaged_steps(contents_->file(), steps, restored, contents_->memory(), progress);
  });
}

VerifiedStore VolumeStore::verify(Progress& progress) {
  return verify_store(contents_->file(), contents_->memory(), progress);
}

}  // namespace adamas
