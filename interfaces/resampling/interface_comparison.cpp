#include "interfaces/resampling/interface_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "core/base/digest_numbers.h"
#include "core/base/hash.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/resampling/far_points.h"

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
/// What is near is looked up in cells of this size, relative to the target.
constexpr double kNearby = 1;
/// What a triangle of a tree that is built counts as progress.
constexpr double kTreeWork = 2;
/// If more than this part of the shown triangles has changed, all are measured again.
constexpr double kManyChanges = 0.25;
constexpr std::uint32_t kNoNumber = InterfaceComparison::kNoPoint;

/// Returns a number that triangles with equal corners share, whichever comes first.
Digest digest(std::array<Vec3, 3> corners) {
  const auto less = [](const Vec3& a, const Vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end(), less), corners.end());
  Digest result;
  for (const Vec3& p : corners) result.take(p);
  return result;
}

/// Returns a number that triangles with the same points share, whichever comes first.
Digest digest(ClosestPointTree::Triangle points) {
  std::rotate(points.begin(), std::min_element(points.begin(), points.end()), points.end());
  Digest result;
  for (const std::uint32_t p : points) result.take(std::uint64_t{p});
  return result;
}

template <class DigestAt>
std::vector<Digest> digests(std::size_t count, DigestAt&& digest_at) {
  std::vector<Digest> result(count);
  parallel_for(count, 4096, [&](std::size_t t) { result[t] = digest_at(t); });
  return result;
}

/// Returns the first place of each new triangle's digest among those before; kNoNumber if it is not there.
/// `now`: the digest of the new triangle at a place, of which there are `count`.
template <class DigestNow>
std::vector<std::uint32_t> places_among(const std::vector<Digest>& before, std::size_t count,
                                        DigestNow&& now) {
  DigestNumbers numbers;
  const std::vector<std::uint32_t> places = numbers.add(before).firsts;
  std::vector<std::uint32_t> result(count, kNoNumber);
  parallel_for(count, 4096, [&](std::size_t t) {
    if (const auto number = numbers.find(now(t))) result[t] = places[*number];
  });
  return result;
}

/// Returns the places that triangles had before which have not moved.
std::vector<std::uint32_t> places_of_equal(const TriangleList& before, const TriangleList& now) {
  return places_among(digests(before.size(), [&](std::size_t t) { return digest(before.corners(t)); }),
                      now.size(), [&](std::size_t t) { return digest(now.corners(t)); });
}

/// Returns the places that triangles had before, wherever they have moved. `points_before`: by point, the
/// number that it had; kNoNumber if it is new.
std::vector<std::uint32_t> places_of_same(const TriangleList& before, const TriangleList& now,
                                          const std::vector<std::uint32_t>& points_before) {
  const auto then = digests(before.size(), [&](std::size_t t) { return digest(before[t]); });
  return places_among(then, now.size(), [&](std::size_t t) {
    ClosestPointTree::Triangle points = now[t];
    for (std::uint32_t& p : points) p = points_before[p];
    return digest(points);
  });
}

/// The places of triangles in the two parts that each of them is in.
class PlacesInParts {
 public:
  /// `parts`: the number of parts that are boundaries.
  PlacesInParts(const MaterialBoundaries& boundaries, std::size_t parts)
      : boundaries_(boundaries), places_(boundaries.all().size()) {
    for (std::uint32_t p = 0; p < parts; ++p) {
      const TriangleList list(boundaries.tree(p));
      for (std::uint32_t t = 0; t < list.size(); ++t) {
        const std::uint32_t number = list.index(t);
        for (std::size_t side = 0; side < 2; ++side) {
          if (boundaries.parts_of(number)[side] == p) places_[number][side] = t;
        }
      }
    }
  }

  /// Returns the place of a triangle in a part; kNoNumber if it is not in it.
  [[nodiscard]] std::uint32_t place(std::uint32_t triangle, std::uint32_t part) const {
    const auto& parts = boundaries_.parts_of(triangle);
    if (parts[0] == part) return places_[triangle][0];
    return parts[1] == part ? places_[triangle][1] : kNoNumber;
  }

