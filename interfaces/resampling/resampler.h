#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "interfaces/errors/field_error.h"
#include "interfaces/errors/interface_error.h"
#include "interfaces/hierarchy/hierarchy.h"
#include "interfaces/mesh/extraction.h"
#include "interfaces/resampling/body_comparison.h"
#include "interfaces/resampling/interface_comparison.h"
#include "interfaces/resampling/thin_places.h"
#include "interfaces/source/resampling_source.h"

namespace adamas::interfaces {

struct ResamplingOptions {
  double interface_error = 0;                       ///< wanted, in units of length; positive
  std::vector<std::optional<double>> field_errors;  ///< wanted, per field of the source, in the field's unit
  std::optional<std::size_t> max_tetrahedra;
  GhostMode ghost = GhostMode::kConstant;
  DistanceMode distance = DistanceMode::kExact;
  /// Move the interfaces, within the interface error and by one offset per body, until each
  /// body has the volume that it has in the input. Needs a source that knows these.
  bool conserve = false;
  /// Wanted of each body: the greatest difference of its volume from that in the input, in relation to this.
  /// Needs a source that knows these.
  std::optional<double> volume_error;
  bool certify = true;  ///< measure the interfaces' distance in the end, and refine where it is too great
};

/// One cell of the hierarchy.
struct CellRecord {
  std::vector<std::uint32_t> triangles;  ///< of the network, that meet the cell; leaves only
  std::uint32_t first_element = 0,
                last_element = 0;  ///< its native elements: a range of the resampler's order
  InterfaceError interface;
  std::vector<FieldError> fields;  ///< empty where not measured
  /// Cells larger than this must show the interfaces in them; falls where measuring has found one missing.
  double trusted = std::numeric_limits<double>::infinity();
  bool evaluated = false;  ///< the triangles and the interface error are up to date
};

/// Why measuring and refining came to its end.
enum class RefinementEnd {
  kReached,        ///< within the targets
  kBudget,         ///< the greatest number of tetrahedra
  kSmallestCells,  ///< what is too far does not go away in cells far smaller than the target
  kDepth,          ///< the hierarchy is as deep as it can be
  kRounds,         ///< the greatest number of rounds of measuring
};

/// The volume that cells are split for a body to have.
struct VolumeGoal {
  /// That of the input; or what the body's interfaces enclose, where that is too far off for smaller cells to
  /// help.
  double volume = 0;
  double tolerance = std::numeric_limits<double>::infinity();
  double cells = 0;  ///< so many at its boundary show its shape
};

/// What became of the diamonds of a hierarchy that was adapted to other data.
struct Adaptation {
  std::size_t kept = 0;    ///< split before and afterwards
  std::size_t merged = 0;  ///< split before alone
  std::size_t split = 0;   ///< split afterwards alone
};

/// Builds a hierarchy that approximates the source within the wanted errors (docs/method.md, Building): the
/// interfaces first, then the fields. Always the diamond with the greatest error in relation to its target is
/// split, until all are within or the number of tetrahedra would be exceeded. The result does not depend on
/// the number of threads.
class Resampler {
 public:
  using MeshHierarchy = Hierarchy<VertexRecord, CellRecord>;

  /// The source must outlive the resampler; missing field errors count as not wanted. Throws Error for an
  /// interface error that is not positive and a limit below the number of tetrahedra of the roots.
  Resampler(const ResamplingSource& source, ResamplingOptions options,
            Progress& progress = SilentProgress::instance());

  /// Refines the hierarchy; this or the next is to be called once. Throws Cancelled where the progress says
  /// so.
  void refine();
  /// The same from a hierarchy of the same domain that another resampler has left, as that of the step before
  /// of a series: what these interfaces do not need is merged, what they need is split. The result is that of
  /// refine(), to the last bit and number. With a greatest number of tetrahedra refinement begins at the
  /// roots, since what fits into it depends on the way from there. Throws Error for another domain.
  void refine(MeshHierarchy from);
  /// Gives the hierarchy away; this object can only be destroyed then.
  [[nodiscard]] MeshHierarchy give_hierarchy() { return std::move(hierarchy_); }
  /// None where refinement began at the roots.
  [[nodiscard]] const std::optional<Adaptation>& adaptation() const { return adaptation_; }

