#include "interfaces/resampling/interface_comparison.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/base/hash.h"
#include "core/base/loop_progress.h"
#include "core/base/sort_unique.h"
#include "core/data/contact_mesh.h"
#include "interfaces/network/edge_fans.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// The relative slack of the measured bounds: kSharp for the decision what is within the target, kTight for
/// reported figures.
constexpr double kSharp = 0.005;
constexpr double kTight = 0.03;
/// Distances below this part of the target count as equal.
constexpr double kSmall = 0.01;
/// The round-off of a distance, relative to the domain's diagonal.
constexpr double kRoundOff = 1e-15;
/// Stands for the part of a material without interfaces.
constexpr std::uint32_t kNoPart = 0xffffffffu;
/// What a triangle of a tree that is built counts as progress.
constexpr double kTreeWork = 2;
/// The greatest number of sample points of a line.
constexpr double kMostPoints = 64;
/// If more than this part of the shown triangles has changed, all are measured again.
constexpr double kManyChanges = 0.25;

/// Returns a number that equal triangles share, whichever corner comes first.
DigestTable::Digest digest(std::array<Vec3, 3> corners) {
  const auto less = [](const Vec3& a, const Vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end(), less), corners.end());
  std::uint64_t low = 1, high = 2;
  for (const Vec3& p : corners) {
    for (const double x : {p.x, p.y, p.z}) {
      const auto bits = std::bit_cast<std::uint64_t>(x);
      low = mix64(low + bits + kGoldenRatio64);
      high = mix64((high ^ std::rotl(bits, 32)) + kGoldenRatio64);
    }
  }
  return {low, high};
}

std::vector<ClosestPointTree::Triangle> indices(const InterfaceMesh& mesh) {
  std::vector<ClosestPointTree::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const InterfaceTriangle& t : mesh.triangles) triangles.push_back(t.points);
  return triangles;
}

InterfaceDistance greater(const InterfaceDistance& a, const InterfaceDistance& b) {
  const InterfaceDistance& lower = b.lower > a.lower ? b : a;
  return {std::max(a.upper, b.upper), lower.lower, lower.worst};
}

}  // namespace

InterfaceComparison::InterfaceComparison(const ResamplingSource& source, double target)
    : InterfaceComparison(network_mesh(*source.network, source.materials, source.name), source.box,
                          !source.network->has_open_border() && source.network->inconsistencies() == 0,
                          target) {}

InterfaceComparison::InterfaceComparison(InterfaceMesh input, const Box3& box, bool closed, double target)
    : mesh_(std::move(input)),
      box_(box),
      target_(target),
      part_of_(mesh_.materials.size(), kNoPart),
      junctions_known_(closed) {
  IdVector<MaterialId, char> used(mesh_.materials.size(), 0);
  for (const InterfaceTriangle& t : mesh_.triangles) used[t.front] = used[t.back] = 1;
  std::uint32_t parts = 0;
  for (MaterialId m(0); m.value < used.size(); ++m.value) {
    if (used[m] != 0) part_of_[m] = parts++;
  }
  // With at most two materials, every triangle is in the boundary of each.
  if (parts <= 2) std::fill(part_of_.begin(), part_of_.end(), 0u);
  material_parts_ = parts <= 2 ? 1 : parts;
  input_ = split_into_parts(mesh_);
}

InterfaceComparison::Parts InterfaceComparison::split_into_parts(const InterfaceMesh& mesh) const {
  Parts parts(material_parts_ + 1);
  constexpr std::uint32_t kUnused = 0xffffffffu;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t front = part_of_[mesh.triangles[t].front], back = part_of_[mesh.triangles[t].back];
    parts[front].numbers.push_back(t);
    if (back != front) parts[back].numbers.push_back(t);
  }
  for (Part& part : parts) {
    for (const std::uint32_t t : part.numbers) part.triangles.push_back(mesh.triangles[t].points);
  }
  if (junctions_known_) {
    for (const auto& [a, b] : junction_lines(mesh)) parts.back().triangles.push_back({a, b, b});
  }
  std::vector<std::uint32_t> number(mesh.points.size(), kUnused), touched;
  for (Part& part : parts) {
    touched.clear();
    for (auto& triangle : part.triangles) {
      for (std::uint32_t& p : triangle) {
        if (number[p] == kUnused) {
          number[p] = static_cast<std::uint32_t>(part.points.size());
          part.points.push_back(mesh.points[p]);
          touched.push_back(p);
        }
        p = number[p];
      }
    }
    for (const std::uint32_t p : touched) number[p] = kUnused;
    part.tree = ClosestPointTree(part.points, part.triangles);
    LoopProgress::count_items(kTreeWork * static_cast<double>(part.triangles.size()));
  }
  return parts;
}

