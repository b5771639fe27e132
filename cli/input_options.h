#pragma once

#include <CLI/App.hpp>
#include <memory>
#include <string>
#include <vector>

#include "cli/console.h"
#include "core/data/interface_mesh.h"
#include "core/data/multi_material_data.h"
#include "core/io/multi_material_reader.h"
#include "interfaces/source.h"

namespace adamas {

/// The options that say what the input is, shared by the commands that read data.
struct InputOptions {
  std::string path;
  std::vector<std::string> fractions, fields, extensive, interfaces;
  std::string fraction_scale, rest, labels, region, box, region_names;
  bool tolerant = false;

  /// Whether something was said that only gridded data can mean.
  [[nodiscard]] bool any_material_option() const {
    return !(fractions.empty() && fields.empty() && extensive.empty() && fraction_scale.empty() &&
             rest.empty() && labels.empty() && region.empty());
  }
};

enum class InputKind { kGrid, kNetwork, kMesh, kSurface };
/// By the extension: a tetrahedral mesh (.vtu), an interface mesh (.vtp, .arec, .txt), a surface without
/// materials (.obj, .off, .ply, .stl), or else a grid.
InputKind input_kind(const std::string& path);

/// Options for volume fractions, labels and fields on a grid. `field` describes `--field`, whose meaning some
/// commands widen.
void add_material_options(CLI::App& command, InputOptions& options,
                          const char* field = "One more field, and where its values are; repeatable",
                          const char* field_type = "NAME=FILE-or-ARRAY");
/// Options for given interface meshes.
void add_interface_options(CLI::App& command, InputOptions& options);

/// The options as the reader wants them; throws UsageError.
MaterialDataOptions material_options(const InputOptions& options);

/// Reads a gridded input.
MultiMaterialData load_data(const InputOptions& options, Console& console);

/// Prints what was mended in volume fractions, if anything was.
void print_fraction_report(const MultiMaterialData& data, Console& console);

/// An input that is ready to be resampled or cut.
struct Input {
  std::unique_ptr<MultiMaterialData> data;  ///< null for interface meshes alone
  ResamplingSource source;
};

/// Reads the input: interfaces reconstructed from a grid's volume fractions, or given as meshes.
Input load_input(const InputOptions& options, Console& console);

}  // namespace adamas
