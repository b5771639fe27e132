#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adamas/error_target.h"
#include "adamas/export.h"
#include "adamas/fractions.h"
#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "adamas/input.h"
#include "adamas/meshes.h"
#include "adamas/progress.h"

namespace adamas ADAMAS_API {

/// The way in which a material's field is continued to vertices outside of the material (docs/method.md,
/// Fields and ghost values; "D" is the dissertation that it names).
enum class GhostMode {
  kConstant,      ///< the value at the closest point of the material's interfaces (D 3.5.1)
  kLinear,        ///< the value at the closest point, plus the one-sided gradient there times the offset
  kLeastSquares,  ///< a linear fit to the material's native data round that point
};

/// The definition of the distance between a vertex and an interface.
enum class DistanceMode {
  kExact,          ///< the distance to the closest point of the interface
  kNearestVertex,  ///< the distance to the nearest vertex of its mesh (D 3.4.1)
};

/// The options of `adamas resample`, with the same defaults.
struct ResampleOptions {
  /// Greatest distance between the interfaces and their approximation: a length, a part of the domain's
  /// diagonal, or in voxels of the input's grid; positive and less than the diagonal.
  ErrorTarget interface_error{0.01, ErrorTarget::Unit::kPart};
  /// Greatest errors of fields by name, in the field's unit or as a part of its range; an error that is not
  /// above 0 means no limit.
  std::vector<std::pair<std::string, ErrorTarget>> field_errors{};
  std::optional<std::size_t> max_tetrahedra{};  ///< refinement stops at this number, whatever the errors
  GhostMode ghost = GhostMode::kConstant;
  DistanceMode distance = DistanceMode::kExact;
  /// Move the interfaces, within the interface error, until every body has its volume in the input. If this
  /// is set, a body that cannot have its volume is an error that was not reached. None: interfaces of volume
  /// fractions are moved, as far as bodies can have their volumes, unless errors of fields are wanted, which
  /// the moves may spoil; those of labels and given ones are not.
  std::optional<bool> conserve{};
  /// Greatest relative difference of every body's volume from that in the input: above 0 and less than 1.
  /// Cells are split for it, besides the interface error. None: no limit.
  std::optional<double> volume_error{};
  /// Reconstruct interfaces of labels without the staircase of voxels, within half a voxel of it along each
  /// axis. Only labels have this option.
  bool smooth_labels = false;
  FractionOptions fractions{};
};

/// The reason why a wanted error was not reached, and the place of the greatest error.
struct Shortfall {
  std::string reason;  ///< a few words
  Vec3 place;
};

/// A wanted error that was not reached.
struct UnreachedError {
  std::string what;  ///< "the interface error wanted" and the like
  double found = 0, wanted = 0;
  Shortfall shortfall;
};

/// A two-sided distance between the interfaces of the input and of a mesh; infinite where the mesh has none.
struct MeasuredDistance {
  double certified = 0;                  ///< upper bound: no point of either is farther from the other
  double found = 0;                      ///< lower bound, which is attained somewhere
  std::optional<Shortfall> shortfall{};  ///< none where the distance is within the error wanted
};

/// Counts of the diamonds of a mesh that was adapted to other data.
struct Adaptation {
  std::size_t kept = 0;    ///< diamonds that were split before and are split afterwards
  std::size_t merged = 0;  ///< diamonds that were split only before
  std::size_t split = 0;   ///< diamonds that are split only afterwards
};

/// Describes the quality of a mesh: the figures that `adamas resample --json` writes, by the same names.
/// None: a figure is not known, since there are no interfaces, no junctions or no input to compare with.
struct ResampleReport {
  std::string input;  ///< the name of the input
  std::size_t tetrahedra = 0, vertices = 0;
  std::size_t interface_tetrahedra = 0;  ///< tetrahedra that an approximated interface runs through
  std::size_t lost_interfaces = 0;       ///< cells whose interface the mesh does not show
  std::size_t flagged_vertices = 0;      ///< vertices whose material rests on an open border of the input

  double interface_error_target = 0;                ///< in units of length
  std::optional<MeasuredDistance> interface_error;  ///< the distance of all interfaces together
  /// The greatest of the materials' boundaries.
  std::optional<MeasuredDistance> interface_error_per_material;
  std::optional<MeasuredDistance> junction_error;  ///< the distance of the lines where three materials meet
  std::optional<std::string> worst_material;       ///< the material whose boundary is farthest off
  std::optional<std::size_t> interface_triangles;  ///< triangles of the interfaces that the mesh shows