 private:
  const MaterialBoundaries& boundaries_;
  std::vector<std::array<std::uint32_t, 2>> places_;
};

/// The greatest of some values near a place, or of values not much farther away: each value has a box, and
/// those whose boxes touch the same cell of a grid count as near.
class ValuesNearby {
 public:
  /// `size`: that of the grid's cells.
  ValuesNearby(const Vec3& origin, double size) : origin_(origin), size_(size) {}

  void add(const Box3& box, double value) {
    greatest_ = std::max(greatest_, value);
    if (!for_each_cell(box, [&](std::uint64_t cell) {
          double& here = cells_.try_emplace(cell, value).first->second;
          here = std::max(here, value);
        }))
      everywhere_ = std::max(everywhere_, value);
  }
  /// Returns the greatest value near a box; 0 if there is none that is positive.
  [[nodiscard]] double greatest(const Box3& box) const {
    double result = everywhere_;
    const bool few = for_each_cell(box, [&](std::uint64_t cell) {
      if (const auto found = cells_.find(cell); found != cells_.end())
        result = std::max(result, found->second);
    });
    return few ? result : greatest_;
  }

 private:
  /// Visits the cells that a box touches; returns false if these are too many.
  template <class Visit>
  bool for_each_cell(const Box3& box, Visit&& visit) const {
    constexpr std::int64_t kMostCells = 4096;
    std::array<std::int64_t, 3> low{}, high{};
    std::int64_t count = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double from = (box.min[axis] - origin_[axis]) / size_,
                   to = (box.max[axis] - origin_[axis]) / size_;
      if (!(std::abs(from) < kFarCell && std::abs(to) < kFarCell)) return false;
      low[a] = static_cast<std::int64_t>(std::floor(from));
      high[a] = static_cast<std::int64_t>(std::floor(to));
      count *= std::min(kMostCells, high[a] - low[a]) + 1;
      if (count > kMostCells) return false;
    }
    for (std::int64_t i = low[0]; i <= high[0]; ++i) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        for (std::int64_t k = low[2]; k <= high[2]; ++k)
          visit(hash_combine(hash_combine(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j)),
                             static_cast<std::uint64_t>(k)));
      }
    }
    return true;
  }

  static constexpr double kFarCell = 1e9;
  Vec3 origin_;
  double size_;
  double everywhere_ = 0, greatest_ = 0;
  /// By a hash of the cell. That of two cells may be the same, which makes values greater.
  std::unordered_map<std::uint64_t, double> cells_;
};

Box3 box_of(const std::array<Vec3, 3>& corners) {
  Box3 box;
  for (const Vec3& p : corners) box.extend(p);
  return box;
}

/// Returns the box of the points that may be this close to a triangle.
Box3 reach_of(const std::array<Vec3, 3>& corners, double reach) {
  const Box3 box = box_of(corners);
  return {box.min - Vec3{reach, reach, reach}, box.max + Vec3{reach, reach, reach}};
}

InterfaceDistance greater(const InterfaceDistance& a, const InterfaceDistance& b) {
  const InterfaceDistance& lower = b.lower > a.lower ? b : a;
  return {std::max(a.upper, b.upper), lower.lower, lower.worst};
}

/// Triangles without common points.
struct TriangleSoup {
  void add(const std::array<Vec3, 3>& corners) {
    const auto first = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), corners.begin(), corners.end());
    triangles.push_back({first, first + 1, first + 2});
  }
  [[nodiscard]] ClosestPointTree tree() const { return {points, triangles}; }

  std::vector<Vec3> points;
  std::vector<ClosestPointTree::Triangle> triangles;
};

/// Marks the materials that have interfaces.
IdVector<MaterialId, char> used_materials(const InterfaceMesh& mesh) {
  IdVector<MaterialId, char> used(mesh.materials.size(), 0);
  for (const InterfaceTriangle& t : mesh.triangles) used[t.front] = used[t.back] = 1;
  return used;
}

