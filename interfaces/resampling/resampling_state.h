#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "interfaces/cell_errors/field_error.h"
#include "interfaces/cell_errors/interface_error.h"
#include "interfaces/hierarchy/hierarchy.h"
#include "interfaces/input/resampling_source.h"
#include "interfaces/mesh/interface_extraction.h"

namespace adamas::interfaces {

struct ResamplingOptions {
  double interface_error = 0;                       ///< wanted, in units of length; positive
  std::vector<std::optional<double>> field_errors;  ///< wanted, per field of the source, in the field's unit
  std::optional<std::size_t> max_tetrahedra;
  GhostMode ghost = GhostMode::kConstant;
  DistanceMode distance = DistanceMode::kExact;
  /// Interfaces are moved, within the interface error and by one offset per body, until each body has the
  /// volume that it has in the input. The source must know these volumes.
  bool conserve = false;
  /// The greatest difference of a body's volume from that in the input, in relation to the latter. The source
  /// must know these volumes.
  std::optional<double> volume_error;
  bool certify = true;  ///< measure the interfaces' distance in the end, and refine where it is too great
};

/// What is known of one tetrahedron of the hierarchy.
struct CellRecord {
  std::vector<std::uint32_t> triangles;  ///< triangles of the network that meet the cell; in leaves only
  /// The cell's native elements: a range of ResamplingState::element_order.
  std::uint32_t first_element = 0, last_element = 0;
  InterfaceError interface;
  std::vector<FieldError> fields;  ///< empty where not measured
  /// Cells larger than this must show the interfaces in them; falls where measuring has found one missing.
  double trusted = std::numeric_limits<double>::infinity();
  bool evaluated = false;  ///< the triangles and the interface error are up to date
};

/// The roots of a cube follow each other round its diagonal, so that each has the cube's bounding box.
inline constexpr std::size_t kRootsOfCube = 6;

/// The hierarchy of cells with what its vertices and tetrahedra know.
using MeshHierarchy = Hierarchy<VertexRecord, CellRecord>;

/// The plane that divides a tetrahedron's two children.
struct SplitPlane {
  Vec3 normal;  ///< points into the first child
  Vec3 origin;
  /// The number of the child, 0 or 1, that a point of the tetrahedron is given to.
  [[nodiscard]] std::size_t side(const Vec3& p) const { return dot(normal, p - origin) >= 0 ? 0 : 1; }
};

/// What the parts of resampling share: what is resampled and for which errors, the hierarchy with its
/// payload, and what this payload was worked out from.
struct ResamplingState {
  /// The source must outlive the state. Throws Error for an interface error or an error of volumes that is
  /// not positive, and for a limit below the number of the roots.
  ResamplingState(const ResamplingSource& source, ResamplingOptions options, Progress& progress);

  /// The part of the interface error that estimates are held to.
  [[nodiscard]] double estimate_target() const;
  /// A tetrahedron of the tree, leaf or not, in space.
  [[nodiscard]] Tetrahedron frame(TetrahedronId t) const;
  /// Finds who owns what of a tetrahedron of the tree, leaf or not.
  void ownership(TetrahedronId t, CellOwnership& result) const;
  [[nodiscard]] std::vector<TetrahedronId> leaves() const;
  /// These tetrahedra with what their vertices know; valid until the hierarchy changes.
  [[nodiscard]] CellSet cells(std::vector<TetrahedronId> tetrahedra) const;
  /// The volume of each body in the leaves.
  [[nodiscard]] IdVector<BodyId, double> volumes() const;
  /// The vertices of these tetrahedra, ascending.
  [[nodiscard]] std::vector<VertexId> corners(const std::vector<TetrahedronId>& tetrahedra) const;
  [[nodiscard]] SplitPlane split_plane(TetrahedronId t) const;
  /// The root that holds a point, or is closest to it.
  [[nodiscard]] TetrahedronId root_at(const Vec3& p) const;
  /// The leaf that holds a point.
  [[nodiscard]] TetrahedronId leaf_at(const Vec3& p) const;
  /// Adds the leaf that holds a point to the list, unless its diameter is no more than `finest`.
  void add_leaf_at(const Vec3& p, double finest, std::vector<TetrahedronId>& list) const;
  /// Reports a stage with the number of leaves. Throws Cancelled where the progress says so.
  void report(std::string_view stage) const;

  const ResamplingSource& source;
  ResamplingOptions options;
  Progress& progress;
  MeshHierarchy hierarchy;
  std::vector<Tetrahedron> root_frames;
  std::vector<std::uint32_t> element_order;  ///< native elements, those of each tetrahedron side by side
  IdVector<InterfaceId, double> shifts;      ///< added to signed distances, so that volumes agree
  bool conserves = false;                    ///< interfaces are moved for the sake of volumes, from now on
  bool budget_spent = false;                 ///< the greatest number of tetrahedra has stopped refinement
  /// How far the mesh may have moved the place of an element: the greater of the interface errors wanted and
  /// certified per material.
  double displacement = 0;
};

/// Why measuring and refining came to its end.
enum class RefinementEnd {
  kReached,        ///< within the targets
  kBudget,         ///< the greatest number of tetrahedra
  kSmallestCells,  ///< what is too far does not go away in cells far smaller than the target
  kDepth,          ///< the hierarchy is as deep as it can be
  kRounds,         ///< the greatest number of rounds of measuring
};

}  // namespace adamas::interfaces
