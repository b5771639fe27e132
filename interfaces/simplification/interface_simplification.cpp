#include "interfaces/simplification/interface_simplification.h"

#include <algorithm>
#include <utility>

#include "interfaces/network/interface_network.h"
#include "interfaces/network/triangle_contacts.h"
#include "interfaces/resampling/body_comparison.h"
#include "interfaces/simplification/line_shortening.h"
#include "interfaces/simplification/openmesh_patches.h"
#include "interfaces/simplification/patch_changes.h"
#include "interfaces/simplification/surface_guard.h"

namespace adamas::interfaces {

namespace {

/// The part of the error that collapses may use, since the later measurement is not exact.
constexpr double kLimit = 0.995;
/// The greatest number of turns. Interfaces and lines are simplified in turns, since short edges of lines
/// keep triangles small.
constexpr int kMostTurns = 20;
/// Another turn is worth it if the last one made at least this part of all collapses.
constexpr double kWorthwhile = 0.0005;
/// If measured distances are too great, the limit nearby is multiplied by this; in the last run nothing is
/// simplified there.
constexpr double kTighter = 0.5;
constexpr std::size_t kMostRuns = 8;

/// The interfaces that are simplified, with the elements that have to stay.
class Simplifier {
 public:
  Simplifier(const ResamplingSource& source, const SimplificationOptions& options, Progress& progress);
  SimplifiedNetwork run();

 private:
  using Triangle = ClosestPointTree::Triangle;
  void lock_contacts();
  [[nodiscard]] JoinedPatches simplify_once();
  void lock_borders(std::vector<InterfacePatch>& patches) const;
  [[nodiscard]] SurfaceGuard make_guard(const std::vector<InterfacePatch>& patches);
  void take_turns(std::vector<InterfacePatch>& patches, SurfaceGuard& guard);
  void improve(std::vector<InterfacePatch>& patches, SurfaceGuard& guard);
  void tighten_round(const InterfaceComparison& comparison, const InterfaceMesh& shown);
  void finish(JoinedPatches&& found, InterfaceComparison& comparison, SimplifiedNetwork& result);
  [[nodiscard]] std::size_t changed_bodies(const JoinedPatches& found) const;

  const ResamplingSource& source_;
  SimplificationOptions options_;
  Progress& progress_;
  InterfaceMesh mesh_;
  std::vector<std::array<BodyId, 2>> sides_;
  double limit_;
  std::vector<double> limit_parts_;  ///< by point
  std::vector<NearField> fields_;    ///< by interface
  bool input_in_contact_ = false;
};

double smallest_angle_of(const InterfaceMesh& mesh) {
  double smallest = mesh.triangles.empty() ? 0 : 180;
  for (const InterfaceTriangle& t : mesh.triangles) {
    const auto& p = t.points;
    smallest = std::min(smallest, smallest_angle({mesh.points[p[0]], mesh.points[p[1]], mesh.points[p[2]]}));
  }
  return smallest;
}

Simplifier::Simplifier(const ResamplingSource& source, const SimplificationOptions& options,
                       Progress& progress)
    : source_(source),
      options_(options),
      progress_(progress),
      mesh_(network_mesh(*source.network, source.materials, source.name)),
      sides_(triangle_bodies(*source.network)),
      limit_(kLimit * options.error),
      limit_parts_(mesh_.points.size(), 1.0) {
  const InterfaceTable& table = source.network->table();
  for (InterfaceId i(0); i.value < table.interface_count(); ++i.value)
    fields_.emplace_back(source.network->tree(i), limit_);
}

/// Locks triangles in contact, so that contacts cannot become worse.
void Simplifier::lock_contacts() {
  progress_.step("looking for triangles in contact", -1);
  for (const auto& pair : find_contacts(mesh_)) {
    input_in_contact_ = true;
    for (const std::uint32_t t : pair) {
      for (const std::uint32_t p : mesh_.triangles[t].points) limit_parts_[p] = 0;
    }
  }
}

void Simplifier::lock_borders(std::vector<InterfacePatch>& patches) const {
  std::vector<std::uint32_t> uses(mesh_.points.size(), 0);
  for (const InterfacePatch& patch : patches) {
    for (const auto vertex : patch.mesh.vertices()) ++uses[patch.mesh.data(vertex).point];
  }
  for (InterfacePatch& patch : patches) {
    for (const auto vertex : patch.mesh.vertices()) {
      const std::uint32_t p = patch.mesh.data(vertex).point;
      patch.mesh.status(vertex).set_locked(uses[p] > 1 || patch.mesh.is_boundary(vertex) ||
                                           limit_parts_[p] == 0);
    }
  }
}

SurfaceGuard Simplifier::make_guard(const std::vector<InterfacePatch>& patches) {
  const InterfaceNetwork& network = *source_.network;
  std::vector<std::uint32_t> interface_of, patch_of(mesh_.triangles.size(), 0);
  std::vector<Triangle> triangles;
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    interface_of.push_back(network.interface_of(t).value);
    triangles.push_back(mesh_.triangles[t].points);
  }
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    for (const auto face : patches[p].mesh.faces()) patch_of[patches[p].mesh.data(face).triangle] = p;
  }
  SurfaceGuard guard(mesh_.points, std::move(triangles), std::move(interface_of), std::move(patch_of),
                     fields_, {limit_, source_.box});
  guard.set_limit_parts(limit_parts_);
  return guard;
}

