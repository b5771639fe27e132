#include "cli/volume_options.h"

#include <algorithm>
#include <filesystem>

#include "cli/option_values.h"
#include "cli/usage.h"
#include "core/io/grid_axes.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/volume_stack.h"
#include "isosurface/volume/page_grid.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;
using namespace isosurface;

namespace {

constexpr SampleType kMadeTypes[] = {SampleType::kUint8, SampleType::kUint16, SampleType::kFloat32};

/// Throws Error (kUsage) where an option names an array, but files of this format have only one.
void check_array(const VolumeInput& input) {
  if (input.array.empty()) return;
  if (find_volume_format(input.path).several_arrays) return;
  wrong_usage("--array: expected a file that may have several arrays, found {}", input.path);
}

}  // namespace

std::string VolumeInput::option() const {
  if (stack) return "--stack";
  if (!array.empty()) return "--array";
  if (const std::string option = raw.option(); !option.empty()) return option;
  if (!time.empty()) return "--time";
  return scratch.empty() ? "" : "--scratch";
}

void give_raw_options(VolumeInput& volume, InputArguments& input) {
  if (input.names_materials() && !volume.stack) input.raw = std::exchange(volume.raw, {});
}

VolumeReader open_volume_input(const VolumeInput& input, Session& session, bool keep_scale) {
  const std::optional<RawVolume> raw = raw_volume(input.raw);
  if (!raw && !input.stack) {
    if (!input.raw.spacing.empty()) wrong_usage("--spacing: expected --dimensions or --stack as well");
    if (!input.raw.origin.empty()) wrong_usage("--first-sample: expected --dimensions or --stack as well");
  }
  if ((raw || input.stack) && !input.array.empty())
    wrong_usage("--array: expected a file with several arrays, not {}", raw ? "--dimensions" : "--stack");
  if ((raw || input.stack) && !input.time.empty())
    wrong_usage("--time: expected a file with several times, not {}", raw ? "--dimensions" : "--stack");
  if (raw && input.stack) wrong_usage("--stack and --dimensions: expected one of them");
  session.outputs.protect(input.path);
  session.outputs.protect_other(input.scratch);
  if (raw) return open_raw_volume(input.path, *raw);
  if (input.stack) {
    const auto files = match_stack(input.path);
    for (const auto& file : files) session.outputs.protect(file);
    return open_volume_stack(files, raw_spacing(input.raw), raw_origin(input.raw), {{}, input.scratch, {}},
                             session.console);
  }
  check_array(input);
  VolumeOptions options{input.array, input.scratch, {}, keep_scale, input.all_times};
  if (!input.time.empty()) options.time = parse_count("--time", input.time, 0);
  return open_volume(input.path, options, session.console);
}

bool has_one_array(const std::string& path) {
  const InputFormat* format = find_format_by_name(path);
  if (format == nullptr || !format->gives_volumes()) return false;
  // A data set of HDF5 is always a volume, a NIfTI too, whatever its header says.
  if (!format->gives_grids() || format->several_times) return true;
  if (format->several_arrays || format->read_header == nullptr) return false;
  return format->read_header(path).arrays.front().source.components == 1;
}

bool is_aslant_image(const std::string& path) {
  const InputFormat* format = find_format_by_name(path);
  if (format == nullptr || format->read_header == nullptr || !format->several_arrays) return false;
  try {
    return !are_parallel(format->read_header(path).axes);
  } catch (const Error&) {
    // The reader of grids may know it, or tells better what is wrong.
    return false;
  }
}

void check_volume_dimensions(const std::string& name, const VolumeGrid& grid) {
  constexpr std::uint64_t kMost = (std::uint64_t{1} << PageGrid::kMaxDepth) + 1;
  for (const std::uint64_t n : grid.dimensions) {
    if (n > kMost) fail("{}: expected at most {} samples along each axis, found {}", name, kMost, n);
  }
}

std::optional<VolumeReader> find_volume(const InputArguments& input, VolumeInput volume, Session& session) {
  const InputFormat* format = find_format_by_name(input.path);
  volume.path = input.path;
  const bool no_grid = format != nullptr && format->gives_volumes() && !format->gives_grids();
  if (!volume.option().empty() || no_grid) return open_volume_input(volume, session);
  if (!input.grid_option().empty() || format == nullptr || !format->several_times) return {};
  // The names of pictures of high dynamic range end in .hdr as well as those of NIfTI's headers.
  if (read_beginning(input.path).starts_with("#?")) return {};
  // A file of colours or vectors is not a volume; data sets of HDF5 have no such header, and are one each.
  if (format->read_header != nullptr && format->read_header(input.path).arrays.front().source.components != 1)
    return {};
  return open_volume_input(volume, session);
}

void add_volume_input(const Command& command, VolumeInput& input) {
  command
      .add_option("input", input.path,
                  "The volume: " + list_volume_endings("or") +
                      "; with --dimensions a raw file, with --stack a pattern")
      .required()
      .type_name("FILE");
  add_volume_options(command, input, "--origin,--first-sample");
}

void add_volume_options(const Command& command, VolumeInput& input, const char* origin) {
  command
      .add_flag("--stack", input.stack,
                "INPUT is a pattern of slices, as \"ct_*.tif\" (in quotes) or ct_%04d.png")
      .group("Input");
  command.add_option("--array", input.array, "Which array or data set of a file with several")
      .type_name("NAME")
      .group("Input");
  add_raw_options(command, input.raw, origin, "a raw file or a stack");
  command
      .add_option("--time", input.time,
                  "Of a file with several times (NIfTI, HDF5 along four axes): the number of one, from 0 on")
      .type_name("N")
      .group("Input");
  command
      .add_option("--scratch", input.scratch,
                  "Folder for scratch data, up to four times the volume's samples (default: that "
                  "of the system, $TMPDIR or /tmp)")
      .type_name("FOLDER");
}

void add_volume_output(const Command& command, std::string& output) {
  command
      .add_option(
          "-o,--output", output,
          "The volume: .vti, .nrrd, .mha, .nii, .nii.gz, .nhdr or .mhd with a .raw beside it, or .raw alone")
      .required()
      .type_name("FILE");
}

std::vector<std::string> sample_type_names() {
  std::vector<std::string> names;
  for (const SampleType made : kMadeTypes) names.emplace_back(sample_name(made));
  return names;
}

CommandOption add_sample_type(const Command& command, std::string& type, const std::string& description) {
  return command.add_option("--type", type, description).one_of(sample_type_names());
}

SampleType parse_sample_type(const std::string& name) {
  return *std::find_if(std::begin(kMadeTypes), std::end(kMadeTypes),
                       [&name](SampleType type) { return sample_name(type) == name; });
}

}  // namespace adamas::cli
