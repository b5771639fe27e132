#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "core/data/rectilinear_grid.h"

namespace adamas {

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

  [[nodiscard]] const GridArray* find(const std::string& name) const;
  /// Names of all arrays, for messages: "'a', 'b'".
  [[nodiscard]] std::string array_names() const;
};

/// Reads .vti, .vtr, legacy .vtk, .nrrd, .nhdr, .mhd, .mha, .nii, .nii.gz, .tif(f) and the other image
/// formats of VTK, in a child process (read_in_child). The array of a format that names none is called like
/// the file. NIfTI values are scaled as their header says; axes that are parallel to x, y and z
/// are exchanged and reversed so that positions are right, and others refused. Throws Error, with the file's
/// name, at anything that is not a whole file of its kind.
GridFile read_grid_file(const std::filesystem::path& path);

}  // namespace adamas