  /// A connected part of a material of the input, and what the mesh shows of it.
  struct Body {
    std::size_t material = 0;            ///< its number in `materials`
    std::optional<double> volume_input;  ///< volume in the input, in the cube of the unit of length
    double volume_mesh = 0;
    BodyTopology topology_input, topology_mesh;  ///< zero where `topology_known` is not set
    Vec3 place;                                  ///< a point of the body's boundary in the input
    bool lost = false;                           ///< the mesh shows nothing of it
    bool changed = false;                        ///< it is torn, or has other holes or handles
    /// The reason why its volume is not within the wanted volume error, and `place`; none where it is, or
    /// where no error is wanted.
    std::optional<Shortfall> missed_volume{};

    /// Returns the difference of its volumes in the mesh and in the input, which must be known.
    [[nodiscard]] double missing() const;
    /// Returns this difference relative to the volume in the input; 0 where that is not above 0.
    [[nodiscard]] double volume_error() const;
  };
  std::vector<Body> bodies;
  /// Returns whether a body has its volume in the input, which must be known, up to `conservation_tolerance`,
  /// which must be set.
  [[nodiscard]] bool is_conserved(const Body& body) const;
  bool topology_known = false;  ///< whether bodies were compared
  /// Whether the input's interfaces are closed, so that `euler` is comparable.
  bool topology_comparable = false;
  std::vector<std::array<std::size_t, 2>> contacts;  ///< bodies that touch in the mesh alone
  std::optional<double> volume_error_target;         ///< the wanted relative volume error of every body
  std::optional<std::size_t> worst_volume;           ///< the body with the greatest volume error
  /// If interfaces were moved to conserve volumes: the difference that counts as none, in the cube of the
  /// unit of length.
  std::optional<double> conservation_tolerance;
  bool conservation_wanted = false;  ///< whether ResampleOptions::conserve was set

  struct Material {
    std::string name;
    std::optional<double> volume_input;  ///< volume in the input, in the cube of the unit of length
    double volume_mesh = 0;
    bool lost = false;  ///< the input has the material, and the mesh shows nothing of it
  };
  std::vector<Material> materials;

  /// Errors of a field at places where the input states values, in the field's unit; NaN where there are no
  /// such places.
  struct Errors {
    double max_error = 0, mean_error = 0;
    double reducible_max_error = 0;  ///< the greatest error that smaller cells would lower
  };
  struct Field {
    std::string name, unit;
    std::optional<double> target;
    Errors everywhere, at_interfaces;  ///< errors at all places, and in cells with an interface
    /// The numbers of places in cells of the input with one material; in cells with several, of the material
    /// with the largest part; and of their other materials.
    std::size_t pure = 0, mixed = 0, minority = 0;
    std::size_t displaced = 0;      ///< places among these that the mesh gives to another material
    std::size_t without_value = 0;  ///< places without a value, which do not count
    std::optional<Shortfall> shortfall{};

    [[nodiscard]] std::size_t count() const { return pure + mixed + minority; }
  };
  std::vector<Field> fields;

  /// The errors of interfaces, of the boundary of the worst material, of junction lines and of fields that
  /// were wanted and not reached.
  std::vector<UnreachedError> unreached;
  /// Findings about the volume fractions that interfaces were reconstructed from.
  std::optional<FractionFindings> fractions;
  /// The changes of the mesh that refinement began with; none where it began with the coarsest mesh.
  std::optional<Adaptation> adaptation{};
};

/// An adaptive tetrahedral mesh with sharp material interfaces inside its cells, and each material's own
/// fields. Its arrays are made when they are first asked for, and it owns them; spans and views are valid as
/// long as it is. Several threads may read one mesh.
///
/// A mesh that resample() has made of an Input also keeps the input and the data of refinement, for results
/// that need them: the input's interfaces and integrals, the hierarchy (multiresolution_mesh()), the distance
/// of cut meshes from the input, and the next step of a series. release_input() frees them.
class AdaptiveMesh {
 public:
  AdaptiveMesh(AdaptiveMesh&&) noexcept;
  AdaptiveMesh& operator=(AdaptiveMesh&&) noexcept;
  ~AdaptiveMesh();

