#pragma once

#include <cstddef>
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
#include "adamas/reconstruct.h"

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
  MaterialDataOptions data{};            ///< what is read of a grid; its notes go to the progress
  bool stack = false;                    ///< `path` is a pattern of pictures, and no series of files
  RawOptions raw{};                      ///< what files without a header hold, and the places of a stack
  std::vector<GivenSurface> surfaces{};  ///< interfaces, instead of a network or beside a grid
  /// A file with names of the labels of a network or of `data`, a line "LABEL NAME" for each, or a table of
  /// ITK-SNAP.
  std::filesystem::path region_names{};
  /// The domain of given interfaces; none: that of the grid, else the box of the interfaces enlarged by 5%.
  std::optional<Box3> box{};
  MendingOptions mending{};  ///< how given interfaces are repaired
  /// The memory, in bytes, that reading data on a grid and reconstructing their interfaces may take;
  /// read_input throws where it would be more, by what headers say and, when the data are read, by an
  /// estimate. 0: any.
  std::size_t memory = 0;

  // The names, on the command line, of the first option given of a kind; empty where there is none.

  /// Options that only data on a grid with materials can mean. `reconstruction`: such an option that says how
  /// interfaces are reconstructed, which comes after those of fractions and labels.
  [[nodiscard]] std::string material_option(const std::string& reconstruction = {}) const;
  /// Options that only data on a grid can mean: these and the centering.
  [[nodiscard]] std::string grid_option(const std::string& reconstruction = {}) const;
  /// Options that only given interfaces can mean, besides `surfaces`.
  [[nodiscard]] std::string interface_option() const;
};

/// Returns the options with the main file as `path`; `path` stays empty where no file is named.
InputOptions with_main_file(const InputOptions& options);

/// Returns the options with the main file as `path`. Throws Error (kUsage) where no file is named; `expected`
/// is what the message calls it.
InputOptions needed_main_file(const InputOptions& options, const std::string& expected = "an INPUT");

/// Returns the kind of data in a file, by the ending of its name, and by its header where that may be a
/// surface or a network (.ply). Files of unknown endings are grids.
InputKind input_kind(const std::filesystem::path& path);

/// Returns whether interfaces are given by files, and not reconstructed from data on a grid.
bool has_given_interfaces(const InputOptions& options);

/// Throws Error (kUsage) where options say how interfaces are reconstructed, but these are given. Nothing is
/// read for it; whether the options suit the data is checked when interfaces are reconstructed.
void check(const ReconstructOptions& options, const InputOptions& input);

/// Throws Error (kUsage) where the options name labels, but there are none: the main file is no network with
/// labels (.arec, .txt), and `data` names no labels.
void check_region_names(const InputOptions& options);

/// Reads an input from files. Notes what was assumed, and what was mended in volume fractions beyond
/// round-off. Throws Error, with the file's name, where a file is missing, corrupt or of a kind that is not
/// expected there, and Error (kUsage) for options that do not go together.
Input read_input(const InputOptions& options, Progress& progress = SilentProgress::instance());

/// Writes the surfaces of the side sets and the node sets of an input as polygons (.vtp): the sides of each
/// side set, and the faces all of whose points are in a node set. `side_set` of polygons is the number of the
/// set, whose name is in `side_set_names`. Notes sets that have no face. Throws Error (kUsage), in the name
/// of
/// --side-sets, where the input has no sets, and Error where the file cannot be written in full.
void write_set_surfaces(const std::filesystem::path& path, const Input& input,
                        Progress& progress = SilentProgress::instance());

}  // namespace adamas