InterfaceDistance InterfaceComparison::Bounds::distance() const {
  return greater({input_to_shown.upper, input_to_shown.lower, input_to_shown.worst},
                 {shown_to_input.upper, shown_to_input.lower, shown_to_input.worst});
}

/// Points and triangles whose distances are bounded count as one each.
double InterfaceComparison::work_of_measuring(const InterfaceMesh& shown) const {
  std::size_t items = 0;
  for (const Part& part : input_) items += part.points.size() + part.triangles.size();
  const std::size_t sides = material_parts_ > 1 ? 2 : 1;
  const auto points = static_cast<double>(shown.points.size()),
             triangles = static_cast<double>(shown.triangles.size());
  return static_cast<double>(items) + static_cast<double>(sides) * (points + (1 + kTreeWork) * triangles);
}

/// Measures a part after some of its shown triangles have changed; returns false if so many have changed
/// that all should be measured. A bound of at most the target depends only on what is within the target of
/// the triangle, so that it still holds if nothing has changed there.
bool InterfaceComparison::measure_changes(std::size_t part, const Part& before,
                                          const HausdorffOptions& options, const Progress& progress) {
  const Part &input = input_[part], &now = shown_[part];
  if (before.triangles.empty() || now.triangles.empty() || input.triangles.empty()) return false;
  const auto count = [](const Part& p) { return static_cast<std::uint32_t>(p.triangles.size()); };
  DigestTable places;
  for (std::uint32_t t = 0; t < count(before); ++t) places.try_add(digest(before.corners(t)), t);
  const DistanceBound old = std::move(bounds_[part].shown_to_input);
  DistanceBound& of_shown = bounds_[part].shown_to_input;
  of_shown = {};
  std::vector<char> remains(count(before), 0);
  std::vector<std::uint32_t> fresh;
  for (std::uint32_t t = 0; t < count(now); ++t) {
    const std::uint32_t place = places.try_add(digest(now.corners(t)), count(before) + t).first;
    const bool known = place < count(before);
    if (known) remains[place] = 1;
    if (!known) fresh.push_back(t);
    of_shown.triangle_upper.push_back(known ? old.triangle_upper[place] : kInfinity);
    of_shown.triangle_lower.push_back(known ? old.triangle_lower[place] : 0);
  }
  std::vector<char> near(count(input), 0);
  std::vector<std::uint32_t> found;
  const double reach = (1 + kSharp) * target_;
  Box3 box;  // of some successive triangles, which are mostly neighbours
  const auto mark_near = [&] {
    input.tree.overlapping({box.min - Vec3{reach, reach, reach}, box.max + Vec3{reach, reach, reach}}, found);
    for (const std::uint32_t t : found) near[t] = 1;
    box = {};
  };
  const auto add_changed = [&](const std::array<Vec3, 3>& corners) {
    Box3 larger = box;
    for (const Vec3& p : corners) larger.extend(p);
    if (box.min.x <= box.max.x && larger.diagonal() > 2 * reach) {
      mark_near();
      larger = {};
      for (const Vec3& p : corners) larger.extend(p);
    }
    box = larger;
  };
  const auto gone = static_cast<std::size_t>(std::count(remains.begin(), remains.end(), 0));
  if (kManyChanges * static_cast<double>(count(now) + count(before)) <
      static_cast<double>(gone + fresh.size()))
    return false;
  for (std::uint32_t t = 0; t < count(before); ++t) {
    if (remains[t] == 0) add_changed(before.corners(t));
  }
  for (const std::uint32_t t : fresh) add_changed(now.corners(t));
  if (gone + fresh.size() > 0) mark_near();
  const auto changed = [&](const DistanceBound& bound, const auto& is_changed) {
    std::vector<std::uint32_t> list;
    for (std::uint32_t t = 0; t < bound.triangle_upper.size(); ++t) {
      if (is_changed(t) || bound.triangle_upper[t] > target_) list.push_back(t);
    }
    return list;
  };
  DistanceBound& of_input = bounds_[part].input_to_shown;
  update_distance_bound(input.points, input.triangles,
                        changed(of_input, [&](std::uint32_t t) { return near[t] != 0; }), now.tree, options,
                        of_input, progress);
  update_distance_bound(now.points, now.triangles, changed(of_shown, [](std::uint32_t) { return false; }),
                        input.tree, options, of_shown, progress);
  return true;
}

