#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "adamas/raw_volume.h"
#include "core/data/field_values.h"
#include "core/data/label_array.h"

namespace adamas::io {

/// The axes of a file's array in space: position t along axis a is origin + t * directions[a].
struct GridAxes {
  std::array<Vec3, 3> directions{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 origin;
};

/// Whole numbers of an array that are few, or change seldom along x: the index of each number among the
/// different ones.
struct WholeRuns {
  LabelArray index;
  std::vector<std::int64_t> numbers;  ///< ascending
};

/// An array of a grid file without loss: whole numbers are kept as such, even if they are stored as doubles
/// that a float does not represent; others are floats if these represent them all, else doubles.
struct GridArray {
  std::string name;
  std::string type;  ///< the type in the file: "uint8", "float64"
  Centering centering = Centering::kPoints;
  int components = 1;
  std::vector<std::string>
      component_names{};  ///< a name for each component; empty unless the file names all of them
  /// The numbers; whole numbers are in the first of these types that holds all of them (set_numbers in
  /// grid_numbers.h).
  std::variant<std::vector<float>, std::vector<std::int32_t>, std::vector<std::int64_t>,
               std::vector<std::uint64_t>, std::vector<double>>
      values;
  std::optional<WholeRuns> runs{};  ///< the numbers in another form, in place of `values` (GridReading)
  double slope = 1, intercept = 0;  ///< the scale of whole numbers: a value is slope * number + intercept
  /// Names of its numbers as labels, from 0 on, before those of the file; usually empty.
  std::vector<std::string> label_names{};

  [[nodiscard]] bool scaled() const { return slope != 1 || intercept != 0; }
  /// Whether its values are whole numbers.
  [[nodiscard]] bool integral() const { return !has_fractions() && !scaled(); }
  /// Whether its numbers are floats or doubles.
  [[nodiscard]] bool has_fractions() const { return !runs && (values.index() == 0 || values.index() == 4); }
  [[nodiscard]] std::size_t size() const {
    if (runs) return runs->index.size();
    return std::visit([](const auto& v) { return v.size(); }, values);
  }
  /// The value that a number stands for.
  template <class Number>
  [[nodiscard]] double value(Number number) const {
    return scaled() ? slope * static_cast<double>(number) + intercept : static_cast<double>(number);
  }
  /// Gives runs the form of all other numbers.
  void expand();
  /// Moves all values out as floats.
  [[nodiscard]] std::vector<float> take_floats();
  /// Moves all values out, as floats if these represent them all, else as doubles.
  [[nodiscard]] FieldValues take_field();
};

/// The names of arrays, for messages: "'a', 'b'".
std::string names_of(const std::vector<GridArray>& arrays);

/// Reorders numbers from component-major to site-major order.
void interleave(GridArray& array);

/// The content of a file on an image or rectilinear grid.
struct GridFile {
  std::string kind;  ///< "VTK XML image", "NIfTI", ...
  std::array<std::vector<double>, 3> nodes;
  std::vector<GridArray> arrays;
  /// The strings of a field array "material_names", which name the values of labels; usually empty.
  std::vector<std::string> material_names;
  /// The faces of the cells round the samples, one more than nodes, in a format whose samples may be values
  /// at points or of cells. Until choose_centering() is called, the arrays are on points. Empty if the format
  /// states the centering (VTK).
  std::array<std::vector<double>, 3> faces;
  /// The centering that the file states for its samples along each axis.
  std::array<std::optional<Centering>, 3> stated;

  /// The axes of a grid that are not parallel to x, y and z; `nodes` are then positions along these axes.
  std::optional<GridAxes> aslant;
  std::string space;                    ///< the space of coordinates, as in VolumeGrid; usually empty
  std::string length_unit, value_unit;  ///< units, as in VolumeGrid; usually empty
  std::string remark;                   ///< what else the file holds and is not read; usually empty

  [[nodiscard]] bool has_samples() const { return !faces[0].empty(); }

  /// The names of all arrays, for messages.
  [[nodiscard]] std::string array_names() const { return names_of(arrays); }
};

/// What the caller of read_grid_file knows.
struct GridReading {
  const RawVolume* raw = nullptr;  ///< what a file is whose extension belongs to no format
  /// The name of an array that labels are taken from, whose numbers are read as runs if they are whole.
  std::string labels = {};
  bool only_array = false;  ///< whether it may have any name in a file of one array
  /// Names of arrays that are wanted, or of files; they choose among the series of a folder.
  std::vector<std::string> wanted = {};
  Vec3 stack_spacing{1, 1, 1};  ///< of a pattern of pictures
  Vec3 stack_origin{};
};

/// Reads a grid or image of any format that gives one (input_formats.h). If the format has no names of
/// arrays, the array gets the file's name. NIfTI values are scaled as their header says; axes that are
/// parallel to x, y and z are permuted and reversed so that positions are right (lay_out). Throws Error, with
/// the file's name, if the file is not complete or not of its kind. A path may be a pattern of pictures, one
/// plane in each.
GridFile read_grid_file(const std::filesystem::path& path, const GridReading& reading = {});

/// Reads a file by the library for its format: .vti, .vtr, legacy .vtk, .tif(f), DICOM and the pictures of
/// VTK. The library may crash on a corrupt file, so it runs in a child process (read_in_child).
GridFile read_grid_by_library(const std::filesystem::path& path);
/// Reads those series of a folder of DICOM that `wanted` names, as arrays of one grid (read_dicom_series).
GridFile read_series_by_library(const std::filesystem::path& path, const std::vector<std::string>& wanted);
/// Reads a file as read_grid_by_library does, but in this process. `series`: as for read_dicom().
/// `time`: as for read_zarr().
GridFile read_grid_in_process(const std::filesystem::path& path, const std::string& series = {},
                              std::optional<std::uint64_t> time = {});
/// Reads a file of VTK, TIFF or a picture in this process.
GridFile read_grid_with_vtk(const std::filesystem::path& path);

/// Reads all numeric data sets of HDF5, in a child process: those with three axes, z slowest, and those with
/// four, one of which is that of components: the shorter one of the first and the last, or the only one of
/// another length. All have to be on one grid.
GridFile read_hdf5_by_library(const std::filesystem::path& path);
/// Reads a file as read_hdf5_by_library does, but in this process.
GridFile read_hdf5_grid(const std::filesystem::path& path);

}  // namespace adamas::io
