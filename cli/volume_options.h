#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "adamas/geometry.h"
#include "adamas/volume.h"
#include "cli/command.h"
#include "cli/input_options.h"
#include "cli/raw_options.h"
#include "core/io/volume_reader.h"

namespace adamas::cli {

/// The options that say which volume is the input and, where the file does not, what it holds.
struct VolumeInput {
  std::string path;
  bool stack = false;
  std::string array, scratch, time;
  RawOptions raw;
  std::shared_ptr<io::UnpackedTimes> all_times;  ///< as of VolumeOptions; mostly null

  /// The first option given that only a volume can mean, for messages; empty where there is none.
  [[nodiscard]] std::string option() const;
};

/// The input and its options.
void add_volume_input(const Command& command, VolumeInput& input);
/// The options alone. `origin`: the names of that for the first sample.
void add_volume_options(const Command& command, VolumeInput& input, const char* origin);

/// Where volume fractions or labels are named, bare samples are those of a grid with materials.
void give_raw_options(VolumeInput& volume, InputArguments& input);

/// Opens it. Throws Error (kUsage) where options do not go together.
io::VolumeReader open_volume_input(const VolumeInput& input, Session& session, bool keep_scale = false);

/// The volume that a file is, if it is to be read as one: where the options say so, and where no other reader
/// knows it or all that it may say of places.
std::optional<io::VolumeReader> find_volume(const InputArguments& input, VolumeInput volume,
                                            Session& session);

/// Whether a file is of a format that has nothing but the samples of one array, one number each; by its name
/// and, of NRRD, its header.
bool has_one_array(const std::string& path);

/// Whether a .vti says that its axes are not parallel to x, y and z, so that it is no grid laid out along
/// these.
bool is_aslant_image(const std::string& path);

/// Throws Error where a volume has more samples along an axis than pages can be made of.
void check_volume_dimensions(const std::string& name, const VolumeGrid& grid);

/// The option -o of a command that makes a volume.
void add_volume_output(const Command& command, std::string& output);

/// The types of samples that are made: uint8, uint16 and float32.
std::vector<std::string> sample_type_names();
/// The option --type of a command that makes samples.
CommandOption add_sample_type(const Command& command, std::string& type, const std::string& description);
/// The type of that name, which the option lets through.
SampleType parse_sample_type(const std::string& name);

}  // namespace adamas::cli
