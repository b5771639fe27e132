#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adamas/fractions.h"
#include "adamas/output_set.h"
#include "adamas/read_input.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/raw_options.h"

namespace adamas::cli {

/// The options that describe the input, as they were given; the commands that read data share them.
struct InputArguments {
  std::string path;
  std::vector<std::string> fractions, fields, extensive, interfaces;
  RawOptions raw;
  std::string fraction_array, fraction_scale, rest, labels, region, box, region_names, weld, blur,
      fraction_error;
  bool tolerant = false, cells = false, points = false, smooth_labels = false, keep_dispersed = false;
  bool plain = false;  ///< accept data without materials (MaterialDataOptions::plain); it is set by commands,
                       ///< not by an option

  /// Returns whether options name the arrays of volume fractions or labels.
  [[nodiscard]] bool names_materials() const;
  /// Returns the first given option that only gridded data with materials can have, for messages; empty where
  /// there is none.
  [[nodiscard]] std::string material_option() const;
  /// Returns the first given option that only gridded data can have, with or without materials; empty where
  /// there is none.
  [[nodiscard]] std::string grid_option() const;
  /// Returns the centering of --cells or --points. Throws Error (kUsage) where both are given.
  [[nodiscard]] std::optional<Centering> centering() const;
  /// Returns the first given option that only given interfaces can have, except --interface itself.
  [[nodiscard]] std::string interface_option() const;
};

/// Returns the list of grid files in help texts; messages of the readers name others.
std::string grid_files();

/// Adds options for volume fractions, labels and fields on a grid. `field` describes `--field`, which has a
/// wider meaning in some commands.
void add_material_options(const Command& command, InputArguments& options,
                          const char* field = "One more field, and where its values are; repeatable",
                          const char* field_type = "NAME=FILE-or-ARRAY");
/// Adds the options for reconstructing interfaces from fractions and labels.
void add_reconstruction_options(const Command& command, InputArguments& options);
/// Returns the first of these that is given; empty where there is none.
std::string reconstruction_option(const InputArguments& options);
/// Throws Error (kUsage) where one of these is given, for given interfaces.
void refuse_reconstruction_options(const InputArguments& options);
/// Returns the options about volume fractions. Throws Error (kUsage) for invalid values.
FractionOptions fraction_options(const InputArguments& options);
/// Throws Error (kUsage) where an option of volume fractions is given for labels, even one that asks for the
/// default. `source`: the name of the input in messages.
void check_fraction_options(const InputArguments& options, const Input& input, const std::string& source);
/// Returns the first option of volume fractions that is given, even if it asks for the default; empty where
/// there is none.
std::string fraction_option(const InputArguments& options);
/// Adds options for given interface meshes; `resampled`: with those that say what to make of them.
void add_interface_options(const Command& command, InputArguments& options, bool resampled = true);

/// Protects all files that the options name from outputs; `base`: the file that relative names start from.
void protect_inputs(const InputArguments& options, const std::string& base, OutputSet& outputs);

/// Returns the options of the library. Throws Error (kUsage) for invalid values.
InputOptions to_input_options(const InputArguments& options);

/// Returns the options with the file of the grid as the input's path: where none was given, the first file
/// with volume fractions or labels.
InputArguments with_main_file(const InputArguments& options);

/// Returns with_main_file(). Throws Error (kUsage) where there is no file. `expected`: the word for the input
/// in messages.
InputArguments with_needed_main_file(const InputArguments& options, const char* expected = "an INPUT");

/// Reads an input of any kind. Throws Error (kUsage) for reconstruction options beside given interfaces, and
/// for options that do not go together.
Input read_input(const InputArguments& options, Progress& progress);

/// Returns whether interfaces are given.
bool has_given_interfaces(const InputArguments& options);

}  // namespace adamas::cli