IdVector<MaterialId, char> used_materials(const ResamplingSource& source) {
  IdVector<MaterialId, char> used(source.materials.size(), 0);
  const InterfaceTable& table = source.network->table();
  for (InterfaceId i(0); i.value < table.interface_count(); ++i.value) {
    for (const BodyId body : table.sides(i)) used[table.material(body)] = 1;
  }
  return used;
}

}  // namespace

InterfaceComparison::InterfaceComparison(const ResamplingSource& source, double target)
    : InterfaceComparison(used_materials(source), source.box, target) {
  junctions_known_ = !source.network->has_open_border() && source.network->inconsistencies() == 0;
  input_ = MaterialBoundaries(source.network, parts_, junctions_known_);
}

InterfaceComparison::InterfaceComparison(const InterfaceMesh& input, const Box3& box, bool closed,
                                         double target)
    : InterfaceComparison(used_materials(input), box, target) {
  junctions_known_ = closed;
  input_ = MaterialBoundaries(input, parts_, junctions_known_);
}

/// Makes the parts of the materials that are used.
InterfaceComparison::InterfaceComparison(const IdVector<MaterialId, char>& used, const Box3& box,
                                         double target)
    : box_(box), target_(target) {
  parts_.part_of.assign(used.size(), MaterialParts::kNoPart);
  for (MaterialId m(0); m.value < used.size(); ++m.value) {
    if (used[m] != 0) parts_.part_of[m] = static_cast<std::uint32_t>(parts_.count++);
  }
  if (parts_.count > 2) return;
  // With at most two materials, every triangle is in the boundary of each.
  std::fill(parts_.part_of.begin(), parts_.part_of.end(), 0u);
  parts_.count = 1;
}

InterfaceDistance InterfaceComparison::Bounds::distance() const {
  return greater({input_to_shown.upper, input_to_shown.lower, input_to_shown.worst},
                 {shown_to_input.upper, shown_to_input.lower, shown_to_input.worst});
}

/// Points and triangles whose distances are bounded count as one each; there are half as many points.
double InterfaceComparison::work_of_measuring(const InterfaceMesh& shown) const {
  double items = 0;
  for (std::size_t p = 0; p < input_.size(); ++p) items += 1.5 * static_cast<double>(input_.tree(p).size());
  const double sides = parts_.count > 1 ? 2 : 1;
  const auto points = static_cast<double>(shown.points.size()),
             triangles = static_cast<double>(shown.triangles.size());
  return items + sides * (points + triangles) + kTreeWork * triangles;
}

/// Begins to measure a part after some of its shown triangles have moved, come or gone; returns false if so
/// many have come or gone that all should be measured. `places_before`: by shown triangle of the part, its
/// place among those before; kNoNumber if it is new. Bounds follow moves: no point of a triangle moves
/// farther than its corners, and a point of the input has, within its bound, points of triangles that move or
/// go. Triangles that may be too far then are left.
bool InterfaceComparison::begin_changes(std::size_t part, const ClosestPointTree& before_tree,
                                        const std::vector<std::uint32_t>& places_before,
                                        Unfinished& unfinished, const HausdorffOptions& options,
                                        const Progress& progress) {
  const TriangleList &input = unfinished.input.lists[part], &now = unfinished.shown.lists[part];
  const TriangleList before(before_tree);
  DistanceBound &of_shown = bounds_[part].shown_to_input, &of_input = bounds_[part].input_to_shown;
  const DistanceBound old = std::exchange(of_shown, {});
  of_shown.triangle_upper.reserve(now.size());
  of_shown.triangle_lower.reserve(now.size());
  std::vector<char> remains(before.size(), 0);
  ValuesNearby moved(box_.min, kNearby * target_);
  double most = 0;
  TriangleSoup changes;
  for (std::uint32_t t = 0; t < now.size(); ++t) {
    const std::uint32_t place = places_before[t];
    const std::array<Vec3, 3> to = now.corners(t);
    double upper = kInfinity, lower = 0;
    if (place == kNoNumber) {
      changes.add(to);
    } else {
      remains[place] = 1;
      upper = old.triangle_upper[place];
      lower = old.triangle_lower[place];
      const std::array<Vec3, 3> from = before.corners(place);
      double by = 0;
      for (std::size_t c = 0; c < 3; ++c) by = std::max(by, distance(from[c], to[c]));
      if (by > 0) {
        most = std::max(most, by);
        moved.add(box_of(from), by);
        lower = std::max(0.0, lower - by);
        // Only what is outside of the box has no distance.
        upper = upper == 0 ? kInfinity : upper + by;
      }
    }
    of_shown.triangle_upper.push_back(upper);
    of_shown.triangle_lower.push_back(lower);
  }
  for (std::uint32_t t = 0; t < before.size(); ++t) {
    if (remains[t] == 0) changes.add(before.corners(t));
  }
  if (kManyChanges * static_cast<double>(now.size() + before.size()) <
      static_cast<double>(changes.triangles.size()))
    return false;
  unfinished.shown.left[part] =
      begin_distance_update(now, {}, input_.tree(part), options, of_shown, progress);
  for (std::uint32_t t = 0; t < input.size() && most > 0; ++t) {
    double& upper = of_input.triangle_upper[t];
    const bool may_be_far = upper + most > target_ && upper <= target_;
    const double by = may_be_far ? moved.greatest(reach_of(input.corners(t), upper)) : most;
    of_input.triangle_lower[t] = std::max(0.0, of_input.triangle_lower[t] - most);
    if (upper > 0 || box_.touches(box_of(input.corners(t)))) upper += by;
  }
  unfinished.input.left[part] =
      begin_distance_update(input, changes.tree(), shown_.tree(part), options, of_input, progress);
  return true;
}

