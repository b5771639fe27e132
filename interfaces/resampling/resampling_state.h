#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adamas/progress.h"
#include "core/data/cell_contacts.h"
#include "interfaces/cell_errors/field_error.h"
#include "interfaces/cell_errors/interface_error.h"
#include "interfaces/hierarchy/hierarchy.h"
#include "interfaces/input/resampling_source.h"
#include "interfaces/mesh/interface_extraction.h"

namespace adamas::interfaces {

struct ResamplingOptions {
  double interface_error = 0;  ///< the wanted error, in units of length; positive
  /// the wanted errors, by field of the source, in the field's unit
  std::vector<std::optional<double>> field_errors;
  std::optional<std::size_t> max_tetrahedra;
  GhostMode ghost = GhostMode::kConstant;
  DistanceMode distance = DistanceMode::kExact;
  /// Whether interfaces are moved, within the interface error and by one offset per body, until each body has
  /// its volume in the input. The source must know these volumes.
  bool conserve = false;
  /// Whether a body that cannot have its volume is an error that was not reached. Else distances must not
  /// become greater by it where they are greater than wanted.
  bool conservation_wanted = false;
  /// The greatest difference of a body's volume from that in the input, relative to the latter. The source
  /// must know these volumes.
  std::optional<double> volume_error;
  bool certify = true;  ///< whether the interfaces' distance is measured in the end, and cells are refined
                        ///< where it is too great
};

/// The data of one tetrahedron of the hierarchy.
struct CellRecord {
  std::vector<std::uint32_t> triangles;  ///< the triangles of the network that meet the cell; only in leaves
  /// The cell's native elements: a range of ResamplingState::element_order.
  std::uint32_t first_element = 0, last_element = 0;
  InterfaceError interface;
  std::vector<FieldError> fields;  ///< empty if not measured
  /// Cells larger than this must show the interfaces in them. It falls if a measurement has found one
  /// missing.
  double trusted = std::numeric_limits<double>::infinity();
  bool evaluated = false;     ///< whether the triangles and the interface error are up to date
  bool deferred = false;      ///< whether the interface error is still to be estimated
  bool has_contacts = false;  ///< whether `contacts` is up to date
  CellContacts contacts;      ///< what a leaf shows of the interfaces

  void forget_contacts() {
    has_contacts = false;
    contacts = {};
  }
};

/// The number of roots of a cube. They are consecutive, round its diagonal, so that each has the cube's
/// bounding box.
inline constexpr std::size_t kRootsOfCube = 6;

/// The hierarchy of cells with the data of its vertices and tetrahedra.
using MeshHierarchy = Hierarchy<VertexRecord, CellRecord>;

/// The plane that divides a tetrahedron's two children.
struct SplitPlane {
  Vec3 normal;  ///< points into the first child
  Vec3 origin;
  /// Returns the number, 0 or 1, of the child that gets a point of the tetrahedron.
  [[nodiscard]] std::size_t side(const Vec3& p) const { return dot(normal, p - origin) >= 0 ? 0 : 1; }
};

/// The bound for estimates relative to the wanted interface error. It is below 1 so that the measured
/// distance, which accounts for every point, leaves interfaces room to move for bodies and volumes. With 1.2
/// meshes would be a tenth smaller, but bodies stay torn that are mended otherwise, and volumes are not kept.
inline constexpr double kEstimatePart = 0.95;

/// The state that the parts of resampling share: the source and the wanted errors, the hierarchy with its
/// payload, and the data from which this payload was computed.
struct ResamplingState {
  /// The source must outlive the state. Throws Error if the interface error or the error of volumes is not
  /// positive, or the limit is below the number of the roots.
  ResamplingState(const ResamplingSource& source, ResamplingOptions options, Progress& progress);

