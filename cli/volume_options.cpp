#include "cli/volume_options.h"

#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

std::vector<std::pair<std::string, StoredType>> stored_types() {
  std::vector<std::pair<std::string, StoredType>> types;
  for (const StoredType type :
       {StoredType::kUint8, StoredType::kInt8, StoredType::kUint16, StoredType::kInt16, StoredType::kUint32,
        StoredType::kInt32, StoredType::kUint64, StoredType::kInt64, StoredType::kFloat32,
        StoredType::kFloat64})
    types.emplace_back(to_string(type), type);
  return types;
}

std::array<std::uint64_t, 3> parse_samples(const std::string& option, const std::string& text) {
  const auto n = parse_dimensions(option, text);
  return {n[0], n[1], n[2]};
}

Vec3 parse_spacing(const std::string& option, const std::string& text) {
  const Vec3 spacing = parse_vector(option, text);
  if (!(spacing.x > 0 && spacing.y > 0 && spacing.z > 0))
    wrong_usage("{}: expected positive numbers, found '{}'", option, text);
  return spacing;
}

}  // namespace

void add_raw_options(const Command& command, RawOptions& options, const char* origin, const char* subject) {
  const Command input = command.in_group("Input");
  input.add_value("--dimensions", "X,Y,Z", "Of a raw file: numbers of samples", options.dimensions,
                  parse_samples);
  input.add_choice("--type", "Of a raw file: the type of samples", options.type, stored_types());
  input.add_choice<bool>("--endian", "Of a raw file: the order of bytes (default little)", options.big_endian,
                         {{"little", false}, {"big", true}});
  input.add_value("--header-bytes", "N", "Of a raw file: bytes to pass over (default 0)",
                  options.header_bytes, parse_count_from_0);
  input.add_value("--spacing", "x,y,z", fmt::format("Between the samples of {} (default 1,1,1)", subject),
                  options.spacing, parse_spacing);
  input.add_converted(origin, "x,y,z",
                      fmt::format("The place of the first sample of {} (default 0,0,0)", subject),
                      [&options](const std::string&, const std::string& text) {
                        options.origin = parse_vector("--first-sample", text);
                      });
}

void add_volume_options(const Command& command, VolumeInput& input, const char* origin) {
  const Command group = command.in_group("Input");
  group.add_flag("--stack", "INPUT is a pattern of slices, as \"ct_*.tif\" (in quotes) or ct_%04d.png",
                 input.stack);
  group.add_option("--array", "NAME", "Which array or data set of a file with several", input.array);
  add_raw_options(command, input.raw, origin, "a raw file or a stack");
  group.add_value(
      "--time", "N",
      "Of a file with several times (NIfTI, HDF5 or .npy along four axes, a stack of MRC; cells of "
      "OpenFOAM, ExodusII, CGNS or Truchas): the "
      "number of one, from 0 on",
      input.time, parse_count_from_0);
  command.add_file("--scratch", "FOLDER",
                   "Folder for scratch data, up to four times the volume's samples (default: that of the "
                   "system, $TMPDIR or /tmp)",
                   input.scratch);
}

void add_volume_output(const Command& command, std::string& output) {
  command
      .add_option(
          "-o,--output", "FILE",
          "The volume: .vti, .nrrd, .mha, .nii, .nii.gz, .nhdr or .mhd with a .raw beside it, or .raw alone",
          output)
      .required();
}

std::vector<std::pair<std::string, SampleType>> made_types() {
  std::vector<std::pair<std::string, SampleType>> types;
  for (const SampleType type : {SampleType::kUint8, SampleType::kUint16, SampleType::kFloat32})
    types.emplace_back(sample_name(type), type);
  return types;
}

}  // namespace adamas::cli
