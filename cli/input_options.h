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

/// The options that say what the input is, as they were given; shared by the commands that read data.
struct InputArguments {
  std::string path;
  std::vector<std::string> fractions, fields, extensive, interfaces;
  RawOptions raw;
  std::string fraction_array, fraction_scale, rest, labels, region, box, region_names, weld, blur,
      fraction_error;
  bool tolerant = false, cells = false, points = false, smooth_labels = false, keep_dispersed = false;
  bool plain = false;  ///< data without materials will do (MaterialDataOptions::plain); no option

  /// Whether options say where volume fractions or labels are.
  [[nodiscard]] bool names_materials() const;
  /// The first option given that only gridded data with materials can mean, for messages; empty where there
  /// is none.
  [[nodiscard]] std::string material_option() const;
  /// The same of what any gridded data can mean.
  [[nodiscard]] std::string grid_option() const;
  /// What --cells or --points say. Throws Error (kUsage) where both are given.
  [[nodiscard]] std::optional<Centering> centering() const;
  /// The first option given that only given interfaces can mean, --interface itself apart.
  [[nodiscard]] std::string interface_option() const;
};

/// The grids that help texts name; messages of the readers tell of others.
std::string grid_files();

/// Options for volume fractions, labels and fields on a grid. `field` describes `--field`, whose meaning some
/// commands widen.
void add_material_options(const Command& command, InputArguments& options,
                          const char* field = "One more field, and where its values are; repeatable",
                          const char* field_type = "NAME=FILE-or-ARRAY");
/// The options of how interfaces are reconstructed from fractions and labels.
void add_reconstruction_options(const Command& command, InputArguments& options);
/// The first of these that is given; empty where there is none.
std::string reconstruction_option(const InputArguments& options);
/// Throws Error (kUsage) where one is, for given interfaces.
void refuse_reconstruction_options(const InputArguments& options);
/// What the options say of volume fractions. Throws Error (kUsage) for values that are none.
FractionOptions fraction_options(const InputArguments& options);
/// Throws Error (kUsage) where an option of volume fractions is given for labels, even one that asks for the
/// default. `source`: what messages call the input.
void check_fraction_options(const InputArguments& options, const Input& input, const std::string& source);
/// The first option of volume fractions that is given, even if it asks for the default; empty where there is
/// none.
std::string fraction_option(const InputArguments& options);
/// Options for given interface meshes; `resampled`: those too that say what to make of them.
void add_interface_options(const Command& command, InputArguments& options, bool resampled = true);

/// Keeps outputs off all files that the options name; `base`: the file that others may lie beside.
void protect_inputs(const InputArguments& options, const std::string& base, OutputSet& outputs);

/// The options as the library takes them. Throws Error (kUsage) for values that are none.
InputOptions to_input_options(const InputArguments& options);

/// The same options with the file that gives the grid as the input's path: where none was given, the first of
/// those that hold volume fractions or labels.
InputArguments with_main_file(const InputArguments& options);

/// The same where a file is needed: throws Error (kUsage) where there is none. `expected` is what the input
/// is called.
InputArguments with_needed_main_file(const InputArguments& options, const char* expected = "an INPUT");

/// Reads an input of any kind. Throws Error (kUsage) for options of the reconstruction beside given
/// interfaces, and for options that do not go together.
Input read_input(const InputArguments& options, Progress& progress);

/// Whether interfaces are given.
bool has_given_interfaces(const InputArguments& options);

}  // namespace adamas::cli