  /// Returns the bound for estimates, a part of the interface error.
  [[nodiscard]] double estimate_target() const { return kEstimatePart * options.interface_error; }
  /// Returns the geometry of a tetrahedron of the tree, which need not be a leaf.
  [[nodiscard]] Tetrahedron frame(TetrahedronId t) const;
  /// Returns the box round a tetrahedron.
  [[nodiscard]] Box3 box(TetrahedronId t) const;
  /// Returns the volume of a tetrahedron, in the cube of the unit of length.
  [[nodiscard]] double volume(TetrahedronId t) const;
  /// Finds the ownership of a tetrahedron of the tree, which need not be a leaf.
  void ownership(TetrahedronId t, CellOwnership& result, const OwnershipNeeds& needs = {}) const;
  [[nodiscard]] std::vector<TetrahedronId> leaves() const;
  /// Returns these tetrahedra with the distances at their vertices; valid until the hierarchy changes.
  [[nodiscard]] CellSet cells(std::vector<TetrahedronId> tetrahedra) const;
  /// What leaves show.
  using ShownByLeaves = std::vector<std::pair<TetrahedronId, CellContacts>>;
  /// Forgets what leaves with one of these vertices show, because distances there have changed. Returns what
  /// they showed, where it was known.
  ShownByLeaves forget_contacts(const std::vector<VertexId>& vertices);
  /// Adds what a leaf shows to a buffer.
  void add_contacts(TetrahedronId t, ContactBuffer& buffer) const;
  /// Tells what leaves show, after distances have become again what they were.
  void restore_contacts(ShownByLeaves shown);
  /// Returns the volume of each body in the leaves.
  [[nodiscard]] IdVector<BodyId, double> volumes() const;
  /// Returns the vertices of these tetrahedra, ascending.
  [[nodiscard]] std::vector<VertexId> corners(const std::vector<TetrahedronId>& tetrahedra) const;
  [[nodiscard]] SplitPlane split_plane(TetrahedronId t) const;
  /// Returns the root that holds a point or is closest to it.
  [[nodiscard]] TetrahedronId root_at(const Vec3& p) const;
  /// Returns the leaf that holds a point.
  [[nodiscard]] TetrahedronId leaf_at(const Vec3& p) const;
  /// Returns the leaves that hold these points.
  [[nodiscard]] std::vector<TetrahedronId> leaves_at(std::span<const Vec3> points) const;
  /// Returns the leaves whose boxes are at most this far, along each axis, from those of some tetrahedra; in
  /// the order of leaves.
  [[nodiscard]] std::vector<TetrahedronId> leaves_near(std::span<const TetrahedronId> tetrahedra,
                                                       double distance) const;
  /// Adds the leaf that holds a point to the list if its diameter is greater than `finest`.
  void add_leaf_at(const Vec3& p, double finest, std::vector<TetrahedronId>& list) const;
  /// Returns the name of a stage with the number of leaves.
  [[nodiscard]] std::string stage(std::string_view name) const;
  /// Reports a stage with the number of leaves. Throws Cancelled if the progress requests it.
  void report(std::string_view name) const;

  const ResamplingSource& source;
  ResamplingOptions options;
  Progress& progress;
  MeshHierarchy hierarchy;
  std::vector<Tetrahedron> root_frames;
  std::vector<std::uint32_t> element_order;  ///< the native elements; those of each tetrahedron are
                                             ///< consecutive
  IdVector<InterfaceId, double> shifts;      ///< the shifts that are added to signed distances to make
                                             ///< volumes agree
  bool budget_spent = false;                 ///< whether the greatest number of tetrahedra has stopped
                                             ///< refinement
  /// The distance by which the mesh may have moved the place of an element: the greater one of the wanted
  /// interface error and the certified one per material.
  double displacement = 0;
};

/// The reason why measuring and refining ended.
enum class RefinementEnd {
  kReached,        ///< all errors are within their targets
  kBudget,         ///< the greatest number of tetrahedra is reached
  kSmallestCells,  ///< cells far smaller than the target do not reduce the error
  kDepth,          ///< the hierarchy is as deep as it can be
  kRounds,         ///< the greatest number of rounds of measuring is reached
};

}  // namespace adamas::interfaces