InterfaceComparison::Unfinished::Unfinished(const MaterialBoundaries& input_boundaries,
                                            const MaterialBoundaries& shown_boundaries)
    : input(input_boundaries), shown(shown_boundaries) {}

InterfaceComparison::Unfinished::Direction::Direction(const MaterialBoundaries& boundaries)
    : left(boundaries.size()) {
  for (std::size_t p = 0; p < boundaries.size(); ++p) lists.emplace_back(boundaries.tree(p));
}

/// Bounds the triangles that are left in all parts.
void InterfaceComparison::finish_bounds(Unfinished& unfinished, const HausdorffOptions& options,
                                        const Progress& progress) {
  for (const bool of_input : {true, false}) {
    auto& [lists, left] = of_input ? unfinished.input : unfinished.shown;
    const MaterialBoundaries& to = of_input ? shown_ : input_;
    if (options.each && parts_.count > 1) bound_in_both_parts(of_input, lists, left, options, progress);
    for (std::size_t p = 0; p < lists.size(); ++p)
      finish_distance_bound(lists[p], left[p], to.tree(p), options, bound(p, of_input), progress);
  }
}

/// Bounds triangles that are left in both of their parts at once, where they are closest to triangles of the
/// same two parts: these are the closest ones in each of the two.
void InterfaceComparison::bound_in_both_parts(bool of_input, const std::vector<TriangleList>& lists,
                                              std::vector<std::vector<std::uint32_t>>& left,
                                              const HausdorffOptions& options, const Progress& progress) {
  const MaterialBoundaries &from = of_input ? input_ : shown_, &to = of_input ? shown_ : input_;
  std::vector<std::uint32_t> number(from.all().size(), 0);  // how often a triangle is left, then its number
  for (std::size_t p = 0; p < parts_.count; ++p) {
    for (const std::uint32_t place : left[p]) ++number[lists[p].index(place)];
  }
  std::vector<std::uint32_t> both;
  for (std::uint32_t t = 0; t < number.size(); ++t) {
    const bool chosen = number[t] == 2;
    number[t] = chosen ? static_cast<std::uint32_t>(both.size()) : kNoNumber;
    if (chosen) both.push_back(t);
  }
  if (both.empty()) return;
  // They count as triangles of two parts.
  LoopProgress::count_items(1.5 * static_cast<double>(both.size()));
  const auto has_both_parts = [&](std::uint32_t t, std::uint32_t found) {
    const auto &parts = from.parts_of(t), &others = to.parts_of(found);
    return parts == others || (parts[0] == others[1] && parts[1] == others[0]);
  };
  const DistanceBound found =
      bound_served_triangles(TriangleList(from.all()), both, to.all(), has_both_parts, options, progress);
  for (std::size_t p = 0; p < parts_.count; ++p) {
    // The place of the greatest distance is found with that triangle.
    const auto lower_of = [&](std::uint32_t place) {
      const std::uint32_t n = number[lists[p].index(place)];
      return n != kNoNumber && std::isfinite(found.triangle_upper[n]) ? found.triangle_lower[n] : -1;
    };
    const auto farthest = std::ranges::max_element(left[p], {}, lower_of);
    const std::uint32_t kept = farthest == left[p].end() ? kNoNumber : *farthest;
    std::erase_if(left[p], [&](std::uint32_t place) {
      if (lower_of(place) < 0 || place == kept) return false;
      const std::uint32_t n = number[lists[p].index(place)];
      bound(p, of_input).triangle_upper[place] = found.triangle_upper[n];
      if (DistanceBound& of_part = bound(p, of_input); !of_part.triangle_lower.empty())
        of_part.triangle_lower[place] = found.triangle_lower[n];
      return true;
    });
  }
}

