#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adamas/export.h"
#include "adamas/files.h"
#include "adamas/geometry.h"
#include "adamas/input.h"
#include "adamas/progress.h"
#include "adamas/raw_volume.h"

namespace adamas ADAMAS_API {

/// Names a file with a surface between two materials.
struct GivenSurface {
  std::filesystem::path file;  ///< .obj, .off, .ply or .stl
  std::string front, back;     ///< the material that the normals point to, and the other one
};

/// Options that say what an input is read from: data on a grid, given interfaces, or both.
struct InputOptions {
  /// The main file: data on a grid, or a labelled network (.vtp, .ply, .arec, .txt). Where it is empty, the
  /// first file of `data` that holds volume fractions or labels is the main one.
  std::filesystem::path path{};
  MaterialDataOptions data{};            ///< how arrays of a grid are read; its notes go to the progress
  std::optional<RawVolume> raw{};        ///< the content of files without a header
  std::vector<GivenSurface> surfaces{};  ///< interfaces, instead of a network or beside a grid
  /// A file with names of the labels of a network, a line "LABEL NAME" for each.
  std::filesystem::path region_names{};
  /// The domain of given interfaces; none: that of the grid, else the box of the interfaces enlarged by 5%.
  std::optional<Box3> box{};
  MendingOptions mending{};  ///< how given interfaces are repaired

  /// Returns the command-line name of the first given option that only data on a grid can have; empty where
  /// there is none.
  [[nodiscard]] std::string grid_option() const;
};

/// Returns the options with the main file as `path`; `path` stays empty where no file is named.
InputOptions with_main_file(const InputOptions& options);

/// Returns the kind of data in a file according to the extension, and for .ply, which may be a surface or a
/// network, the header. Files of unknown extensions are grids.
InputKind input_kind(const std::filesystem::path& path);

/// Returns whether interfaces are given by files, and not reconstructed from data on a grid.
bool has_given_interfaces(const InputOptions& options);

/// Reads an input from files. Notes tell of assumptions, and of repairs of volume fractions beyond round-off.
/// Throws Error, with the file's name, where a file is missing, corrupt or of a kind that is not expected
/// there, and Error (kUsage) for options that do not go together.
Input read_input(const InputOptions& options, Progress& progress = SilentProgress::instance());

}  // namespace adamas