void Simplifier::take_turns(std::vector<InterfacePatch>& patches, SurfaceGuard& guard) {
  LineShortener lines(patches, guard);
  std::size_t all = 0;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    std::size_t collapses = 0;
    for (std::size_t p = 0; p < patches.size(); ++p) {
      progress_.step("simplifying interfaces", static_cast<double>(p) / static_cast<double>(patches.size()));
      // Elements that are marked as deleted would disturb the quadrics.
      patches[p].mesh.garbage_collection();
      collapses += decimate_patch(patches[p], guard, options_.least_angle, progress_);
    }
    if (options_.lines) {
      progress_.step("shortening lines", -1);
      collapses += lines.shorten(options_.least_angle, progress_);
    }
    for (InterfacePatch& patch : patches) flip_edges(patch, guard, progress_);
    all += collapses;
    if (static_cast<double>(collapses) <= kWorthwhile * static_cast<double>(all)) break;
  }
}

void Simplifier::improve(std::vector<InterfacePatch>& patches, SurfaceGuard& guard) {
  if (!options_.smooth) return;
  progress_.step("smoothing interfaces", -1);
  for (InterfacePatch& patch : patches) {
    const auto number = source_.network->table().find(patch.front_body(), patch.back_body());
    smooth_points(patch, source_.network->tree(number.value()), guard, progress_);
    flip_edges(patch, guard, progress_);
  }
}

JoinedPatches Simplifier::simplify_once() {
  std::vector<InterfacePatch> patches = to_openmesh(mesh_, sides_);
  lock_borders(patches);
  SurfaceGuard guard = make_guard(patches);
  take_turns(patches, guard);
  improve(patches, guard);
  return from_openmesh(std::move(patches), mesh_.materials, mesh_.source);
}

/// Reduces the limit round triangles and lines that are or may be too far.
void Simplifier::tighten_round(const InterfaceComparison& comparison, const InterfaceMesh& shown) {
  std::vector<Vec3> places;
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (!comparison.too_far(t, 0) && !comparison.too_far(t, 1)) continue;
    for (const std::uint32_t p : mesh_.triangles[t].points) places.push_back(mesh_.points[p]);
  }
  for (const std::uint32_t t : comparison.far_shown()) {
    for (const std::uint32_t p : shown.triangles[t].points) places.push_back(shown.points[p]);
  }
  for (const auto& points : comparison.far_junctions())
    places.insert(places.end(), points.begin(), points.end());
  std::vector<Triangle> as_points;
  for (std::uint32_t i = 0; i < places.size(); ++i) as_points.push_back({i, i, i});
  const ClosestPointTree tree(places, as_points);
  for (std::size_t p = 0; p < mesh_.points.size(); ++p) {
    if (tree.is_within(mesh_.points[p], 2 * options_.error)) limit_parts_[p] *= kTighter;
  }
}

std::size_t Simplifier::changed_bodies(const JoinedPatches& found) const {
  const std::size_t bodies = source_.network->table().body_count();
  const auto before = body_topology(ExtractedInterfaces{mesh_, sides_}, bodies, source_.box);
  const auto after = body_topology(ExtractedInterfaces{found.mesh, found.bodies}, bodies, source_.box);
  std::size_t changed = 0;
  for (BodyId b(0); b.value < before.size(); ++b.value) changed += before[b] == after[b] ? 0 : 1;
  return changed;
}

void Simplifier::finish(JoinedPatches&& found, InterfaceComparison& comparison, SimplifiedNetwork& result) {
  progress_.step("certifying", -1);
  result.certificate = comparison.finish(progress_);
  result.triangles_before = mesh_.triangles.size();
  result.smallest_angle_before = smallest_angle_of(mesh_);
  result.smallest_angle = smallest_angle_of(found.mesh);
  result.changed_bodies = changed_bodies(found);
  if (input_in_contact_) result.contacts = find_contacts(found.mesh).size();
  result.mesh = std::move(found.mesh);
  result.bodies = std::move(found.bodies);
}

SimplifiedNetwork Simplifier::run() {
  // OpenMesh prints operations that it refuses; callers here check for these themselves.
  const openmesh_detail::Silence silence;
  lock_contacts();
  SimplifiedNetwork result;
  InterfaceComparison comparison(source_, options_.error);
  while (true) {
    JoinedPatches found = simplify_once();
    ++result.runs;
    progress_.step("measuring distances", -1);
    comparison.measure(found.mesh, progress_);
    if (comparison.within() || result.runs >= kMostRuns) {
      finish(std::move(found), comparison, result);
      return result;
    }
    tighten_round(comparison, found.mesh);
    if (result.runs + 1 == kMostRuns) {
      for (double& part : limit_parts_) part = part < 1 ? 0 : 1;
    }
  }
}

}  // namespace

ResamplingSource source_of_interfaces(const InterfaceMesh& mesh, const Box3& box,
                                      std::vector<std::array<BodyId, 2>> sides,
                                      const IdVector<BodyId, MaterialId>& body_materials) {
  ResamplingSource source;
  source.name = mesh.source;
  source.box = box;
  source.materials = mesh.materials;
  Bodies bodies;
  bodies.sides = std::move(sides);
  bodies.materials = body_materials;
  source.network = std::make_shared<InterfaceNetwork>(mesh, box, std::move(bodies));
  return source;
}

SimplifiedNetwork simplify_interfaces(const ResamplingSource& source, const SimplificationOptions& options,
                                      Progress& progress) {
  return Simplifier(source, options, progress).run();
}

}  // namespace adamas::interfaces