HausdorffOptions InterfaceComparison::measuring_options() const {
  HausdorffOptions options;
  options.domain = box_;
  options.accept = target_;
  options.relative = kSharp;
  options.each = true;
  return options;
}

MaterialBoundaries InterfaceComparison::exchange_shown(const InterfaceMesh& shown) {
  MaterialBoundaries before = std::exchange(shown_, MaterialBoundaries(shown, parts_, junctions_known_));
  LoopProgress::count_items(kTreeWork * static_cast<double>(shown.triangles.size()));
  return before;
}

/// Bounds all distances from what is shown now. `places_before`: finds the places that shown triangles had
/// before (begin_changes), or lines; null if all are measured.
void InterfaceComparison::measure_shown(const MaterialBoundaries& before, const PlacesBefore& places_before,
                                        const HausdorffOptions& options, const Progress& progress) {
  bounds_.resize(input_.size());
  Unfinished unfinished(input_, shown_);
  // Most triangles are in two parts; they are found once for both.
  std::vector<std::uint32_t> numbers_before;
  std::optional<PlacesInParts> in_parts;
  if (places_before && !before.all().empty()) {
    numbers_before = places_before(TriangleList(before.all()), TriangleList(shown_.all()));
    in_parts.emplace(before, parts_.count);
  }
  for (std::size_t p = 0; p < input_.size(); ++p) {
    const TriangleList &input = unfinished.input.lists[p], &now = unfinished.shown.lists[p];
    const bool comparable = places_before && before.tree(p).size() > 0 && now.size() > 0 && input.size() > 0;
    const auto find_places = [&] {
      if (p == parts_.count) return places_before(TriangleList(before.tree(p)), now);
      std::vector<std::uint32_t> places(now.size(), kNoNumber);
      for (std::uint32_t t = 0; t < now.size(); ++t) {
        const std::uint32_t number = numbers_before[now.index(t)];
        if (number != kNoNumber) places[t] = in_parts->place(number, static_cast<std::uint32_t>(p));
      }
      return places;
    };
    if (comparable && begin_changes(p, before.tree(p), find_places(), unfinished, options, progress))
      continue;
    unfinished.input.left[p] =
        begin_distance_bound(input, shown_.tree(p), options, bounds_[p].input_to_shown, progress);
    unfinished.shown.left[p] =
        begin_distance_bound(now, input_.tree(p), options, bounds_[p].shown_to_input, progress);
  }
  finish_bounds(unfinished, options, progress);
  clear_far();
  if (options.each) find_far();
}

void InterfaceComparison::measure(const InterfaceMesh& shown, const Progress& progress, bool each) {
  const MaterialBoundaries before = exchange_shown(shown);
  HausdorffOptions options = measuring_options();
  options.each = each;
  const bool again = std::exchange(each_, each) && each && before.size() == shown_.size();
  measure_shown(before, again ? PlacesBefore(places_of_equal) : PlacesBefore(), options, progress);
}

