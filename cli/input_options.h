#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adamas/output_set.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/raw_options.h"
#include "core/base/typed_id.h"
#include "core/data/interface_mesh.h"
#include "core/data/multi_material_data.h"
#include "core/io/input_formats.h"
#include "core/io/multi_material_reader.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "interfaces/source/error_targets.h"
#include "interfaces/source/resampling_source.h"

namespace adamas::interfaces {
struct SavedHierarchy;
}  // namespace adamas::interfaces

namespace adamas::cli {

/// The options that say what the input is, shared by the commands that read data.
struct InputOptions {
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

/// As core/io/input_formats.h has it; a saved hierarchy is a mesh, and polygons are taken for a network.
io::InputKind input_kind(const std::string& path);

/// Options for volume fractions, labels and fields on a grid. `field` describes `--field`, whose meaning some
/// commands widen.
void add_material_options(const Command& command, InputOptions& options,
                          const char* field = "One more field, and where its values are; repeatable",
                          const char* field_type = "NAME=FILE-or-ARRAY");
/// The options of how interfaces are reconstructed from fractions and labels.
void add_reconstruction_options(const Command& command, InputOptions& options);
/// The first of these that is given; empty where there is none.
std::string reconstruction_option(const InputOptions& options);
/// Throws Error (kUsage) where one is, for given interfaces.
void refuse_reconstruction_options(const InputOptions& options);
/// What these ask of the reconstruction. Throws Error (kUsage) where the data have no labels to smooth, or no
/// fractions to be blurred.
interfaces::ReconstructionOptions reconstruction_options(const InputOptions& options,
                                                         const MultiMaterialData& data);
/// Options for given interface meshes; `resampled`: those too that say what to make of them.
void add_interface_options(const Command& command, InputOptions& options, bool resampled = true);

/// Keeps outputs off all files that the options name; `base`: the file that others may lie beside.
void protect_inputs(const InputOptions& options, const std::string& base, OutputSet& outputs);

/// The options as the reader wants them; throws Error (kUsage).
MaterialDataOptions material_options(const InputOptions& options);

/// The same options with the file that gives the grid as the input's path: where none was given, the first of
/// those that hold volume fractions or labels.
InputOptions with_main_file(const InputOptions& options);

/// What messages call the input: its path, and where that is the first of several files, how many more there
/// are. `options` are those with a main file.
std::string input_name(const InputOptions& options);

/// The same where a file is needed: throws Error (kUsage) where there is none. `expected` is what the input
/// is called.
InputOptions with_needed_main_file(const InputOptions& options, const char* expected = "an INPUT");

/// Reads a gridded input; notes what was mended in its volume fractions beyond round-off.
MultiMaterialData load_data(const InputOptions& options, Console& console);

/// An input that is ready to be resampled or cut.
struct LoadedInput {
  std::unique_ptr<MultiMaterialData> data;  ///< null for interface meshes alone
  interfaces::ResamplingSource source;
};

/// Throws where options do not fit the input.
using InputCheck = std::function<void(const interfaces::InputFacts&)>;

/// Reads the input: interfaces reconstructed from a grid's volume fractions, or given as meshes.
LoadedInput load_input(const InputOptions& options, Console& console, const InputCheck& check = {});

/// The numbers that materials have among others, by name. Throws Error, in the name of `source`, for one that
/// is not there; `whose` tells whose materials were expected.
IdVector<MaterialId, MaterialId> material_numbers(const IdVector<MaterialId, std::string>& names,
                                                  const IdVector<MaterialId, std::string>& among,
                                                  std::string_view source, std::string_view whose);

/// Whether a file is a hierarchy that adamas resample has saved; false where there is none.
bool is_saved_hierarchy(const std::string& path);

/// Throws Error for another file, and for one that is damaged.
interfaces::SavedHierarchy load_saved_hierarchy(const std::string& path, Console& console);

}  // namespace adamas::cli
