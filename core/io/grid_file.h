#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "adamas/grid_data.h"
#include "core/geometry/vec3.h"

namespace adamas {

/// Where the axes of a file's array lie in space: `t` along axis a leads to origin + t * directions[a].
struct GridAxes {
  std::array<Vec3, 3> directions{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 origin;
};

/// An array of a grid file: whole numbers that fit stay so, everything else becomes float.
struct GridArray {
  std::string name;
  std::string type;  ///< as the file holds it: "uint8", "float64"
  Centering centering = Centering::kPoints;
  int components = 1;
  std::variant<std::vector<float>, std::vector<std::int32_t>> values;

  [[nodiscard]] bool integral() const { return values.index() == 1; }
  [[nodiscard]] std::size_t size() const {
    return std::visit([](const auto& v) { return v.size(); }, values);
  }
  /// All values as float; the array is left empty.
  [[nodiscard]] std::vector<float> take_floats();
};

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
GridFile read_grid_file(const std::filesystem::path& path);

/// What a library reads, by the ending of the file's name: .vti, .vtr, legacy .vtk, .tif(f) and the pictures
/// of VTK. It may crash on a corrupt file, so that it works in a child process (read_in_child).
GridFile read_grid_by_library(const std::filesystem::path& path);
/// The same without the child process.
GridFile read_grid_with_vtk(const std::filesystem::path& path);

}  // namespace adamas
