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

namespace adamas::io {

/// The axes of a file's array in space: `t` along axis a leads to origin + t * directions[a].
struct GridAxes {
  std::array<Vec3, 3> directions{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 origin;
};

/// An array of a grid file without loss: whole numbers are kept as such, also doubles that a float does not
/// represent; others are floats where these represent them all, else doubles.
struct GridArray {
  std::string name;
  std::string type;  ///< the type in the file: "uint8", "float64"
  Centering centering = Centering::kPoints;
  int components = 1;
  std::vector<std::string>
      component_names{};  ///< a name for each component, or none where the file does not name all
  /// The numbers; whole ones in the first of these types that holds all of them (set_numbers in
  /// grid_numbers.h).
  std::variant<std::vector<float>, std::vector<std::int32_t>, std::vector<std::int64_t>,
               std::vector<std::uint64_t>, std::vector<double>>
      values;
  double slope = 1, intercept = 0;  ///< the scale of whole numbers: a value is slope * number + intercept

  [[nodiscard]] bool scaled() const { return slope != 1 || intercept != 0; }
  /// Whether its values are whole numbers.
  [[nodiscard]] bool integral() const { return !has_fractions() && !scaled(); }
  /// Whether its numbers are of float or double.
  [[nodiscard]] bool has_fractions() const { return values.index() == 0 || values.index() == 4; }
  [[nodiscard]] std::size_t size() const {
    return std::visit([](const auto& v) { return v.size(); }, values);
  }
  /// The value that a number stands for.
  template <class Number>
  [[nodiscard]] double value(Number number) const {
    return scaled() ? slope * static_cast<double>(number) + intercept : static_cast<double>(number);
  }
  /// Takes all values as floats; the array is left empty.
  [[nodiscard]] std::vector<float> take_floats();
  /// Takes all values, as floats where these represent them all, else as doubles. The array is left empty.
  [[nodiscard]] FieldValues take_field();
};

/// Reorders numbers that are sorted by component, then by site, to numbers sorted by site, then by component.
void interleave(GridArray& array);

/// The content of a file on an image or rectilinear grid.
struct GridFile {
  std::string kind;  ///< "VTK XML image", "NIfTI", ...
  std::array<std::vector<double>, 3> nodes;
  std::vector<GridArray> arrays;
  /// The strings of a field array "material_names", which name the values of labels; mostly empty.
  std::vector<std::string> material_names;
  /// The faces of the cells round the samples, one more than nodes, in a format whose samples may be values
  /// at points or of cells. The arrays are on points until choose_centering() is called. Empty where the
  /// format says which they are (VTK).
  std::array<std::vector<double>, 3> faces;
  /// The centering that the file states for its samples, by axis.
  std::array<std::optional<Centering>, 3> stated;

  /// The axes of a grid that are not parallel to x, y and z; `nodes` are positions along these axes then.
  std::optional<GridAxes> aslant;
  std::string space;   ///< the space of coordinates, as of VolumeGrid; mostly empty
  std::string remark;  ///< what else the file holds and is not read; mostly empty

  [[nodiscard]] bool has_samples() const { return !faces[0].empty(); }

  /// The names of all arrays, for messages: "'a', 'b'".
  [[nodiscard]] std::string array_names() const;
};

/// Reads a grid or image of any format that gives one (input_formats.h). The array of a format that names
/// none is called like the file. NIfTI values are scaled as their header says; axes that are parallel to x, y
/// and z are exchanged and reversed so that positions are right (lay_out). Throws Error, with the file's
/// name, at anything that is not a whole file of its kind.
/// `raw` describes a file whose name ends as no format's; null where that is not known.
GridFile read_grid_file(const std::filesystem::path& path, const RawVolume* raw = nullptr);

/// Reads a file by a library that the ending of its name selects: .vti, .vtr, legacy .vtk, .tif(f) and the
/// pictures of VTK. The library may crash on a corrupt file, so that it runs in a child process
/// (read_in_child).
GridFile read_grid_by_library(const std::filesystem::path& path);
/// Reads such a file in this process.
GridFile read_grid_with_vtk(const std::filesystem::path& path);

/// Reads all data sets of numbers of HDF5, in a child process: those along three axes, z slowest, and those
/// along four, of which the shorter one of the first and the last, or the only one of another length, is that
/// of components. All have to be on one grid.
GridFile read_hdf5_by_library(const std::filesystem::path& path);
/// Reads such a file in this process.
GridFile read_hdf5_grid(const std::filesystem::path& path);

}  // namespace adamas::io
