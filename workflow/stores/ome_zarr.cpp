#include "workflow/stores/ome_zarr.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "adamas/file_names.h"
#include "adamas/files.h"
#include "adamas/series.h"
#include "adamas/steps.h"
#include "adamas/store_files.h"
#include "adamas/text.h"
#include "core/base/notes.h"
#include "core/data/stored_type.h"
#include "core/io/zarr_array.h"

namespace adamas {

namespace workflow {

using namespace io;
using namespace isosurface;
using namespace timevarying;

namespace {

/// A description in JSON, whose keys keep the order in which they were added.
using Json = nlohmann::ordered_json;

void write_json(const std::filesystem::path& path, const Json& json) {
  write_text(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

/// Returns the path without a slash at its end.
std::filesystem::path folder_path(const std::filesystem::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

/// Returns F of F.zarr and F.ome.zarr.
std::string zarr_name(const std::filesystem::path& path) {
  std::string name = file_stem(path);
  if (file_extension(name) == ".ome") name = file_stem(name);
  return visible_text(name);
}

/// Returns the time between steps, 1 for a single one, if all are evenly spaced but for round-off.
std::optional<double> time_scale(const std::vector<double>& times) {
  if (times.size() < 2) return 1;
  constexpr double kRoundOff = 1e-9;  // relative to the whole time
  const auto spacing = even_spacing(times, kRoundOff * static_cast<double>(times.size() - 1));
  return spacing && *spacing > 0 ? spacing : std::nullopt;
}

/// The time of the array's first index, and the time between indices.
struct TimeScale {
  double spacing = 1, first = 0;
};

Json transformations(const RestoredPart& part, const VolumeGrid& volume,
                     const std::optional<TimeScale>& time) {
  Json scale = Json::array(), translation = Json::array();
  if (time) {
    scale.push_back(time->spacing);
    translation.push_back(time->first);
  }
  for (const int axis : {2, 1, 0}) {
    scale.push_back(part.grid.spacing[axis]);
    translation.push_back(volume.origin[axis] + part.first[axis] * part.grid.spacing[axis]);
  }
  return {{{"type", "scale"}, {"scale", scale}}, {{"type", "translation"}, {"translation", translation}}};
}

/// The word that NGFF has for a unit of length; empty where it has none.
std::string ngff_unit(const std::string& unit) {
  constexpr std::array<std::pair<const char*, const char*>, 6> kWords{{{"m", "meter"},
                                                                       {"cm", "centimeter"},
                                                                       {"mm", "millimeter"},
                                                                       {"um", "micrometer"},
                                                                       {"nm", "nanometer"},
                                                                       {"km", "kilometer"}}};
  for (const auto& [name, word] : kWords) {
    if (unit == name || unit == word) return word;
  }
  return {};
}

Json axes(bool is_series, const std::string& length_unit) {
  Json all = Json::array();
  if (is_series) all.push_back({{"name", "t"}, {"type", "time"}});
  for (const char* name : {"z", "y", "x"}) {
    all.push_back({{"name", name}, {"type", "space"}});
    if (const std::string unit = ngff_unit(length_unit); !unit.empty()) all.back()["unit"] = unit;
  }
  return all;
}

/// Returns the properties that NGFF has no keys for.
Json own_attributes(const VolumeGrid& volume, const std::vector<double>& times) {
  Json directions = Json::array();
  for (const Vec3& direction : volume.directions)
    directions.push_back({direction.x, direction.y, direction.z});
  Json own{{"directions", directions}};
  if (!volume.space.empty()) own["space"] = volume.space;
  if (!volume.length_unit.empty()) own["length_unit"] = volume.length_unit;
  if (!volume.value_unit.empty()) own["value_unit"] = volume.value_unit;
  if (!times.empty()) own["times"] = times;
  return own;
}

}  // namespace

OmeZarr::OmeZarr(const std::filesystem::path& path, bool overwrite)
    : folder_(std::make_shared<OutputFolder>("an OME-Zarr image", folder_path(path), overwrite)) {}

void OmeZarr::write_attributes(const StoreFile& file, const ZarrContent& content, const StepNumbers& steps,
                               Progress& progress) const {
  const VolumeGrid& volume = file.header().grid;
  const std::string name = folder_->path().string();
  std::vector<double> times;
  std::optional<TimeScale> time;
  if (content.is_series) {
    const std::vector<double> all = file.times();
    for (const std::uint32_t step : steps) times.push_back(all[step]);
    const std::optional<double> spacing = time_scale(times);
    time = spacing ? TimeScale{*spacing, times.front()} : TimeScale{};
    if (!spacing)
      note(progress, "{}: the times of steps are uneven: its scale counts steps, .zattrs has the times",
           name);
  }
  if (!volume.is_straight())
    note(
        progress,
        "{}: axes do not run along x, y and z, which OME-Zarr has no words for: .zattrs has their directions",
        name);
  Json datasets = Json::array();
  for (std::size_t n = 0; n < content.levels.size(); ++n)
    datasets.push_back({{"path", std::to_string(n)},
                        {"coordinateTransformations", transformations(content.levels[n], volume, time)}});
  const Json multiscale{{"version", "0.4"},
                        {"name", zarr_name(folder_->path())},
                        {"axes", axes(content.is_series, volume.length_unit)},
                        {"datasets", datasets},
                        {"type", "nearest"}};
  write_json(folder_->file(".zgroup"), Json::object({{"zarr_format", 2}}));
  write_json(folder_->file(".zattrs"), Json::object({{"multiscales", Json::array({multiscale})},
                                                     {"adamas", own_attributes(volume, times)}}));
}

std::size_t OmeZarr::write_level(StoreFile& file, const ZarrContent& content, const StepNumbers& steps,
                                 std::size_t level, PageReads& counts, Progress& progress) const {
  const RestoredPart& part = content.levels[level];
  const StoredType numbers = file.header().numbers.type;
  std::optional<std::uint64_t> count;
  if (content.is_series) count = steps.size();
  // A first attempt that met damage may have left steps.
  std::filesystem::remove_all(folder_->file(std::to_string(level)));
  ZarrArray array(folder_->file(std::to_string(level)), part.grid,
                  part.grid.is_scaled() ? StoredType::kFloat32 : numbers, count);
  std::vector<float> values;
  const std::uint64_t bytes_each = array.slab_bytes() + restored_slab_bytes(part);
  std::uint64_t written = 0;
  for (const StepRange& some : restored_groups(steps, bytes_each, content.memory)) {
    std::vector<ZarrArray::Step> open;
    for (std::uint32_t step = some.first; step <= some.last; ++step) open.emplace_back(array, written++);
    const auto sink = [&](std::uint32_t step, std::span<const std::byte> plane) {
      if (part.grid.is_scaled()) {
        find_values(part.grid, numbers, plane, values);
        plane = std::as_bytes(std::span(values));
      }
      open[step - some.first].write_plane(plane);
    };
    counts += restore_numbers(file, some, part, content.memory, sink, progress);
  }
  return array.bytes();
}

RestoredSteps OmeZarr::write(StoreFile& file, const ZarrContent& content, PageReads& counts,
                             Progress& progress) {
  const VolumeGrid& volume = file.header().grid;
  if (volume.is_scaled())
    note(progress, "{}: values, {:.9g} times the samples plus {:.9g}, are written as float32",
         folder_->path().string(), volume.slope, volume.intercept);
  RestoredSteps steps;
  folder_->fill([&] {
    // The finest level needs all pages that the coarser levels need.
    const auto write_finest = [&](const StepNumbers& some) {
      counts = {};
      bytes_ = write_level(file, content, some, 0, counts, progress);
    };
    steps =
        restore_what_can_be(file, content.steps, content.levels[0], content.memory, write_finest, progress);
    for (std::size_t level = 1; level < content.levels.size(); ++level)
      bytes_ += write_level(file, content, steps.kept, level, counts, progress);
    write_attributes(file, content, steps.kept, progress);
  });
  return steps;
}

}  // namespace workflow

bool is_zarr(const std::filesystem::path& path) {
  return file_extension(workflow::folder_path(path)) == ".zarr";
}

}  // namespace adamas