  [[nodiscard]] const MeshHierarchy& hierarchy() const { return hierarchy_; }
  [[nodiscard]] const ResamplingSource& source() const { return source_; }
  [[nodiscard]] const ResamplingOptions& options() const { return options_; }
  /// Measured distances; none where `certify` is off or there are no interfaces.
  [[nodiscard]] const std::optional<InterfaceCertificate>& certificate() const { return certificate_; }
  /// What became of the input's bodies; null where `certify` is off or there are no interfaces.
  [[nodiscard]] const BodyReport* body_report() const { return bodies_ ? &bodies_->report() : nullptr; }
  /// Why the interface error is not less; kReached where none was measured.
  [[nodiscard]] RefinementEnd interface_end() const { return interface_end_; }
  /// What splitting for the sake of volumes aimed at; null where no error of volumes is wanted, or none was
  /// looked at.
  [[nodiscard]] const VolumeGoal* volume_goal(BodyId body) const {
    return volume_goals_.empty() ? nullptr : &volume_goals_[body];
  }
  /// Why it ended of a body whose volume is off.
  [[nodiscard]] RefinementEnd volume_end(BodyId body) const {
    return volume_ends_.empty() ? RefinementEnd::kReached : volume_ends_[body];
  }
  /// Whether the greatest number of tetrahedra has stopped refinement.
  [[nodiscard]] bool budget_spent() const { return budget_spent_; }
  /// A tetrahedron of the tree, leaf or not, in space, and who owns what of it.
  [[nodiscard]] Tetrahedron frame(TetrahedronId t) const;
  void ownership(TetrahedronId t, CellOwnership& result) const;
  /// A body's fields at a vertex.
  [[nodiscard]] std::vector<double> row(VertexId v, BodyId body) const;
  /// The native elements in a tetrahedron of the tree, leaf or not.
  [[nodiscard]] std::span<const std::uint32_t> elements(TetrahedronId t) const;
  /// How far the mesh may have moved the place of an element: the greater of the interface errors wanted and
  /// certified per material.
  [[nodiscard]] double displacement() const {
    return certificate_ ? std::max(options_.interface_error, certificate_->materials.upper)
                        : options_.interface_error;
  }
  /// The leaf that holds a point.
  [[nodiscard]] TetrahedronId leaf_at(const Vec3& p) const;
  /// The body that owns a point.
  [[nodiscard]] BodyId owner_at(const Vec3& p) const;
  /// The leaves, and what their vertices know; valid until the hierarchy changes.
  [[nodiscard]] CellSet cells() const;

 private:
  struct Priority {
    int rank = -1;  ///< 2: a lost interface, 1: an interface, 0: a field, -1: within all targets
    double ratio = 0;
    auto operator<=>(const Priority&) const = default;
  };

  /// What has to be undone: splits, and the cell records that were changed before, as they were.
  struct Record {
    std::vector<Split> splits;
    std::vector<std::pair<TetrahedronId, double>> trusted;
  };

  /// What is wrong with the bodies that the leaves show.
  struct ShownBodies {
    BodyFaults faults;
    std::size_t leaves = 0;
    std::optional<std::size_t> given_away;  ///< thin places of bodies that are given to others, once known
    /// Whether fewer bodies are lost or joined, or so many fewer torn that it is worth the leaves.
    [[nodiscard]] bool are_better_than(const ShownBodies& other) const;
    /// How many there may be before something has become better.
    [[nodiscard]] std::size_t most_leaves() const;
  };

  struct TornLeaves {
    std::vector<TetrahedronId> leaves;
    std::size_t places = 0;  ///< within bodies, given to others
  };

  /// Moves an interface at the corners of a leaf, positive towards its first body's gain.
  struct Raise {
    TetrahedronId leaf;
    InterfaceId interface;
    double by = 0;
  };
  /// Numbers of thin places, and the leaves that hold them, in order.
  using PlacesByLeaf = std::vector<std::pair<TetrahedronId, std::uint32_t>>;
  /// Signed distances of vertices from interfaces.
  using Distances = std::map<std::pair<VertexId, InterfaceId>, double>;