  [[nodiscard]] std::span<const Vec3> points() const;
  /// Returns the indices of the points of each tetrahedron, positively oriented.
  [[nodiscard]] std::span<const std::array<std::uint32_t, 4>> tetrahedra() const;
  /// Returns the names of the materials, by number.
  [[nodiscard]] std::span<const std::string> materials() const;
  [[nodiscard]] const std::vector<FieldDescription>& fields() const;
  [[nodiscard]] const Box3& domain() const;
  /// Returns the quality of the mesh. The report of a mesh that was selected from a hierarchy has only the
  /// name of the input, the wanted interface error, and the numbers of tetrahedra and vertices.
  [[nodiscard]] const ResampleReport& report() const;
  /// Returns all arrays, with the names and meanings of the `.vtu` that `adamas resample` writes
  /// (docs/file_formats.md, The resampled mesh): for tetrahedra `material` (-1 where interfaces cross one)
  /// and `interface error`, for points FIELD and `FIELD in MATERIAL`, and so on; written by adamas::io, they
  /// are that file. They are computed at the first call.
  [[nodiscard]] const TetrahedraView& view() const;
  /// Returns one of these arrays. Throws Error where none has that name.
  [[nodiscard]] const ArrayView& point_array(std::string_view name) const;
  [[nodiscard]] const ArrayView& cell_array(std::string_view name) const;

  /// Returns the interfaces that the mesh shows, closed up to the domain's boundary (docs/method.md, Who owns
  /// a point of a cell). Their bodies, and those of the input's interfaces, have the numbers of the report's.
  [[nodiscard]] InterfaceTriangles interfaces(Progress& progress = SilentProgress::instance()) const;
  /// Returns the interfaces of the input, welded. Throws Error where the input is not kept.
  [[nodiscard]] InterfaceTriangles input_interfaces() const;
  /// Returns the mesh cut along its interfaces, without slivers (docs/method.md, Cut meshes). `tolerance`:
  /// the greatest distance of the faces between materials from the mesh's interfaces, in units of length;
  /// positive. None: half of the wanted interface error.
  [[nodiscard]] MaterialTetrahedra cut_mesh(std::optional<double> tolerance = {},
                                            Progress& progress = SilentProgress::instance()) const;

  /// Returns whether the input and the data of refinement are kept.
  [[nodiscard]] bool has_input() const;
  /// Frees the memory of the input and of the data of refinement; the mesh itself remains.
  void release_input();

  /// The library itself uses the members below.
  struct Contents;
  explicit AdaptiveMesh(std::unique_ptr<Contents> contents);
  [[nodiscard]] Contents& contents() const { return *contents_; }

 private:
  std::unique_ptr<Contents> contents_;
};

/// Resamples an input within errors (docs/method.md). The result does not depend on the number of threads. An
/// input that is moved here and has no copies is used up: parts that are no longer needed are freed early.
/// Given interfaces are repaired in a copy, as their MendingOptions say: small gaps are closed, triangles of
/// wrong orientation and duplicate triangles are repaired, and the progress gets notes of it. Throws Error at
/// options that do not suit the input (an error that is not positive or greater than the domain, a field that
/// it does not have, fewer tetrahedra than the coarsest mesh has), at given interfaces whose materials do not
/// match round an edge or whose triangles intersect, and Cancelled where the progress says so.
AdaptiveMesh resample(Input input, const ResampleOptions& options = {},
                      Progress& progress = SilentProgress::instance());

/// Resamples an input as the next step of a series: cells are merged and split from a mesh on that keeps its
/// input, which is used up. The result is that of the function above, to the last bit, and takes less time
/// where the two steps are alike. Throws Error where the mesh keeps no input, or the input has another
/// domain.
AdaptiveMesh resample(Input input, AdaptiveMesh&& previous, const ResampleOptions& options = {},
                      Progress& progress = SilentProgress::instance());

/// Resamples data on a grid. Nothing of the data is kept.
AdaptiveMesh resample(const GridData& data, const ResampleOptions& options = {},
                      Progress& progress = SilentProgress::instance());

/// Resamples given interfaces in a domain, without fields. Nothing of the input is kept.
AdaptiveMesh resample(const InterfaceTriangles& interfaces, const Box3& domain,
                      const ResampleOptions& options = {}, Progress& progress = SilentProgress::instance());

/// Checks options. Throws Error where they do not suit an input, as resample() does before its work: of the
/// kind kUsage for values that are not allowed, and of the kind kInput for a field that the input does not
/// have and for an error of a field that is not finite.
void check(const ResampleOptions& options, const Input& input);

}  // namespace adamas
