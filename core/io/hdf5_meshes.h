#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "core/io/mesh_file.h"

namespace adamas::io {

class Hdf5Handle;

/// Numbers of a data set of HDF5.
struct Numbers {
  std::string type;  ///< in the file: "int32", "float64"
  std::vector<std::uint64_t> size;
  std::vector<double> values;

  [[nodiscard]] std::uint64_t row() const {
    return size.empty() || size[0] == 0 ? 0 : values.size() / size[0];
  }
};

/// Reads files of HDF5 with meshes, in the child.
class Hdf5Meshes {
 public:
  explicit Hdf5Meshes(const std::filesystem::path& path);

  [[nodiscard]] const std::string& name() const { return name_; }

  /// Whether there is an object, each group of whose path is there too.
  [[nodiscard]] bool has(const std::string& path) const;
  /// Finds the type and the size of a data set, without its values; none if it has no numbers.
  [[nodiscard]] std::optional<Numbers> look_at(const std::string& path) const;
  /// Reads a data set or, of several along its first axis, that of this number. Throws Error if it is none of
  /// numbers, or larger than the file can hold.
  [[nodiscard]] Numbers read(const std::string& path, std::optional<std::uint64_t> of_first = {}) const;
  /// The text of an attribute, without blanks at its end; empty if there is none.
  [[nodiscard]] std::string text(const std::string& path, const std::string& attribute) const;
  /// The numbers of an attribute. Throws Error unless it has `count` finite ones.
  [[nodiscard]] std::vector<double> attribute(const std::string& path, const char* name,
                                              std::size_t count) const;
  /// The names in a group, in natural order.
  [[nodiscard]] std::vector<std::string> names(const std::string& group) const;
  /// The paths, from a group on, of all data sets of numbers in it and in groups of it, in natural order; at
  /// most some thousands.
  [[nodiscard]] std::vector<std::string> data_sets(const std::string& group) const;
  /// The time that a group states; none if it states none.
  [[nodiscard]] std::optional<double> time_of(const std::string& group) const;

 private:
  std::string name_;
  std::size_t bytes_;
  std::shared_ptr<const Hdf5Handle> file_;
};

/// Adds an array of these numbers to a mesh.
void add_array(std::string name, Centering centering, const Numbers& numbers, int components, MeshFile& file);

/// What has become of the points of a file.
struct MergedPoints {
  std::vector<std::uint32_t> numbers;  ///< of each point of the file, in the mesh
  std::vector<std::size_t> taken;      ///< the point of the file that each one of the mesh is
};

/// Adds points to a mesh without any; those at one place are one, since meshes are cut along internal
/// interfaces. Throws Error, which begins with `name`, if they are not finite.
MergedPoints add_merged_points(const std::string& name, const std::vector<Vec3>& points, MeshFile& file);
/// The rows of these numbers.
Numbers rows_of(const Numbers& all, std::span<const std::size_t> rows);

}  // namespace adamas::io