  /// Follows the volumes of bodies while cells are split.
  struct VolumeWatch {
    IdVector<BodyId, double> volumes;
    std::vector<TetrahedronId> created;  ///< leaves at the time
  };
  /// A body whose volume is off, with the leaves at its boundary.
  struct WantingBody;

  /// What divides a tetrahedron's children: the plane through the middle of the split edge and the other two
  /// vertices.
  struct SplitPlane {
    Vec3 normal;  ///< into the first child
    Vec3 origin;
    /// The child that a point of the tetrahedron is given to.
    [[nodiscard]] std::size_t side(const Vec3& p) const { return dot(normal, p - origin) >= 0 ? 0 : 1; }
  };

  void place_roots();
  void refine_further();
  [[nodiscard]] SplitPlane split_plane(TetrahedronId t) const;
  [[nodiscard]] TetrahedronId root_at(const Vec3& p) const;
  void place_elements();
  void evaluate_vertices(const std::vector<VertexId>& vertices);
  void evaluate_interface(TetrahedronId t);
  void hand_down(TetrahedronId parent);
  void distribute(TetrahedronId parent);
  void adapt();
  void evaluate_tree();
  [[nodiscard]] LatticeMap<char> demanded_diamonds() const;
  void merge_others(const LatticeMap<char>& demanded);
  void close_cell(TetrahedronId t);
  void number_as_from_roots();
  std::vector<TetrahedronId> process(const std::vector<Split>& splits);
  [[nodiscard]] CellView view(TetrahedronId t) const;
  [[nodiscard]] CellView view_with_parts(TetrahedronId t) const;
  void cells_in_box(const Box3& box, MaterialId material,
                    const std::function<void(TetrahedronId)>& visit) const;
  [[nodiscard]] bool may_hold(TetrahedronId t, MaterialId material) const;
  /// How far the least error of a displaced element is looked for.
  enum class DisplacedErrors { kWithinTargets, kLeast };
  void measure_fields(const std::vector<TetrahedronId>& cells, DisplacedErrors displaced);
  void compute_rows(std::vector<std::pair<VertexId, BodyId>> needs);
  [[nodiscard]] Priority priority(TetrahedronId t) const;
  [[nodiscard]] bool demands_split(TetrahedronId t) const;
  [[nodiscard]] bool wants_split(TetrahedronId t) const;
  std::vector<TetrahedronId> refine_in_rounds(std::vector<TetrahedronId> cells);
  void refine_greedily(const std::vector<TetrahedronId>& cells);
  void refine_to_targets(std::vector<TetrahedronId> cells);
  void collect(TetrahedronId parent);
  void undo(const std::vector<Split>& splits);
  void take_back(const Record& record);
  void refine_fields();
  [[nodiscard]] std::vector<TetrahedronId> leaves() const;
  [[nodiscard]] CellSet cells_of(std::vector<TetrahedronId> tetrahedra) const;
  void finish_interfaces();
  [[nodiscard]] IdVector<BodyId, double> missing_volumes() const;
  [[nodiscard]] std::vector<std::pair<std::array<BodyId, 2>, double>> exchanges() const;
  void shift_interfaces(const IdVector<BodyId, double>& raised);
  void conserve_volumes();
  [[nodiscard]] std::vector<TetrahedronId> leaves_of_wanting_bodies() const;
  bool allow_smaller_shifts(const ExtractedInterfaces& shown);
  void find_volume_goals();
  [[nodiscard]] double allowed(BodyId body) const;
  [[nodiscard]] bool is_off(BodyId body, double volume) const;
  [[nodiscard]] std::size_t bodies_off() const;
  void watch_split(const std::vector<TetrahedronId>& parents, const std::vector<TetrahedronId>& created);
  void add_cells(const std::vector<TetrahedronId>& cells, std::vector<WantingBody>& wanting) const;
  void choose_cells(WantingBody& wanting, double volume,
                    std::vector<std::pair<double, TetrahedronId>>& chosen);
  bool split_for_volumes(std::vector<WantingBody>& wanting, VolumeWatch& watch);
  bool split_for_all_volumes();
  bool refine_for_volumes();
  [[nodiscard]] RefinementEnd refine_what_fails();
  /// `each`: whether triangles that are too far are looked for, where no cell may be split for them.
  ExtractedInterfaces measure_shown(bool each = false);
  void add_leaf_at(const Vec3& p, double finest, std::vector<TetrahedronId>& leaves) const;
  [[nodiscard]] std::vector<TetrahedronId> failing_leaves(const InterfaceMesh& shown) const;
  [[nodiscard]] std::vector<TetrahedronId> leaves_far_from_shown() const;
  void find_thin_places();
  [[nodiscard]] IdVector<BodyId, char> wrong_bodies() const;
  [[nodiscard]] PlacesByLeaf places_by_leaf(const IdVector<BodyId, char>& bodies) const;
  void look_at(
      const PlacesByLeaf& places,
      const std::function<void(std::uint32_t, TetrahedronId, BodyId, const CellOwnership&)>& look) const;
  [[nodiscard]] std::optional<Raise> raise_at(const ThinPlace& place, TetrahedronId leaf, BodyId owner,
                                              const CellOwnership& owners) const;
  Distances raise_torn_bodies();
  [[nodiscard]] std::vector<VertexId> corners_of(const std::vector<TetrahedronId>& cells) const;
  [[nodiscard]] std::vector<TetrahedronId> leaves_at(const std::vector<VertexId>& corners) const;
  void move_back(const Distances& originals, const std::vector<VertexId>& corners, double share);
  bool mend_bodies(ExtractedInterfaces& shown, std::size_t part);
  [[nodiscard]] TornLeaves torn_leaves() const;
  bool refine_for_lost_bodies(const InterfaceMesh& shown);
  [[nodiscard]] std::optional<RefinementEnd> refine_for_bodies(const InterfaceMesh& shown, ShownBodies& best);
  [[nodiscard]] std::vector<TetrahedronId> split_all(std::vector<TetrahedronId> failing);
  [[nodiscard]] std::vector<TetrahedronId> split_in_order(const std::vector<TetrahedronId>& cells,
                                                          bool doubted);
  [[nodiscard]] double estimate_target() const;
  void report(std::string_view stage);

