#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adamas/files.h"
#include "adamas/geometry.h"
#include "adamas/input.h"
#include "adamas/progress.h"
#include "adamas/raw_volume.h"

namespace adamas {

/// A file with a surface between two materials.
struct GivenSurface {
  std::filesystem::path file;  ///< .obj, .off, .ply or .stl
  std::string front, back;     ///< the material that the normals point to, and the other one
};

/// Options that say what an input is read from: data on a grid, given interfaces, or both.
struct InputOptions {
  /// The main file: data on a grid, or a labelled network (.vtp, .ply, .arec, .txt). Where it is empty, the
  /// first file of `data` that holds volume fractions or labels is the main one.
  std::filesystem::path path{};
  MaterialDataOptions data{};            ///< what is read of a grid; its notes go to the progress
  std::optional<RawVolume> raw{};        ///< what files without a header hold
  std::vector<GivenSurface> surfaces{};  ///< interfaces, instead of a network or beside a grid
  std::filesystem::path region_names{};  ///< names of the labels of a network, a line "LABEL NAME" for each
  /// The domain of given interfaces; none: that of the grid, else the box of the interfaces and 5% more.
  std::optional<Box3> box{};
  MendingOptions mending{};  ///< of given interfaces

  /// The first option given that only data on a grid can mean, by its name on the command line; empty where
  /// there is none.
  [[nodiscard]] std::string grid_option() const;
};

/// Returns the options with the main file as `path`; it stays empty where no file is named.
InputOptions with_main_file(const InputOptions& options);

/// Returns the kind of data in a file, by the ending of its name, and by its header where that may be a
/// surface or a network (.ply). Files of unknown endings are grids.
InputKind input_kind(const std::filesystem::path& path);

/// Whether interfaces are given by files, and not reconstructed from data on a grid.
bool has_given_interfaces(const InputOptions& options);

/// Reads an input from files. Notes what was assumed, and what was mended in volume fractions beyond
/// round-off. Throws Error, with the file's name, where a file is missing, corrupt or of a kind that is not
/// expected there, and Error (kUsage) for options that do not go together.
Input read_input(const InputOptions& options, Progress& progress = SilentProgress::instance());

}  // namespace adamas
