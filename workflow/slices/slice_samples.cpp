#include "workflow/slices/slice_samples.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <utility>

#include "adamas/text.h"
#include "adamas/volume_output.h"
#include "core/base/error.h"
#include "core/base/notes.h"
#include "core/data/volume_placement.h"
#include "core/geometry/length_limits.h"
#include "core/io/array_names.h"
#include "core/io/input_file.h"
#include "core/io/multi_material_reader.h"
#include "core/io/volume_input.h"
#include "isosurface/volume/page_grid.h"
#include "isosurface/volume/samples.h"
#include "timevarying/api/open_store.h"
#include "timevarying/restore_steps.h"
#include "workflow/slices/slice_loading.h"

namespace adamas::workflow {

using namespace interfaces;
using namespace io;
using namespace isosurface;
using namespace timevarying;

namespace {

/// The limit of the samples that are read: four for each pixel of a large picture, or a cube of 256^3.
constexpr std::uint64_t kMostSamples = std::uint64_t{1} << 24;

/// Returns the part of the grid, in its frame, that the samples of an LOD next to the plane span.
Box3 layers_at(const VolumeGrid& grid, const Plane& plane, int lod) {
  const Box3 box = grid.frame_box();
  Box3 region, cut;
  for (const Vec3& p : clip_plane(plane, box)) cut.extend(p);
  for (int axis = 0; axis < 3; ++axis) {
    const double step = std::ldexp(grid.spacing[axis], lod);
    const double layers = std::floor((box.max[axis] - box.min[axis]) / step);
    // A plane at right angles to the axis meets it at a single coordinate.
    const bool across = plane.axis() == axis;
    const double low = ((across ? plane.origin[axis] : cut.min[axis]) - box.min[axis]) / step;
    const double high = ((across ? plane.origin[axis] : cut.max[axis]) - box.min[axis]) / step;
    const double below = std::clamp(std::floor(low), 0.0, std::max(0.0, layers - 1));
    const double above = std::clamp(std::ceil(high), below + 1, std::max(below + 1, layers));
    region.min[axis] = box.min[axis] + below * step;
    region.max[axis] = box.min[axis] + above * step;
  }
  return region;
}

/// Returns the samples of a part as the nodes of a grid in the frame of the whole volume.
RectilinearGrid nodes_of(const RestoredPart& part, const VolumeGrid& whole) {
  RectilinearGrid grid;
  grid.centering = Centering::kPoints;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double step = part.grid.spacing[axis], first = whole.origin[axis] + part.first[axis] * step;
    for (std::uint64_t n = 0; n < part.grid.dimensions[a]; ++n)
      grid.nodes[a].push_back(first + static_cast<double>(n) * step);
  }
  return grid;
}

/// Makes an input of the samples near a plane, whose planes `read` gives one after another. `volume`: the
/// grid of all samples.
SliceInput slab(const std::string& name, const VolumeGrid& volume, const Plane& plane,
                const std::function<void(const RestoredPart&, const PlaneSink&)>& read, Progress& progress) {
  check_volume_dimensions(name, volume);
  check_two_samples(name, volume);
  check_lengths(name, volume.frame_box());
  check_lengths(name, {volume.origin, volume.origin + volume.spacing});
  const Plane in_frame = plane_in_frame(volume, plane);
  if (clip_plane(in_frame, volume.frame_box()).empty())
    fail("{}: expected a plane that cuts {}, found {}", name, box_text(volume.box()), to_string(plane));
  RestoredPart part;
  for (int lod = 0; lod <= PageGrid(volume.dimensions).top(); ++lod) {
    part = restored_part(volume, lod, layers_at(volume, in_frame, lod), name);
    if (part.grid.samples() <= kMostSamples) break;
  }
  check_two_samples(name, part.grid);
  if (part.lod > 0) note(progress, "the section is of one sample in {} along each axis", 1 << part.lod);
  MultiMaterialData data;
  data.source = name;
  data.grid = nodes_of(part, volume);
  data.materials = IdVector<MaterialId, std::string>(1, kPlainMaterial);
  data.labels.assign(part.grid.samples(), 0);
  Field field;
  field.name = kSampleField;
  std::vector<float> values;
  values.reserve(part.grid.samples());
  with_sample_type(volume.type, [&](auto sample) {
    using Sample = decltype(sample);
    read(part, [&values, &volume](std::span<const std::byte> plane_bytes) {
      for (std::size_t at = 0; at < plane_bytes.size(); at += sizeof(Sample)) {
        Sample value;
        std::memcpy(&value, plane_bytes.data() + at, sizeof(Sample));
        values.push_back(static_cast<float>(volume.value(static_cast<double>(value))));
      }
    });
  });
  field.values = std::move(values);
  data.fields.push_back(std::move(field));
  SliceInput result;
  result.name = name;
  result.data = std::make_unique<MultiMaterialData>(std::move(data));
  if (!volume.is_straight()) result.turned = volume;
  return result;
}

/// Passes on the planes of a part of a volume, of which `plane_of` gives whole planes.
void read_part(const VolumeGrid& volume,
               const std::function<std::span<const std::byte>(std::uint64_t)>& plane_of,
               const RestoredPart& part, const PlaneSink& sink, Progress& progress) {
  const std::size_t width = sample_bytes(volume.type);
  std::vector<std::byte> some(part.grid.plane_bytes());
  const auto& n = part.grid.dimensions;
  const auto whole = [&part](std::int32_t first, std::uint64_t i) {
    return (static_cast<std::uint64_t>(first) + i) << part.lod;
  };
  for (std::uint64_t k = 0; k < n[2]; ++k) {
    progress.step("reading", static_cast<double>(k) / static_cast<double>(n[2]));
    const std::span<const std::byte> plane = plane_of(whole(part.first.k, k));
    std::byte* to = some.data();
    for (std::uint64_t j = 0; j < n[1]; ++j) {
      const std::uint64_t row = whole(part.first.j, j) * volume.dimensions[0];
      for (std::uint64_t i = 0; i < n[0]; ++i, to += width)
        std::memcpy(to, plane.data() + (row + whole(part.first.i, i)) * width, width);
    }
    sink(some);
  }
}

/// Reads the samples of a store's step near a plane.
SliceInput load_store_samples(const SliceRequest& request, OutputSet& outputs, Progress& progress) {
  const std::string path = request.input.path.string();
  outputs.protect(path);
  const OpenOptions options;
  const std::unique_ptr<StoreFile> file = open_store_file(path, options);
  return store_samples(*file, wanted_step(request.step, *file, progress), options.memory, request.plane,
                       progress);
}

/// Reads the samples of a volume near a plane.
SliceInput load_volume_samples(VolumeReader reader, const Plane& plane, Progress& progress) {
  const VolumeGrid& grid = reader.grid();
  std::vector<std::byte> bytes(grid.plane_bytes());
  const auto plane_of = [&](std::uint64_t k) {
    reader.read_plane(k, bytes);
    return std::span<const std::byte>(bytes);
  };
  const auto read = [&](const RestoredPart& part, const PlaneSink& sink) {
    read_part(grid, plane_of, part, sink, progress);
  };
  SliceInput result = slab(reader.source().name, grid, plane, read, progress);
  note_reading(reader, progress);
  return result;
}

}  // namespace