void InterfaceComparison::measure(const InterfaceMesh& shown, const Progress& progress, bool each) {
  const Parts before = std::exchange(shown_, split_into_parts(shown));
  HausdorffOptions options;
  options.domain = box_;
  options.accept = target_;
  options.relative = kSharp;
  options.each = each;
  const bool again = std::exchange(each_, each) && each && before.size() == shown_.size();
  bounds_.resize(input_.size());
  for (std::size_t p = 0; p < input_.size(); ++p) {
    if (again && measure_changes(p, before[p], options, progress)) continue;
    const Part &input = input_[p], &found = shown_[p];
    bounds_[p] = {directed_distance_bound(input.points, input.triangles, found.tree, options, progress),
                  directed_distance_bound(found.points, found.triangles, input.tree, options, progress)};
  }
  clear_far();
  if (each) find_far();
}

double InterfaceComparison::greatest() const {
  double greatest = 0;
  for (const Bounds& b : bounds_) greatest = std::max(greatest, b.distance().upper);
  return greatest;
}

bool InterfaceComparison::within() const { return greatest() <= target_; }

void InterfaceComparison::clear_far() {
  for (auto& side : far_) side.assign(mesh_.triangles.size(), 0.0);
  far_shown_.clear();
  for (auto& points : far_junctions_) points.clear();
}

void InterfaceComparison::find_far() {
  for (std::size_t p = 0; p < material_parts_; ++p) {
    for (std::size_t i = 0; i < input_[p].numbers.size(); ++i) {
      const std::uint32_t t = input_[p].numbers[i];
      const std::size_t side = part_of_[mesh_.triangles[t].front] == p ? 0 : 1;
      far_[side][t] = bounds_[p].input_to_shown.triangle_upper[i];
    }
    for (std::size_t i = 0; i < shown_[p].numbers.size(); ++i) {
      if (bounds_[p].shown_to_input.triangle_upper[i] > target_) far_shown_.push_back(shown_[p].numbers[i]);
    }
  }
  sort_unique(far_shown_);
  far_junctions_[0] = far_points(input_.back(), bounds_.back().input_to_shown, shown_.back().tree);
  far_junctions_[1] = far_points(shown_.back(), bounds_.back().shown_to_input, input_.back().tree);
}

/// Returns sample points of the lines that are too far; of a line on which none is found, all sample points.
std::vector<Vec3> InterfaceComparison::far_points(const Part& lines, const DistanceBound& bound,
                                                  const ClosestPointTree& others) const {
  std::vector<Vec3> result, seen;
  for (std::size_t i = 0; i < lines.triangles.size(); ++i) {
    if (!(bound.triangle_upper[i] > target_)) continue;
    const Vec3 &a = lines.points[lines.triangles[i][0]], &b = lines.points[lines.triangles[i][1]];
    const double steps = std::clamp(std::ceil(2 * distance(a, b) / target_), 1.0, kMostPoints);
    const std::size_t before = result.size();
    seen.clear();
    for (double s = 0; s <= steps; ++s) {
      const Vec3 p = a + (s / steps) * (b - a);
      if (!box_.contains(p)) continue;
      seen.push_back(p);
      if (!others.closest(p, target_)) result.push_back(p);
    }
    if (result.size() == before) result.insert(result.end(), seen.begin(), seen.end());
  }
  return result;
}

bool InterfaceComparison::has_far_point(std::uint32_t triangle, std::size_t side,
                                        const Tetrahedron& cell) const {
  const InterfaceTriangle& t = mesh_.triangles[triangle];
  const ClosestPointTree& boundary = shown_[part_of_[side == 0 ? t.front : t.back]].tree;
  const auto& [a, b, c] = t.points;
  Weights middle{};
  double count = 0;
  for (const Weights& w : ClippedTriangle(cell, mesh_.points[a], mesh_.points[b], mesh_.points[c])) {
    if (!boundary.closest(cell.point(w), target_)) return true;
    for (std::size_t v = 0; v < 4; ++v) middle[v] += w[v];
    ++count;
  }
  for (double& w : middle) w /= count;
  return count > 0 && !boundary.closest(cell.point(middle), target_);
}

