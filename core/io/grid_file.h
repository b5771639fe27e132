#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "adamas/grid_data.h"
#include "core/data/field_values.h"
#include "core/geometry/vec3.h"

namespace adamas::io {

struct RawVolume;

/// Where the axes of a file's array lie in space: `t` along axis a leads to origin + t * directions[a].
struct GridAxes {
  std::array<Vec3, 3> directions{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 origin;
};

/// An array of a grid file, exactly: whole numbers stay so, also those of double that float has not; others
/// are float where it has them all, else double.
struct GridArray {
  std::string name;
  std::string type;  ///< as the file holds it: "uint8", "float64"
  Centering centering = Centering::kPoints;
  int components = 1;
  std::vector<std::string> component_names{};  ///< one of each component, or none where the file has not all
  /// Whole numbers as the first of these types that holds all of them (set_numbers in grid_numbers.h).
  std::variant<std::vector<float>, std::vector<std::int32_t>, std::vector<std::int64_t>,
               std::vector<std::uint64_t>, std::vector<double>>
      values;
  double slope = 1, intercept = 0;  ///< of whole numbers: a value is slope * number + intercept

  [[nodiscard]] bool scaled() const { return slope != 1 || intercept != 0; }
  /// Whether its values are whole numbers.
  [[nodiscard]] bool integral() const { return !has_fractions() && !scaled(); }
  /// Whether its numbers are of float or double.
  [[nodiscard]] bool has_fractions() const { return values.index() == 0 || values.index() == 4; }
  [[nodiscard]] std::size_t size() const {
    return std::visit([](const auto& v) { return v.size(); }, values);
  }
  /// What a number stands for.
  template <class Number>
  [[nodiscard]] double value(Number number) const {
    return scaled() ? slope * static_cast<double>(number) + intercept : static_cast<double>(number);
  }
  /// All values as float; the array is left empty.
  [[nodiscard]] std::vector<float> take_floats();
  /// All values: as float where it has them all, else as double. The array is left empty.
  [[nodiscard]] FieldValues take_field();
};

/// From all of one component after all of another to all of one site after all of another.
void interleave(GridArray& array);

/// What a file on an image or rectilinear grid holds.
struct GridFile {
  std::string kind;  ///< "VTK XML image", "NIfTI", ...
  std::array<std::vector<double>, 3> nodes;
  std::vector<GridArray> arrays;
  /// The strings of a field array "material_names", what the values of labels mean; mostly empty.
  std::vector<std::string> material_names;
  /// Of a format that has samples, which may be values at points or of the cells round them: the faces of
  /// these cells, one more than nodes. Its arrays are on points until choose_centering() is asked. Empty
  /// where the format says what its arrays are on (VTK).
  std::array<std::vector<double>, 3> faces;
  /// What the file says of its samples, by axis.
  std::array<std::optional<Centering>, 3> stated;

  /// Of a grid whose axes are not parallel to x, y and z: its nodes are places along these.
  std::optional<GridAxes> aslant;
  std::string space;   ///< what places are told in, as of VolumeGrid; mostly empty
  std::string remark;  ///< what the file holds beside and nobody reads; mostly empty

  [[nodiscard]] bool has_samples() const { return !faces[0].empty(); }

  [[nodiscard]] const GridArray* find(const std::string& name) const;
  /// Names of all arrays, for messages: "'a', 'b'".
  [[nodiscard]] std::string array_names() const;
};

/// Reads a grid or image of any format that gives one (input_formats.h). The array of a format that names
/// none is called like the file. NIfTI values are scaled as their header says; axes that are parallel to x, y
/// and z are exchanged and reversed so that positions are right (lay_out). Throws Error, with the file's
/// name, at anything that is not a whole file of its kind.
/// `raw` says what a file is whose name ends as no format's; null where nobody knows.
GridFile read_grid_file(const std::filesystem::path& path, const RawVolume* raw = nullptr);

/// What a library reads, by the ending of the file's name: .vti, .vtr, legacy .vtk, .tif(f) and the pictures
/// of VTK. It may crash on a corrupt file, so that it works in a child process (read_in_child).
GridFile read_grid_by_library(const std::filesystem::path& path);
/// The same without the child process.
GridFile read_grid_with_vtk(const std::filesystem::path& path);

/// All data sets of numbers of HDF5 along three axes, z slowest, and along four, of which the shorter one of
/// the first and the last is that of components, or the only one of another length; all on the same grid. In
/// a child process too.
GridFile read_hdf5_by_library(const std::filesystem::path& path);
GridFile read_hdf5_grid(const std::filesystem::path& path);

}  // namespace adamas::io
