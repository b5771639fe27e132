#include "core/io/volume_input.h"

#include <span>
#include <utility>

#include "adamas/file_names.h"
#include "adamas/series.h"
#include "core/base/error.h"
#include "core/io/grid_axes.h"
#include "core/io/input_formats.h"
#include "core/io/volume_stack.h"

namespace adamas {

std::string RawOptions::option() const {
  if (dimensions) return "--dimensions";
  if (type) return "--type";
  if (spacing) return "--spacing";
  if (origin) return "--first-sample";
  if (big_endian) return "--endian";
  return header_bytes ? "--header-bytes" : "";
}

std::string VolumeInput::option() const {
  if (stack) return "--stack";
  if (!array.empty()) return "--array";
  if (const std::string option = raw.option(); !option.empty()) return option;
  if (time) return "--time";
  return scratch.empty() ? "" : "--scratch";
}

std::optional<RawVolume> raw_volume(const RawOptions& options) {
  if (!options.dimensions) {
    if (options.type) wrong_usage("--type: expected --dimensions as well");
    if (options.big_endian) wrong_usage("--endian: expected --dimensions as well");
    if (options.header_bytes) wrong_usage("--header-bytes: expected --dimensions as well");
    return {};
  }
  if (!options.type) wrong_usage("--dimensions: expected --type as well");
  RawVolume raw;
  raw.dimensions = *options.dimensions;
  raw.type = *options.type;
  raw.big_endian = options.big_endian.value_or(false);
  raw.header_bytes = options.header_bytes.value_or(0);
  raw.spacing = options.spacing.value_or(raw.spacing);
  raw.origin = options.origin.value_or(raw.origin);
  return raw;
}

namespace io {

namespace {

/// Throws Error (kUsage) if values contradict each other.
void check_volume_input(const VolumeInput& input, bool is_raw) {
  if (!is_raw && !input.stack) {
    if (input.raw.spacing) wrong_usage("--spacing: expected --dimensions or --stack as well");
    if (input.raw.origin) wrong_usage("--first-sample: expected --dimensions or --stack as well");
  }
  if ((is_raw || input.stack) && !input.array.empty())
    wrong_usage("--array: expected a file with several arrays, not {}", is_raw ? "--dimensions" : "--stack");
  if ((is_raw || input.stack) && input.time)
    wrong_usage("--time: expected a file with several times, not {}", is_raw ? "--dimensions" : "--stack");
  if (is_raw && input.stack) wrong_usage("--stack and --dimensions: expected one of them");
}

/// Throws Error (kUsage) if an array is named, but files of this format have only one.
void check_array(const VolumeInput& input) {
  if (input.array.empty() || find_volume_format(input.path).several_arrays) return;
  wrong_usage("--array: expected a file that may have several arrays, found {}", input.path);
}

}  // namespace

VolumeReader open_volume_input(const VolumeInput& input, OutputSet& outputs, Progress& progress,
                               bool keep_scale) {
  const std::optional<RawVolume> raw = raw_volume(input.raw);
  check_volume_input(input, raw.has_value());
  outputs.protect(input.path);
  outputs.protect_other(input.scratch);
  if (raw) return open_raw_volume(input.path, *raw);
  if (input.stack) {
    const auto files = match_stack(input.path);
    for (const auto& file : files) outputs.protect(file);
    return open_volume_stack(files, input.raw.spacing.value_or(Vec3{1, 1, 1}),
                             input.raw.origin.value_or(Vec3{}), {{}, input.scratch, {}}, progress);
  }
  check_array(input);
  return open_volume(input.path, {input.array, input.scratch, input.time, keep_scale, input.all_times},
                     progress);
}

Volume read_whole(VolumeReader reader, const std::string& name, Progress& progress) {
  Volume volume{reader.grid(), {}};
  volume.grid.check(name);
  volume.samples.resize(volume.grid.bytes());
  const std::size_t plane = volume.grid.plane_bytes();
  for (std::uint64_t k = 0; k < volume.grid.dimensions[2]; ++k) {
    progress.check();
    reader.read_plane(k, std::span(volume.samples).subspan(k * plane, plane));
  }
  return volume;
}

bool has_one_array(const std::string& path) {
  const InputFormat* format = find_format_by_name(path);
  if (format == nullptr || !format->gives_volumes()) return false;
  // A data set of HDF5 is always a volume, and so is a NIfTI, whatever its header says.
  if (!format->gives_grids() || (format->several_times && format->is_folder == nullptr)) return true;
  if (format->several_arrays || format->read_header == nullptr) return false;
  return format->read_header(path).arrays.front().source.components == 1;
}

bool is_aslant_image(const std::string& path) {
  const InputFormat* format = find_format_by_name(path);
  if (format == nullptr || format->read_header == nullptr || !format->several_arrays) return false;
  try {
    return !are_parallel(format->read_header(path).axes);
  } catch (const Error&) {
    // The reader of grids may know the file, or has a better message.
    return false;
  }
}

}  // namespace io

using namespace io;

namespace {

/// Returns the group of a data set, without slashes round it; "/" for the root.
std::string group_of(const std::string& set) {
  const std::size_t end = set.find_last_not_of('/', set.rfind('/')), begin = set.find_first_not_of('/');
  const bool is_root = end == std::string::npos || set.rfind('/') == std::string::npos || begin > end;
  return is_root ? "/" : set.substr(begin, end + 1 - begin);
}

/// Returns the series in a file; no steps if it is none, or if one of its volumes is named.
VolumeInputSteps steps_of_file(const VolumeInput& options) {
  if (options.time || options.raw.dimensions) return {};
  const VolumeSeries series = find_volume_series(options.path, options.array);
  VolumeInputSteps result{{}, series.times, series.remark};
  const auto unpacked = std::make_shared<UnpackedTimes>();
  for (const VolumeStep& step : series.steps) {
    VolumeInputStep input{step.time, options.path, options};
    input.input.all_times = unpacked;
    input.input.array = step.array;
    if (!step.array.empty()) input.name += ": " + step.array;
    if (!step.array.empty() && !step.number) input.group = group_of(step.array);
    if (step.number) {
      input.input.time = *step.number;
      input.name += ": time " + std::to_string(*step.number);
    }
    result.steps.push_back(std::move(input));
  }
  return result;
}

}  // namespace

std::string volume_endings() { return list_volume_endings("or"); }

std::string grid_endings() { return list_grid_endings(","); }

std::string mesh_endings() { return io::list_mesh_endings("and"); }

Volume read_volume(const VolumeInput& input, Progress& progress) {
  OutputSet none;
  return read_whole(open_volume_input(input, none, progress), input.path, progress);
}

VolumeInputSteps find_volume_steps(const std::vector<std::string>& inputs, const VolumeInput& options) {
  if (options.stack && inputs.size() > 1)
    wrong_usage("--stack: expected one pattern, found {} inputs", inputs.size());
  VolumeInputSteps result;
  VolumeInput input = options;
  if (!options.stack) {
    for (const SeriesEntry& entry : find_series(inputs)) {
      input.path = entry.file;
      result.steps.push_back({entry.time, entry.file, input});
    }
    if (inputs.size() == 1 && file_extension(inputs[0]) == ".pvd") result.times = StepTimes::kAbsolute;
  }
  if (!result.steps.empty()) return result;
  input.path = inputs[0];
  if (!options.stack) result = steps_of_file(input);
  if (result.steps.empty()) result.steps = {{0, input.path, input}};
  return result;
}

}  // namespace adamas