void InterfaceComparison::measure_moved(const InterfaceMesh& shown,
                                        const std::vector<std::uint32_t>& points_before,
                                        const Progress& progress) {
  const auto places_before = [&](const TriangleList& before, const TriangleList& now) {
    return places_of_same(before, now, points_before);
  };
  const MaterialBoundaries before = exchange_shown(shown);
  measure_shown(before, places_before, measuring_options(), progress);
}

void InterfaceComparison::measure_moved(const InterfaceMesh& shown, const Progress& progress) {
  const auto places_before = [](const TriangleList& /*before*/, const TriangleList& now) {
    std::vector<std::uint32_t> places(now.size());
    std::iota(places.begin(), places.end(), 0u);
    return places;
  };
  const MaterialBoundaries before = exchange_shown(shown);
  measure_shown(before, places_before, measuring_options(), progress);
}

std::vector<double> InterfaceComparison::slack(double most) const {
  std::vector<double> result(shown_.all().size(), most);
  for (std::size_t p = 0; p < parts_.count; ++p) {
    const TriangleList input(input_.tree(p)), shown(shown_.tree(p));
    const Bounds& bounds = bounds_[p];
    ValuesNearby uppers(box_.min, kNearby * target_);
    for (std::size_t i = 0; i < input.size(); ++i) {
      const double upper = bounds.input_to_shown.triangle_upper[i];
      if (upper + most > target_ && std::isfinite(upper))
        uppers.add(reach_of(input.corners(i), upper), upper);
    }
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const double upper =
          std::max(bounds.shown_to_input.triangle_upper[i], uppers.greatest(box_of(shown.corners(i))));
      double& slack = result[shown.index(i)];
      if (upper + most > target_) slack = std::min(slack, std::max(0.0, target_ - upper));
    }
  }
  return result;
}

std::vector<std::uint32_t> InterfaceComparison::shown_near_far() const {
  std::vector<std::uint32_t> result = far_shown_, near;
  for (std::size_t p = 0; p < parts_.count; ++p) {
    const TriangleList input(input_.tree(p));
    for (std::size_t i = 0; i < input.size(); ++i) {
      const double upper = bounds_[p].input_to_shown.triangle_upper[i];
      if (!(upper > target_) || !std::isfinite(upper)) continue;
      shown_.tree(p).overlapping(reach_of(input.corners(i), upper), near);
      result.insert(result.end(), near.begin(), near.end());
    }
  }
  sort_unique(result);
  return result;
}

std::vector<std::uint32_t> InterfaceComparison::far_among(const InterfaceMesh& triangles,
                                                          const Progress& progress) const {
  const MaterialBoundaries some(triangles, parts_, false);
  std::vector<std::uint32_t> far;
  for (std::size_t p = 0; p < parts_.count; ++p) {
    const TriangleList list(some.tree(p));
    const DistanceBound bound = directed_distance_bound(list, input_.tree(p), measuring_options(), progress);
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (bound.triangle_upper[i] > target_) far.push_back(list.index(i));
    }
  }
  sort_unique(far);
  return far;
}

double InterfaceComparison::greatest() const {
  double greatest = 0;
  for (const Bounds& b : bounds_) greatest = std::max(greatest, b.distance().upper);
  return greatest;
}

double InterfaceComparison::greatest_of_materials() const {
  double greatest = 0;
  for (std::size_t p = 0; p < parts_.count; ++p) greatest = std::max(greatest, bounds_[p].distance().upper);
  return greatest;
}

double InterfaceComparison::greatest_of_shown() const {
  double greatest = 0;
  for (const Bounds& b : bounds_) {
    if (std::isfinite(b.distance().upper)) greatest = std::max(greatest, b.distance().upper);
  }
  return greatest;
}

bool InterfaceComparison::within() const { return greatest() <= target_; }

void InterfaceComparison::clear_far() {
  far_.assign(input_.all().size(), 0);
  far_shown_.clear();
  for (auto& points : far_junctions_) points.clear();
}

