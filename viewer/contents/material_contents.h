#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/progress.h"
#include "core/data/interface_mesh.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "viewer/contents/drawn_mesh.h"

namespace adamas::viewer {

/// The visible contents of a file with several materials: the interfaces between them, cross sections, and
/// the values at a point. They do not change, so that several threads may read them at once.
class MaterialContents {
 public:
  /// Opens a resampled mesh (.vtu), a saved hierarchy (.h5), whose whole mesh is shown, or an interface mesh
  /// (.vtp, .ply, .arec, .txt), of which faulty parts are shown as well as possible. Throws Error for another
  /// file, and Cancelled if the progress asks for it.
  static std::unique_ptr<MaterialContents> open(const std::string& path, Progress& progress);
  /// Whether a file is of one of these kinds, by its name and its first bytes.
  [[nodiscard]] static bool can_open(const std::string& path);

  virtual ~MaterialContents() = default;

  /// The names of the materials, by number.
  [[nodiscard]] virtual const std::vector<std::string>& materials() const = 0;
  /// The names of the fields that can be shown, in the form of find_field: "density", "velocity" (its
  /// length), "velocity:0" and so on. Interface meshes have none.
  [[nodiscard]] virtual const std::vector<std::string>& fields() const = 0;
  /// The domain. The domain of interface meshes is their box, a little larger on the sides on which no
  /// interface ends.
  [[nodiscard]] virtual Box3 box() const = 0;
  /// The size as a text: "36,426 tetrahedra, 8,011 points, 3 materials"; for interface meshes "12,345
  /// triangles, ...".
  [[nodiscard]] virtual std::string summary() const = 0;
  /// The least and the greatest finite value of a field that materials have in their own regions; for a
  /// length, the least one at vertices and on interfaces. NaN if there are none.
  [[nodiscard]] virtual std::pair<double, double> field_range(std::size_t field) const = 0;

  /// The interface between two materials, by their numbers; front < back.
  struct Interface {
    std::size_t front = 0, back = 0;
    SharedMesh mesh;
    double area = 0;
  };
  /// The interfaces, in the order of their materials. Normals are averages over the triangles round a point,
  /// but not over creases. With a field, a side has the values of the material that is seen from there, which
  /// lies behind the triangle.
  [[nodiscard]] virtual std::vector<Interface> interfaces(std::optional<std::size_t> field) const = 0;

  /// A cross section. The front of its polygons is on the side to which the plane's normal points; with a
  /// field, both sides have its values.
  struct Section {
    std::vector<SharedMesh> materials;  ///< the parts by material; null if the plane does not intersect it
    SharedMesh cell_edges, interface_edges;  ///< lines; null if there are none
  };
  /// The cross section by a plane, empty if the plane does not cut the box. Interface meshes have neither
  /// values nor edges of cells.
  [[nodiscard]] virtual Section section(const Plane& plane, std::optional<std::size_t> field) const = 0;

  /// The known values at a point; unknown ones are NaN.
  struct Reading {
    std::optional<std::size_t> material;  ///< the material by number; empty outside the box
    double value = std::numeric_limits<double>::quiet_NaN();  ///< the value of the chosen field
    /// The estimated error of the interfaces in the cell.
    double interface_error = std::numeric_limits<double>::quiet_NaN();
    /// The error of the chosen field in the cell.
    double field_error = std::numeric_limits<double>::quiet_NaN();
  };
  [[nodiscard]] virtual Reading at(const Vec3& p, std::optional<std::size_t> field) const = 0;
};

/// The contents of a resampled mesh.
std::unique_ptr<MaterialContents> make_resampled_contents(interfaces::ResampledMesh mesh, Progress& progress);

/// The contents of given interfaces, which are repaired if possible. Throws Error, naming their source, if
/// they have no triangle between two materials, and for numbers that make no mesh.
std::unique_ptr<MaterialContents> make_network_contents(InterfaceMesh mesh, Progress& progress);

}  // namespace adamas::viewer
