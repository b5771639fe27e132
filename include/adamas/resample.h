#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adamas/fractions.h"
#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "adamas/meshes.h"
#include "adamas/progress.h"

namespace adamas {

/// How a material's field is continued to vertices outside of the material (docs/method.md, Fields and ghost
/// values; "D" is the dissertation that it names).
enum class GhostMode {
  kConstant,      ///< the value at the closest point of the material's interfaces (D 3.5.1)
  kLinear,        ///< that, plus the one-sided gradient there times the offset
  kLeastSquares,  ///< a linear fit to the material's native data round that point
};

/// What vertices measure.
enum class DistanceMode {
  kExact,          ///< to the closest point of the interface
  kNearestVertex,  ///< to the nearest vertex of its mesh (D 3.4.1)
};

/// The options of `adamas resample`, with the same defaults. Errors are absolute.
struct ResampleOptions {
  /// Greatest distance between the interfaces and their approximation, in units of length; positive and less
  /// than the domain's diagonal. None: 1% of the diagonal.
  std::optional<double> interface_error;
  /// Greatest errors of fields by name, in the field's unit. Not more than 0, or a field of one value
  /// everywhere: not wanted.
  std::vector<std::pair<std::string, double>> field_errors{};
  std::optional<std::size_t> max_tetrahedra{};  ///< to stop at, whatever the errors
  GhostMode ghost = GhostMode::kConstant;
  DistanceMode distance = DistanceMode::kExact;
  /// Move the interfaces, within the interface error, until every body has its volume in the input.
  bool conserve = false;
  /// Greatest difference of every body's volume from that in the input, in relation to this: above 0 and less
  /// than 1. Cells are split for it, besides the interface error. None: not wanted.
  std::optional<double> volume_error{};
  /// Of labels: interfaces without the staircase of voxels, within half a voxel of it along each axis.
  bool smooth_labels = false;
  FractionOptions fractions{};
};

/// A two-sided distance between the interfaces of the input and of a mesh; infinite where the mesh shows
/// none.
struct MeasuredDistance {
  double certified = 0;  ///< no point of either is farther from the other
  double found = 0;      ///< attained somewhere
};

/// What a mesh is worth: the figures that `adamas resample --json` writes, by the same names. None: not
/// known, since there are no interfaces, no junctions or no input to compare with.
struct ResampleReport {
  std::size_t interface_tetrahedra = 0;             ///< that an approximated interface runs through
  double interface_error_target = 0;                ///< in units of length
  std::optional<MeasuredDistance> interface_error;  ///< of all interfaces together
  std::optional<MeasuredDistance>
      interface_error_per_material;                ///< the greatest of the materials' boundaries
  std::optional<MeasuredDistance> junction_error;  ///< of the lines where three materials meet
  /// Why one of these was not reached, in a few words; empty where all were.
  std::string shortfall;
  std::size_t lost_interfaces = 0;  ///< cells whose interface the mesh does not show
  /// Connected parts of the materials in the input; those of which the mesh shows nothing; those that are
  /// torn or have other holes; pairs that touch in the mesh alone.
  std::size_t bodies = 0, lost_bodies = 0, changed_bodies = 0, contacts = 0;
  struct Material {
    std::string name;
    std::optional<double> volume_input;
    double volume_mesh = 0;  ///< in the cube of the unit of length
  };
  std::vector<Material> materials;
  std::optional<double> volume_error_target;
  std::optional<double> volume_error;  ///< the greatest of a body, in relation to its volume in the input
  /// A body whose volume is not as wanted.
  struct MissedVolume {
    std::string material;
    Vec3 place;  ///< a point of its boundary in the input
    double volume_input = 0, volume_mesh = 0;
    std::string reason;
  };
  std::vector<MissedVolume> missed_volumes;
  /// Errors at the places where the input states values, in the field's unit; NaN where there are none.
  struct Field {
    std::string name;
    std::optional<double> target;
    double max_error = 0, mean_error = 0;
    double interface_max_error = 0, interface_mean_error = 0;  ///< in cells with an interface
  };
  std::vector<Field> fields;
  std::optional<FractionFindings> fractions;  ///< of volume fractions that interfaces were reconstructed from
};

/// An adaptive tetrahedral mesh with sharp material interfaces inside its cells, and each material's own
/// fields. It owns its arrays; spans and views are valid as long as it is. Several threads may look at one.
class AdaptiveMesh {
 public:
  AdaptiveMesh(AdaptiveMesh&&) noexcept;
  AdaptiveMesh& operator=(AdaptiveMesh&&) noexcept;
  ~AdaptiveMesh();

  [[nodiscard]] std::span<const Vec3> points() const;
  /// Indices of points; positively oriented.
  [[nodiscard]] std::span<const std::array<std::uint32_t, 4>> tetrahedra() const;
  /// The names of the materials, by number.
  [[nodiscard]] std::span<const std::string> materials() const;
  [[nodiscard]] const ResampleReport& report() const;
  /// All arrays, with the names and meanings of the `.vtu` that `adamas resample` writes
  /// (docs/file_formats.md, The resampled mesh): of tetrahedra `material` (-1 where interfaces cross one) and
  /// `interface error`, of points FIELD and `FIELD in MATERIAL`, and so on; written by adamas::io, they are
  /// that file. They are worked out at the first call.
  [[nodiscard]] const TetrahedraView& view() const;
  /// One of these arrays. Throws Error where there is none of that name.
  [[nodiscard]] const ArrayView& point_array(std::string_view name) const;
  [[nodiscard]] const ArrayView& cell_array(std::string_view name) const;

  /// The interfaces that the mesh shows, closed up to the domain's boundary (docs/method.md, Who owns a point
  /// of a cell).
  [[nodiscard]] InterfaceTriangles interfaces(Progress& progress = SilentProgress::instance()) const;
  /// The mesh cut along its interfaces, without slivers (docs/method.md, Cut meshes). `tolerance`: how far
  /// the faces between materials may be from the mesh's interfaces, in units of length; positive. None: half
  /// of the interface error wanted.
  [[nodiscard]] MaterialTetrahedra cut_mesh(std::optional<double> tolerance = {},
                                            Progress& progress = SilentProgress::instance()) const;

  /// For the library's own use.
  struct Contents;
  explicit AdaptiveMesh(std::unique_ptr<Contents> contents);
  [[nodiscard]] const Contents& contents() const { return *contents_; }

 private:
  std::unique_ptr<Contents> contents_;
};

/// Resamples data within errors (docs/method.md). Nothing of the data is kept. The result does not depend on
/// the number of threads. Throws Error at data that check() refuses, at options that say nothing here (an
/// error that is not positive or greater than the domain, a field that there is not, fewer tetrahedra than
/// the coarsest mesh has), and Cancelled where the progress says so.
AdaptiveMesh resample(const GridData& data, const ResampleOptions& options = {},
                      Progress& progress = SilentProgress::instance());

/// The same of given interfaces in a domain, without fields. Gaps of up to a millionth of the domain's
/// diagonal are closed, triangles that are turned the wrong way or are there twice are mended, in a copy.
/// Throws Error too at arrays that do not fit each other, a domain without volume or apart from the
/// interfaces, materials that do not match round an edge, and triangles that intersect.
AdaptiveMesh resample(const InterfaceTriangles& interfaces, const Box3& domain,
                      const ResampleOptions& options = {}, Progress& progress = SilentProgress::instance());

}  // namespace adamas