SampleOrigin sample_origin(const SliceRequest& request) {
  const std::string path = request.input.path.string();
  const std::string of_volume = request.volume.option();
  std::string option = grid_option(request, true);
  if (option.empty() || option == "--field")
    option = request.input.surfaces.empty() ? request.input.interface_option() : "--interface";
  const bool about_grid = !option.empty();
  if (is_store(path)) {
    if (!request.original.empty())
      wrong_usage("--original: expected a resampled mesh (.vtu) as INPUT, found {}", path);
    if (about_grid) wrong_usage("{}: expected data with materials as INPUT, found {}", option, path);
    if (!of_volume.empty()) {
      wrong_usage("{}: expected a {} as INPUT, found {}{}", of_volume,
                  of_volume == "--time" ? "file with several times" : "volume", path,
                  of_volume == "--time" ? ": --step says which step of a store" : "");
    }
    return SampleOrigin::kStore;
  }
  if (!of_volume.empty()) {
    if (!request.original.empty()) wrong_usage("{} and --original: expected one of them", of_volume);
    if (about_grid) wrong_usage("{} and {}: expected one of them", of_volume, option);
    if (path.empty()) wrong_usage("{}: expected a volume as INPUT, found none", of_volume);
    return SampleOrigin::kVolume;
  }
  if (about_grid || !request.original.empty() || input_kind(path) != InputKind::kGrid ||
      fraction_material(file_stem(path))) {
    return SampleOrigin::kNone;
  }
  const bool samples = has_one_array(path) || is_aslant_image(path);
  return samples ? SampleOrigin::kVolume : SampleOrigin::kNone;
}

SliceInput store_samples(StoreFile& file, std::uint32_t step, std::size_t memory, const Plane& plane,
                         Progress& progress) {
  const auto read = [&](const RestoredPart& part, const PlaneSink& sink) {
    restore_step(file, step, part, memory, sink, progress);
  };
  SliceInput result = slab(file.name(), file.header().grid, plane, read, progress);
  if (file.steps() > 1) result.step = StepOfSeries{file.times()[step], step};
  return result;
}

SliceInput volume_samples(const std::string& name, const Volume& volume, const Plane& plane,
                          Progress& progress) {
  const std::size_t bytes = volume.grid.plane_bytes();
  const auto plane_of = [&](std::uint64_t k) { return std::span(volume.samples).subspan(k * bytes, bytes); };
  const auto read = [&](const RestoredPart& part, const PlaneSink& sink) {
    read_part(volume.grid, plane_of, part, sink, progress);
  };
  return slab(name, volume.grid, plane, read, progress);
}

SliceInput load_samples(const SliceRequest& request, SampleOrigin origin, std::string& field,
                        const std::function<void(const SliceInput&)>& check, OutputSet& outputs,
                        Progress& progress) {
  VolumeInput volume = request.volume;
  volume.path = request.input.path.string();
  if (origin == SampleOrigin::kVolume && volume.array.empty() && is_aslant_image(volume.path)) {
    volume.array = std::exchange(field, {});
  }
  SliceInput result =
      origin == SampleOrigin::kStore
          ? load_store_samples(request, outputs, progress)
          : load_volume_samples(open_volume_input(volume, outputs, progress), request.plane, progress);
  result.name = request.input.path.string();
  result.sample_name = volume.array;
  check(result);
  return result;
}

}  // namespace adamas::workflow
