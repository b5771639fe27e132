#pragma once

#include <string>

#include "adamas/fractions.h"
#include "adamas/output_set.h"
#include "adamas/read_input.h"
#include "adamas/volume_input.h"
#include "cli/command.h"
#include "cli/volume_options.h"

namespace adamas::cli {

// The options that say what the input is; shared by the commands that read data.

/// Returns the list of grid files in help texts; messages of the readers name others.
std::string grid_files();
/// Names files with data on a mesh.
std::string mesh_files();

/// Adds the options of volume fractions, labels and fields on a grid. `field` describes `--field`, whose
/// meaning some commands widen: `take_field` is called with its text.
void add_material_options(const Command& command, InputOptions& options);
void add_material_options(const Command& command, InputOptions& options, const std::string& field_type,
                          const std::string& field, Command::Conversion take_field);
/// Adds the options of how interfaces are reconstructed from labels and fractions.
void add_reconstruction_options(const Command& command, bool& smooth_labels, FractionOptions& fractions);
/// Moves --time from the options of volumes to those of cells, where a file has these.
void share_time(const std::filesystem::path& path, InputOptions& input, VolumeInput& volume);
/// Adds the names of labels.
void add_region_names(const Command& command, InputOptions& options);
/// Adds the options of given interfaces.
void add_interface_options(const Command& command, InputOptions& options);
/// Adds all of these, and the options of files without a header.
void add_input_options(const Command& command, InputOptions& options, bool& smooth_labels,
                       FractionOptions& fractions);

/// Whether options say where volume fractions or labels are.
bool names_materials(const InputOptions& options);
/// Gives the options of files without a header to the data on a grid, where such options are among these;
/// otherwise they are of a volume.
void share_raw_options(InputOptions& input, VolumeInput& volume);

/// Keeps outputs off all files that the options name; `base`: the file that others may lie beside.
void protect_inputs(const InputOptions& options, const std::filesystem::path& base, OutputSet& outputs);

/// Reads an input of any kind. Throws Error (kUsage) for options of the reconstruction beside given
/// interfaces, and for options that do not go together.
Input read_input(const InputOptions& options, const ReconstructOptions& reconstruction, Progress& progress);

}  // namespace adamas::cli