void InterfaceComparison::find_far() {
  for (std::size_t p = 0; p < parts_.count; ++p) {
    const TriangleList input(input_.tree(p)), shown(shown_.tree(p));
    for (std::size_t i = 0; i < input.size(); ++i) {
      if (!(bounds_[p].input_to_shown.triangle_upper[i] > target_)) continue;
      const std::uint32_t t = input.index(i);
      far_[t] = static_cast<std::uint8_t>(far_[t] | (input_.parts_of(t)[0] == p ? 1u : 2u));
    }
    for (std::size_t i = 0; i < shown.size(); ++i) {
      if (bounds_[p].shown_to_input.triangle_upper[i] > target_) far_shown_.push_back(shown.index(i));
    }
  }
  sort_unique(far_shown_);
  far_junctions_[0] = far_points(TriangleList(input_.lines()), bounds_.back().input_to_shown, shown_.lines());
  far_junctions_[1] = far_points(TriangleList(shown_.lines()), bounds_.back().shown_to_input, input_.lines());
}

/// Returns sample points of the lines that are too far; of a line on which none is found, all sample points.
std::vector<Vec3> InterfaceComparison::far_points(const TriangleList& lines, const DistanceBound& bound,
                                                  const ClosestPointTree& others) const {
  std::vector<Vec3> result, seen;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!(bound.triangle_upper[i] > target_)) continue;
    const auto [a, b, end] = lines.corners(i);
    const std::size_t before = result.size();
    seen.clear();
    for_each_sample(a, b, target_, [&](const Vec3& p) {
      if (!box_.contains(p)) return;
      seen.push_back(p);
      if (!others.is_within(p, target_)) result.push_back(p);
    });
    if (result.size() == before) result.insert(result.end(), seen.begin(), seen.end());
  }
  return result;
}

bool InterfaceComparison::has_far_point(std::uint32_t triangle, std::size_t side,
                                        const Tetrahedron& cell) const {
  const ClosestPointTree& boundary = shown_.tree(input_.parts_of(triangle)[side]);
  return has_far_point_in(cell, input_.all().triangle(triangle), boundary, target_);
}

/// Tightens the bounds of the materials' triangles that are greater than wanted where a distance of `seen`
/// was measured, as far as two parts have them in common.
void InterfaceComparison::tighten_in_both_parts(double seen, const Progress& progress) {
  HausdorffOptions options = measuring_options();
  options.accept = std::max(kSmall * target_, (1 + kTight) * seen);
  options.relative = kTight;
  for (const bool of_input : {true, false}) {
    const MaterialBoundaries& from = of_input ? input_ : shown_;
    std::vector<TriangleList> lists;
    std::vector<std::vector<std::uint32_t>> left(parts_.count);
    std::vector<std::vector<double>> before(parts_.count);  // by place that is left
    for (std::size_t p = 0; p < parts_.count; ++p) {
      lists.emplace_back(from.tree(p));
      const std::vector<double>& upper = bound(p, of_input).triangle_upper;
      for (std::uint32_t place = 0; place < upper.size(); ++place) {
        if (!(upper[place] > options.accept)) continue;
        left[p].push_back(place);
        before[p].push_back(upper[place]);
      }
    }
    const std::vector<std::vector<std::uint32_t>> places = left;
    bound_in_both_parts(of_input, lists, left, options, progress);
    // Bounds from before hold too, and may be the tighter ones.
    for (std::size_t p = 0; p < parts_.count; ++p) {
      std::vector<double>& upper = bound(p, of_input).triangle_upper;
      for (std::size_t i = 0; i < places[p].size(); ++i)
        upper[places[p][i]] = std::min(upper[places[p][i]], before[p][i]);
    }
  }
}

/// Tightens the bounds of a part. Distances below `seen`, which was measured elsewhere, need not be known.
void InterfaceComparison::tighten(std::size_t part, double seen, const Progress& progress) {
  HausdorffOptions options;
  options.domain = box_;
  options.accept = kSmall * target_;
  options.relative = kTight;
  const auto tightened = [&](const ClosestPointTree& from, const ClosestPointTree& to, DistanceBound& bound) {
    const double lower = bound.lower;
    const Vec3 worst = bound.worst;
    bound.lower = std::max(bound.lower, seen);
    tighten_distance_bound(TriangleList(from), to, options, bound, progress);
    if (bound.lower <= seen) bound.lower = lower, bound.worst = worst;
    return std::max(seen, bound.lower);
  };
  seen = std::max({seen, bounds_[part].input_to_shown.lower, bounds_[part].shown_to_input.lower});
  seen = tightened(input_.tree(part), shown_.tree(part), bounds_[part].input_to_shown);
  tightened(shown_.tree(part), input_.tree(part), bounds_[part].shown_to_input);
}

