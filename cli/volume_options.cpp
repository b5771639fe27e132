#include "cli/volume_options.h"

#include <algorithm>
#include <iterator>

#include "cli/option_values.h"

namespace adamas::cli {

namespace {

constexpr SampleType kMadeTypes[] = {SampleType::kUint8, SampleType::kUint16, SampleType::kFloat32};

}  // namespace

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
      .add_converted(
          "--time",
          "Of a file with several times (NIfTI, HDF5 along four axes): the number of one, from 0 on",
          [&input](const std::string& option, const std::string& text) {
            input.time = parse_count(option, text, 0);
          })
      .type_name("N")
      .group("Input");
  command
      .add_converted("--scratch",
                     "Folder for scratch data, up to four times the volume's samples (default: that "
                     "of the system, $TMPDIR or /tmp)",
                     [&input](const std::string&, const std::string& text) { input.scratch = text; })
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