  const ResamplingSource& source_;
  ResamplingOptions options_;
  Progress& progress_;
  MeshHierarchy hierarchy_;
  std::vector<Tetrahedron> root_frames_;
  std::vector<std::uint32_t> element_order_;
  bool fields_active_ = false;
  bool budget_spent_ = false;
  bool adapting_ = false;  ///< errors of tetrahedra that are no leaves are needed too
  std::optional<Adaptation> adaptation_;
  RefinementEnd interface_end_ = RefinementEnd::kReached;
  IdVector<InterfaceId, double> shifts_;       ///< added to signed distances, so that volumes agree
  IdVector<InterfaceId, double> most_shifts_;  ///< bounds of these
  IdVector<BodyId, char> wanting_;             ///< bodies that could not be given their volumes
  IdVector<BodyId, VolumeGoal> volume_goals_;  ///< known once they are needed
  IdVector<BodyId, RefinementEnd> volume_ends_;
  bool conserves_ = false;        ///< interfaces are moved for the sake of volumes, from now on
  double volume_slack_ = 0;       ///< part of a body's volume that moving interfaces may still make up
  VolumeWatch* watch_ = nullptr;  ///< follows what is split, unless null
  std::unique_ptr<InterfaceComparison> comparison_;
  std::optional<InterfaceCertificate> certificate_;
  std::unique_ptr<BodyComparison> bodies_;
  std::optional<std::vector<ThinPlace>> thin_places_;  ///< known once they are needed
  bool mending_is_hopeless_ = false;                   ///< it has made bodies worse
  Record* recorded_ = nullptr;                         ///< receives what is split, unless null
};

}  // namespace adamas::interfaces