/// Returns bounds of the distances of all triangles of the input, or of the shown ones, from the whole
/// other network: those of the boundaries of the triangles' materials, which are parts of it.
DistanceBound InterfaceComparison::bound_of_materials(bool of_input) const {
  const MaterialBoundaries& boundaries = of_input ? input_ : shown_;
  DistanceBound bound;
  bound.triangle_upper.assign(boundaries.all().size(), kInfinity);
  for (std::size_t p = 0; p < parts_.count; ++p) {
    const TriangleList triangles(boundaries.tree(p));
    const DistanceBound& part = of_input ? bounds_[p].input_to_shown : bounds_[p].shown_to_input;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      double& upper = bound.triangle_upper[triangles.index(i)];
      upper = std::min(upper, part.triangle_upper[i]);
    }
  }
  return bound;
}

InterfaceDistance InterfaceComparison::measure_networks(const Progress& progress) const {
  HausdorffOptions options;
  options.domain = box_;
  options.accept = kSmall * target_;
  options.relative = kTight;
  DistanceBound input_to_shown = bound_of_materials(true);
  tighten_distance_bound(TriangleList(input_.all()), shown_.all(), options, input_to_shown, progress);
  // The other direction only matters if it is greater than this one.
  DistanceBound shown_to_input = bound_of_materials(false);
  shown_to_input.lower = input_to_shown.lower;
  shown_to_input.worst = input_to_shown.worst;
  tighten_distance_bound(TriangleList(shown_.all()), input_.all(), options, shown_to_input, progress);
  return Bounds{std::move(input_to_shown), std::move(shown_to_input)}.distance();
}

InterfaceDistance InterfaceComparison::certified(InterfaceDistance distance) const {
  if (distance.upper <= target_)
    distance.upper = std::min(distance.upper + kRoundOff * box_.diagonal(), target_);
  return distance;
}

InterfaceCertificate InterfaceComparison::summary() const {
  InterfaceCertificate result;
  std::size_t worst = 0;
  for (std::size_t p = 0; p < parts_.count; ++p) {
    const InterfaceDistance d = bounds_[p].distance();
    if (d.lower > result.materials.lower) worst = p;
    result.materials = greater(result.materials, d);
  }
  result.materials = certified(result.materials);
  const auto& part_of = parts_.part_of;
  const auto found = std::find(part_of.begin(), part_of.end(), static_cast<std::uint32_t>(worst));
  result.worst_material = MaterialId(static_cast<std::size_t>(found - part_of.begin()));
  if (!input_.lines().empty() || !shown_.lines().empty())
    result.junctions = certified(bounds_.back().distance());
  return result;
}

InterfaceCertificate InterfaceComparison::finish(const Progress& progress) {
  const auto tighten_parts = [&](std::size_t first, std::size_t last) {
    double seen = 0;
    bool reached = true;
    for (std::size_t p = first; p < last; ++p) {
      const InterfaceDistance d = bounds_[p].distance();
      seen = std::max(seen, d.lower);
      reached = reached && d.upper <= target_;
    }
    if (reached && last - first > 1) tighten_in_both_parts(seen, progress);
    for (std::size_t p = first; reached && p < last; ++p) tighten(p, seen, progress);
  };
  tighten_parts(0, parts_.count);
  tighten_parts(parts_.count, input_.size());
  InterfaceCertificate result = summary();
  result.networks = result.materials;
  if (parts_.count > 1) {
    // The materials' bound holds for the networks too, as every interface is a part of two materials'
    // boundaries.
    result.networks = certified(measure_networks(progress));
    result.networks.upper = std::min(result.networks.upper, result.materials.upper);
  }
  result.triangles = shown_.all().size();
  return result;
}

}  // namespace adamas::interfaces
