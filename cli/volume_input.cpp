#include "cli/volume_input.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cli/option_checks.h"
#include "cli/option_values.h"
#include "cli/usage_error.h"
#include "core/io/volume_format.h"
#include "core/io/volume_stack.h"

namespace adamas {

namespace {

constexpr StoredType kStoredTypes[] = {
    StoredType::kUint8, StoredType::kInt8,   StoredType::kUint16, StoredType::kInt16,   StoredType::kUint32,
    StoredType::kInt32, StoredType::kUint64, StoredType::kInt64,  StoredType::kFloat32, StoredType::kFloat64};

std::vector<std::string> type_names() {
  std::vector<std::string> names;
  for (const StoredType type : kStoredTypes) names.emplace_back(stored_name(type));
  return names;
}

Vec3 parse_spacing(const std::string& text) {
  const Vec3 spacing = parse_vector("--spacing", text);
  if (!(spacing.x > 0 && spacing.y > 0 && spacing.z > 0))
    wrong_usage("--spacing: expected positive numbers, found '{}'", text);
  return spacing;
}

RawVolume raw_volume(const VolumeInput& input) {
  RawVolume raw;
  const auto n = parse_dimensions("--dimensions", input.dimensions);
  raw.dimensions = {n[0], n[1], n[2]};
  if (input.type.empty()) wrong_usage("--dimensions: expected --type as well");
  raw.type = *find_stored_type(input.type);
  raw.big_endian = input.endian == "big";
  if (!input.header_bytes.empty()) raw.header_bytes = parse_count("--header-bytes", input.header_bytes, 0);
  return raw;
}

/// Throws UsageError where the array of a file is named that has only one.
void check_array(const VolumeInput& input) {
  if (input.array.empty()) return;
  const VolumeFormat format = find_volume_format(input.path);
  if (format == VolumeFormat::kVti || format == VolumeFormat::kHdf5 || format == VolumeFormat::kOtherGrid)
    return;
  wrong_usage("--array: expected a file that may have several arrays, found {}", input.path);
}

}  // namespace

VolumeReader open_volume_input(const VolumeInput& input, Session& session) {
  const Vec3 spacing = input.spacing.empty() ? Vec3{1, 1, 1} : parse_spacing(input.spacing);
  const Vec3 origin = input.origin.empty() ? Vec3{} : parse_vector("--origin", input.origin);
  const bool raw = !input.dimensions.empty();
  const auto needs_raw = [&](const char* option, const std::string& text) {
    if (!raw && !text.empty()) wrong_usage("{}: expected --dimensions as well", option);
  };
  needs_raw("--type", input.type);
  needs_raw("--endian", input.endian);
  needs_raw("--header-bytes", input.header_bytes);
  if (!raw && !input.stack) {
    if (!input.spacing.empty()) wrong_usage("--spacing: expected --dimensions or --stack as well");
    if (!input.origin.empty()) wrong_usage("--origin: expected --dimensions or --stack as well");
  }
  if ((raw || input.stack) && !input.array.empty())
    wrong_usage("--array: expected a file with several arrays, not {}", raw ? "--dimensions" : "--stack");
  if (raw && input.stack) wrong_usage("--stack and --dimensions: expected one of them");
  session.outputs.protect(input.path);
  session.outputs.protect_other(input.scratch);
  if (raw) {
    RawVolume volume = raw_volume(input);
    volume.spacing = spacing;
    volume.origin = origin;
    return open_raw_volume(input.path, volume);
  }
  if (input.stack) return open_volume_stack(match_stack(input.path), spacing, origin);
  check_array(input);
  return open_volume(input.path, {input.array, input.scratch}, session.console);
}

void add_volume_input(CLI::App& command, VolumeInput& input) {
  command
      .add_option(
          "input", input.path,
          "The volume: .nrrd, .nhdr, .mha, .mhd, .vti, .vtr, .vtk, .nii, .nii.gz, .hdr, .h5, .tif, .png "
          "or .slc; with --dimensions a raw file, with --stack a pattern")
      ->required()
      ->type_name("FILE");
  command
      .add_flag("--stack", input.stack,
                "INPUT is a pattern of slices, as \"ct_*.tif\" (in quotes) or ct_%04d.png")
      ->group("Input");
  command.add_option("--array", input.array, "Which array or data set of a file with several")
      ->type_name("NAME")
      ->group("Input");
  command.add_option("--dimensions", input.dimensions, "Of a raw file: numbers of samples")
      ->type_name("X,Y,Z")
      ->group("Input");
  command.add_option("--type", input.type, "Of a raw file: the type of samples")
      ->check(one_of(type_names()))
      ->group("Input");
  command.add_option("--endian", input.endian, "Of a raw file: the order of bytes (default little)")
      ->check(one_of({"little", "big"}))
      ->group("Input");
  command.add_option("--header-bytes", input.header_bytes, "Of a raw file: bytes to pass over (default 0)")
      ->type_name("N")
      ->group("Input");
  command
      .add_option("--spacing", input.spacing, "Between the samples of a raw file or a stack (default 1,1,1)")
      ->type_name("x,y,z")
      ->group("Input");
  command
      .add_option("--origin", input.origin, "Of the first sample of a raw file or a stack (default 0,0,0)")
      ->type_name("x,y,z")
      ->group("Input");
  command
      .add_option("--scratch", input.scratch,
                  "Folder for scratch data, up to four times the volume's samples (default: that "
                  "of the system, $TMPDIR or /tmp)")
      ->type_name("FOLDER");
}

}  // namespace adamas