/// Tightens the bounds of a part. Distances below `seen`, which was measured elsewhere, need not be known.
void InterfaceComparison::tighten(std::size_t part, double seen, const Progress& progress) {
  HausdorffOptions options;
  options.domain = box_;
  options.accept = kSmall * target_;
  options.relative = kTight;
  const auto tightened = [&](const Part& from, const Part& to, DistanceBound& bound) {
    const DistanceBound before = bound;
    bound.lower = std::max(bound.lower, seen);
    tighten_distance_bound(from.points, from.triangles, to.tree, options, bound, progress);
    if (bound.lower <= seen) bound.lower = before.lower, bound.worst = before.worst;
    return std::max(seen, bound.lower);
  };
  seen = std::max({seen, bounds_[part].input_to_shown.lower, bounds_[part].shown_to_input.lower});
  seen = tightened(input_[part], shown_[part], bounds_[part].input_to_shown);
  tightened(shown_[part], input_[part], bounds_[part].shown_to_input);
}

/// Returns bounds of the distances of all triangles of the input, or of the shown ones, from the whole
/// other network: those of the boundaries of the triangles' materials, which are parts of it.
DistanceBound InterfaceComparison::bound_of_materials(std::size_t triangles, bool of_input) const {
  DistanceBound bound;
  bound.triangle_upper.assign(triangles, kInfinity);
  for (std::size_t p = 0; p < material_parts_; ++p) {
    const std::vector<std::uint32_t>& numbers = (of_input ? input_ : shown_)[p].numbers;
    const DistanceBound& part = of_input ? bounds_[p].input_to_shown : bounds_[p].shown_to_input;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      double& upper = bound.triangle_upper[numbers[i]];
      upper = std::min(upper, part.triangle_upper[i]);
    }
  }
  return bound;
}

InterfaceDistance InterfaceComparison::measure_networks(const InterfaceMesh& shown,
                                                        const Progress& progress) const {
  const std::vector<ClosestPointTree::Triangle> triangles = indices(shown);
  const std::vector<ClosestPointTree::Triangle> input_triangles = indices(mesh_);
  HausdorffOptions options;
  options.domain = box_;
  options.accept = kSmall * target_;
  options.relative = kTight;
  DistanceBound input_to_shown = bound_of_materials(input_triangles.size(), true);
  tighten_distance_bound(mesh_.points, input_triangles, ClosestPointTree(shown.points, triangles), options,
                         input_to_shown, progress);
  // The other direction only matters if it is greater than this one.
  DistanceBound shown_to_input = bound_of_materials(triangles.size(), false);
  shown_to_input.lower = input_to_shown.lower;
  shown_to_input.worst = input_to_shown.worst;
  tighten_distance_bound(shown.points, triangles, ClosestPointTree(mesh_.points, input_triangles), options,
                         shown_to_input, progress);
  return Bounds{input_to_shown, shown_to_input}.distance();
}

InterfaceDistance InterfaceComparison::certified(InterfaceDistance distance) const {
  if (distance.upper <= target_)
    distance.upper = std::min(distance.upper + kRoundOff * box_.diagonal(), target_);
  return distance;
}

InterfaceCertificate InterfaceComparison::summary() const {
  InterfaceCertificate result;
  std::size_t worst = 0;
  for (std::size_t p = 0; p < material_parts_; ++p) {
    const InterfaceDistance d = bounds_[p].distance();
    if (d.lower > result.materials.lower) worst = p;
    result.materials = greater(result.materials, d);
  }
  result.materials = certified(result.materials);
  const auto found = std::find(part_of_.begin(), part_of_.end(), static_cast<std::uint32_t>(worst));
  result.worst_material = MaterialId(static_cast<std::size_t>(found - part_of_.begin()));
  if (!input_.back().triangles.empty() || !shown_.back().triangles.empty())
    result.junctions = certified(bounds_.back().distance());
  return result;
}

InterfaceCertificate InterfaceComparison::finish(const InterfaceMesh& shown, const Progress& progress) {
  const auto tighten_parts = [&](std::size_t first, std::size_t last) {
    double seen = 0;
    bool reached = true;
    for (std::size_t p = first; p < last; ++p) {
      const InterfaceDistance d = bounds_[p].distance();
      seen = std::max(seen, d.lower);
      reached = reached && d.upper <= target_;
    }
    for (std::size_t p = first; reached && p < last; ++p) tighten(p, seen, progress);
  };
  tighten_parts(0, material_parts_);
  tighten_parts(material_parts_, input_.size());
  InterfaceCertificate result = summary();
  result.networks = result.materials;
  if (material_parts_ > 1) {
    // The materials' bound holds for the networks too, as every interface is a part of two materials'
    // boundaries.
    result.networks = certified(measure_networks(shown, progress));
    result.networks.upper = std::min(result.networks.upper, result.materials.upper);
  }
  result.triangles = shown.triangles.size();
  return result;
}

}  // namespace adamas::interfaces
