#include "interfaces/resampling/body_mending.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"

namespace adamas::interfaces {

namespace {

/// The approximate number of points from which thin places are sought, and the greatest number of points
/// along a side of a triangle.
constexpr double kMostPoints = 2.5e5, kMostAlongSide = 64;
/// If more triangles than this are at most as large as the spacing, only some of them are used.
constexpr std::size_t kMostSmall = 250'000;
/// The number of places whose leaves are sought at once.
constexpr std::size_t kPlacesAtOnce = std::size_t{1} << 16;

/// Cells of at most this size, relative to the target, are not split to remove contacts.
constexpr double kFinestForContacts = 0.0625;
/// Cells of at most this size, relative to the thickness of a body, are not split to show the body.
constexpr double kFinestForThickness = 0.25;
/// The greatest thickness of places where bodies are checked for tears, relative to the target.
constexpr double kMostTornThickness = 4;
/// The distance between the places that are checked, relative to the target.
constexpr double kSpacing = 1;
/// The number of times that cells are split for lost or joined bodies before these are measured again; three
/// splits halve a cell.
constexpr int kSplitsForLost = 3;
/// Cells that tear bodies are split if they are at least this large, relative to the largest of them.
constexpr double kLargeCells = 0.7;
/// More cells are worth it if at most kTornPart of the tears is left. Above kHopeForBodies leaves, the number
/// of tears must also fall faster than that of leaves grows; this is checked once there are kJudgedGrowth
/// times more leaves.
constexpr double kTornPart = 0.7;
constexpr std::size_t kHopeForBodies = 20'000;
constexpr double kJudgedGrowth = 1.1;
/// Splitting is undone if nothing has become better when there are this many times more leaves: what mends
/// bodies at all mends them with few more leaves.
constexpr double kMostGrowth = 1.25;

/// There are about so many more leaves for each that is split for tears, since others are split with it.
constexpr std::size_t kMoreLeaves = 16;
/// That is not relied on for fewer leaves than this.
constexpr std::size_t kMostForetold = 4 * kHopeForBodies;

/// Moves are of no use if more than this part of the places that were torn is torn after them: on 12 data
/// sets at 1 to 3%, no moves were accepted that left more than 0.27.
constexpr double kHopelessPart = 1.0 / 3;
/// The greatest move of a signed distance, relative to the wanted interface error.
constexpr double kMostMoved = 0.5;
/// The height to which a body is raised above the others at the middle of a thin place, relative to its
/// thickness, so that it also owns the space between such places.
constexpr double kMargin = 0.25;
/// A mesh whose distance from the input exceeds this, relative to the wanted interface error, is not mended
/// by moves.
constexpr double kFarOff = 2;
/// Distances are moved back at most kMostReturns times where interfaces are too far from the input's: by half
/// first, then wholly, and after kReturnsAlone times in neighbouring cells as well.
constexpr int kMostReturns = 5, kReturnsAlone = 2;
/// The greatest number of passes: raising a body at one place lowers others, so some may stay torn.
constexpr int kMostPasses = 12;

double product(std::size_t a, std::size_t b) { return static_cast<double>(a) * static_cast<double>(b); }

NearDistance* find_near(VertexDistances& vertex, InterfaceId interface) {
  const auto found = std::ranges::find(vertex.near, interface, &NearDistance::interface);
  return found == vertex.near.end() ? nullptr : &*found;
}

/// Returns the middle of one of n^2 equal parts of a triangle.
Vec3 middle_of_part(const std::array<Vec3, 3>& corners, int n, int part) {
  const Vec3 u = (1.0 / n) * (corners[1] - corners[0]), v = (1.0 / n) * (corners[2] - corners[0]);
  // Each row has two parts less than the one before. Every other part points the other way.
  int i = 0;
  for (; part >= 2 * (n - i) - 1; ++i) part -= 2 * (n - i) - 1;
  const int j = part / 2;
  if (part % 2 == 0) return corners[0] + (i + 1.0 / 3) * u + (j + 1.0 / 3) * v;
  return corners[0] + (i + 2.0 / 3) * u + (j + 2.0 / 3) * v;
}

double longest_side(const std::array<Vec3, 3>& corners) {
  return std::max(
      {distance(corners[0], corners[1]), distance(corners[1], corners[2]), distance(corners[2], corners[0])});
}

}  // namespace

ThinPlaces::ThinPlaces(const InterfaceNetwork& network, double spacing)
    : network_(network), spacing_(spacing) {
  const std::size_t count = network.triangles().size();
  double squares = 0;
  for (std::uint32_t t = 0; t < count; ++t) {
    const double side = longest_side(network.triangle_corners(t));
    squares += side * side;
  }
  spacing_ = std::max(spacing, std::sqrt(squares / kMostPoints));
  std::size_t small = 0;
  for (std::uint32_t t = 0; t < count; ++t)
    small += longest_side(network.triangle_corners(t)) <= spacing_ ? 1 : 0;
  stride_ = small / kMostSmall + 1;
}

int ThinPlaces::points_along_side(const std::array<Vec3, 3>& corners) const {
  return static_cast<int>(std::clamp(std::ceil(longest_side(corners) / spacing_), 1.0, kMostAlongSide));
}

/// Returns the normal that points into the body on a side of a triangle.
Vec3 ThinPlaces::inwards(std::uint32_t triangle, std::size_t side) const {
  return (side == 0 ? 1.0 : -1.0) * network_.normal(triangle);
}

BodyId ThinPlaces::body(std::uint32_t i) const {
  return network_.table().sides(network_.interface_of(found_[i].triangle))[found_[i].side];
}

Vec3 ThinPlaces::middle(std::uint32_t i) const {
  const Found& found = found_[i];
  const std::array<Vec3, 3> corners = network_.triangle_corners(found.triangle);
  const Vec3 p = middle_of_part(corners, points_along_side(corners), static_cast<int>(found.point));
  return p + 0.5 * found.thickness * inwards(found.triangle, found.side);
}

void ThinPlaces::add(const IdVector<BodyId, char>& marked, const Box3& box, double thickest) {
  const auto look = [&](std::uint32_t t, const Vec3& p, std::uint32_t point, std::vector<Found>& places) {
    const auto& bodies = network_.table().sides(network_.interface_of(t));
    for (std::uint32_t side = 0; side < 2; ++side) {
      if (marked[bodies[side]] == 0) continue;
      const auto hit = network_.tree().first_hit(p, inwards(t, side), thickest, t);
      if (!hit) continue;
      const auto& opposite = network_.table().sides(network_.interface_of(hit->triangle));
      if (opposite[0] != bodies[side] && opposite[1] != bodies[side]) continue;
      if (box.contains(p + 0.5 * hit->t * inwards(t, side))) places.push_back({t, point, side, hit->t});
    }
  };
  const auto found = parallel_collect<Found>(
      network_.triangles().size(), 256, [&](std::size_t first, std::size_t last, auto& places) {
        for (std::size_t i = first; i < last; ++i) {
          const auto t = static_cast<std::uint32_t>(i);
          const auto& [a, b] = network_.table().sides(network_.interface_of(t));
          if (marked[a] == 0 && marked[b] == 0) continue;
          const std::array<Vec3, 3> corners = network_.triangle_corners(t);
          const int n = points_along_side(corners);
          if (n == 1 && t % stride_ != 0) continue;
          for (int part = 0; part < n * n; ++part)
            look(t, middle_of_part(corners, n, part), static_cast<std::uint32_t>(part), places);
        }
      });
  found_.insert(found_.end(), found.begin(), found.end());
}

bool ShownBodies::are_better_than(const ShownBodies& other) const {
  if (faults.lost_or_joined != other.faults.lost_or_joined)
    return faults.lost_or_joined < other.faults.lost_or_joined;
  if (static_cast<double>(faults.torn) > kTornPart * static_cast<double>(other.faults.torn)) return false;
  return leaves <= kHopeForBodies || product(faults.torn, leaves) <= product(other.faults.torn, other.leaves);
}

std::size_t ShownBodies::most_leaves() const {
  return std::max(kHopeForBodies, static_cast<std::size_t>(kMostGrowth * static_cast<double>(leaves)));
}

void BodyMending::measure() {
  if (std::exchange(measured_, shown_.number()) == shown_.number()) return;
  state_.report("comparing bodies");
  bodies_.measure(shown_.extracted());
}

BodyMending::Shown BodyMending::extract_and_measure() {
  measure();
  Shown before{shown_.extract(), bodies_.findings()};
  measure();
  return before;
}

void BodyMending::go_back(Shown shown, std::optional<InterfaceComparison> distances) {
  if (distances) {
    shown_.go_back({std::move(shown.extracted), *std::move(distances)});
  } else {
    shown_.go_back(std::move(shown.extracted));
  }
  bodies_.go_back(std::move(shown.bodies));
  measured_ = shown_.number();
}

/// Finds the thin places of bodies that are wrong now, but for those that were found before.
void BodyMending::find_places() {
  IdVector<BodyId, char> marked = wrong_bodies();
  sought_.resize(marked.size(), 0);
  bool any = false;
  for (BodyId b(0); b.value < marked.size(); ++b.value) {
    if (std::exchange(sought_[b], marked[b] != 0 ? 1 : sought_[b]) != 0) marked[b] = 0;
    any = any || marked[b] != 0;
  }
  if (!any) return;
  const double target = state_.options.interface_error;
  const LoopProgress stage(state_.progress, state_.stage("finding thin places"),
                           {.items = static_cast<double>(state_.source.network->triangles().size())});
  if (!places_) places_.emplace(*state_.source.network, kSpacing * target);
  places_->add(marked, state_.source.box, kMostTornThickness * target);
}

/// Marks the bodies larger than the target whose topology the mesh does not show correctly.
IdVector<BodyId, char> BodyMending::wrong_bodies() const {
  IdVector<BodyId, char> wrong(state_.source.network->table().body_count(), 0);
  for (BodyId b(0); b.value < wrong.size(); ++b.value)
    wrong[b] =
        !bodies_.report().keeps_topology(b) && bodies_.size(b) > state_.options.interface_error ? 1 : 0;
  return wrong;
}

/// Returns the thin places within the marked bodies.
BodyMending::PlacesByLeaf BodyMending::places_by_leaf(const IdVector<BodyId, char>& bodies) const {
  PlacesByLeaf places;
  for (std::uint32_t i = 0; places_ && i < places_->size(); ++i) {
    if (bodies[places_->body(i)] != 0) places.emplace_back(TetrahedronId(), i);
  }
  std::vector<Vec3> middles;
  for (std::size_t first = 0; first < places.size(); first += kPlacesAtOnce) {
    const std::size_t count = std::min(kPlacesAtOnce, places.size() - first);
    middles.resize(count);
    parallel_for(count, 1024, [&](std::size_t n) { middles[n] = places_->middle(places[first + n].second); });
    const std::vector<TetrahedronId> leaves = state_.leaves_at(middles);
    for (std::size_t n = 0; n < count; ++n) places[first + n].first = leaves[n];
  }
  std::sort(places.begin(), places.end());
  return places;
}

/// Returns what visit(place, leaf, owner, owners) returns at those of these places that other bodies own,
/// with their numbers: `owner` owns the place, and `owners` is the ownership of its leaf, which is computed
/// once for many places.
template <class T, class Visit>
std::vector<std::pair<std::uint32_t, T>> BodyMending::collect_at(const PlacesByLeaf& places,
                                                                 Visit&& visit) const {
  using Result = std::pair<std::uint32_t, T>;
  return parallel_collect<Result>(places.size(), 256, [&](std::size_t begin, std::size_t end, auto& list) {
    CellOwnership owners;
    OwnershipProblem fewer;
    std::optional<Tetrahedron> frame;
    std::vector<BodyId> bodies;
    for (std::size_t n = begin; n < end; ++n) {
      const auto& [leaf, i] = places[n];
      if (n == begin || leaf != places[n - 1].first) {
        bodies.clear();
        for (std::size_t m = n; m < end && places[m].first == leaf; ++m)
          bodies.push_back(places_->body(places[m].second));
        sort_unique(bodies);
        frame = state_.frame(leaf);
        state_.ownership(leaf, owners, {.bodies = bodies});
        fewer = owners.problem;
        if (!owners.pure()) {
          drop_high_functions(fewer);
          drop_dominated(fewer);
        }
      }
      const BodyId owner(fewer.candidates.size() == 1 ? fewer.candidates[0].owner
                                                      : fewer.owner(frame->weights(places_->middle(i))));
      if (owner == places_->body(i)) continue;
      if (const std::optional<T> result = visit((*places_)[i], leaf, owner, owners))
        list.emplace_back(i, *result);
    }
  });
}

/// Returns the largest of the leaves that give places within wrong bodies to other bodies.
BodyMending::TornLeaves BodyMending::torn_leaves() const {
  struct Torn {
    TetrahedronId leaf;
    double diameter = 0;  ///< zero if the leaf is small enough
  };
  auto torn = collect_at<Torn>(places_by_leaf(wrong_bodies()), [&](const ThinPlace& place, TetrahedronId leaf,
                                                                   BodyId, const CellOwnership&) {
    const double diameter = state_.frame(leaf).diameter();
    return std::optional(Torn{leaf, diameter > kFinestForThickness * place.thickness ? diameter : 0});
  });
  std::ranges::sort(torn, {}, &std::pair<std::uint32_t, Torn>::first);
  TornLeaves result;
  result.places = torn.size();
  double largest = 0;
  for (const auto& [place, t] : torn) largest = std::max(largest, t.diameter);
  // Larger cells are split first, since their tears are often the only ones.
  for (const auto& [place, t] : torn) {
    if (t.diameter > 0 && t.diameter >= kLargeCells * largest) result.leaves.push_back(t.leaf);
  }
  sort_unique(result.leaves);
  return result;
}

/// Splits the leaves at places where bodies are lost or touch others that they do not touch in the input;
/// returns whether any were split.
bool BodyMending::split_for_lost_bodies() {
  struct Place {
    Vec3 position;
    double finest;
  };
  std::vector<Place> places;
  for (const std::uint32_t t : bodies_.findings().contact_triangles)
    places.push_back(
        {shown_.extracted().mesh.centroid(t), kFinestForContacts * state_.options.interface_error});
  for (std::uint32_t i = 0; places_ && i < places_->size(); ++i) {
    const BodyId body = places_->body(i);
    if (bodies_.report().mesh[body].pieces == 0 && bodies_.size(body) > state_.options.interface_error)
      places.push_back({places_->middle(i), kFinestForThickness * places_->thickness(i)});
  }
  bool any = false;
  for (int i = 0; i < kSplitsForLost; ++i) {
    std::vector<TetrahedronId> leaves;
    for (const Place& place : places) state_.add_leaf_at(place.position, place.finest, leaves);
    std::vector<TetrahedronId> created = refinement_.split_failing(std::move(leaves));
    if (created.empty()) break;
    any = true;
    refinement_.refine_to_targets(std::move(created));
  }
  return any;
}

std::optional<RefinementEnd> BodyMending::split_cells(ShownBodies& best) {
  find_places();
  if (split_for_lost_bodies()) return {};
  TornLeaves torn = torn_leaves();
  const double few = kTornPart * static_cast<double>(torn.places);
  if (!best.given_away) best.given_away = torn.places;
  std::optional<RefinementEnd> end = RefinementEnd::kSmallestCells;
  while (!torn.leaves.empty()) {
    const std::size_t more = kMoreLeaves * torn.leaves.size(),
                      foretold = state_.hierarchy.leaf_count() + more;
    if (foretold > best.most_leaves() && foretold > kMostForetold) return RefinementEnd::kSmallestCells;
    std::vector<TetrahedronId> created = refinement_.split_failing(std::move(torn.leaves));
    if (created.empty())
      return end ? (state_.budget_spent ? RefinementEnd::kBudget : RefinementEnd::kDepth) : end;
    end = {};
    refinement_.refine_to_targets(std::move(created));
    const std::size_t leaves = state_.hierarchy.leaf_count();
    if (state_.budget_spent || leaves > best.most_leaves()) break;
    torn = torn_leaves();
    const bool hopeless = static_cast<double>(leaves) > kJudgedGrowth * static_cast<double>(best.leaves) &&
                          product(torn.places, leaves) > product(*best.given_away, best.leaves);
    if (hopeless && leaves > kHopeForBodies) return RefinementEnd::kSmallestCells;
    if (static_cast<double>(torn.places) <= few) break;
  }
  return end;
}

/// Returns the move that makes a body the owner of its thin place instead of the present owner; none if the
/// two share no interface in the leaf.
std::optional<BodyMending::InterfaceMove> BodyMending::move_at(const ThinPlace& place, TetrahedronId leaf,
                                                               BodyId owner,
                                                               const CellOwnership& owners) const {
  if (owners.pure()) return {};
  const Weights at = state_.frame(leaf).weights(place.middle);
  const auto& candidates = owners.problem.candidates;
  const std::size_t own = owners.candidate(place.body), other = owners.candidate(owner);
  if (own == candidates.size()) return {};
  const double below =
      owners.problem.value(candidates[other], at) - owners.problem.value(candidates[own], at);
  for (const CellOwnership::Interface& interface : owners.interfaces) {
    const auto& [a, b] = state_.source.network->table().sides(interface.id);
    // The first body rises by this, and the second one falls by as much.
    const double by = 0.5 * below + kMargin * place.thickness;
    if (a == place.body && b == owner) return InterfaceMove{leaf, interface.id, by};
    if (b == place.body && a == owner) return InterfaceMove{leaf, interface.id, -by};
  }
  return {};
}

std::vector<VertexId> BodyMending::vertices_of(const Distances& distances) {
  std::vector<VertexId> vertices;
  for (const auto& [where, distance] : distances) vertices.push_back(where.first);
  return vertices;
}

namespace {

/// Returns whether moves are of no use that leave this many of the places that were torn.
bool is_hopeless(std::size_t left, std::size_t torn_first) {
  return static_cast<double>(left) > kHopelessPart * static_cast<double>(torn_first);
}

}  // namespace

/// Moves the signed distances at the corners of cells that give places within wrong bodies to others, by at
/// most a part of the interface error, until they no longer do so. Returns the original values of the moved
/// distances; none if that is hopeless, and nothing is moved then.
BodyMending::Distances BodyMending::move_for_wrong_bodies() {
  const PlacesByLeaf all = places_by_leaf(wrong_bodies());
  const auto move = [this](const ThinPlace& place, TetrahedronId leaf, BodyId owner,
                           const CellOwnership& owners) { return move_at(place, leaf, owner, owners); };
  Distances originals;
  std::vector<std::pair<std::uint32_t, InterfaceMove>> moves;
  const LoopProgress stage(state_.progress, state_.stage("moving interfaces at thin places"),
                           {.items = static_cast<double>(all.size())});
  std::size_t torn_first = 0;
  std::optional<std::size_t> torn_last;
  bool again = false;  // then only places that were torn are checked again
  for (int pass = 0; pass < kMostPasses; ++pass) {
    PlacesByLeaf torn;
    if (again) {
      std::ranges::sort(moves, {}, &std::pair<std::uint32_t, InterfaceMove>::first);
      std::ranges::copy_if(all, std::back_inserter(torn), [&](const auto& place) {
        return std::ranges::binary_search(moves, place.second, {},
                                          &std::pair<std::uint32_t, InterfaceMove>::first);
      });
    }
    moves = collect_at<InterfaceMove>(again ? torn : all, move);
    if (pass == 0) torn_first = moves.size();
    // Where the first moves leave many places torn, they tear even more of the others.
    if (pass == 1 && is_hopeless(moves.size(), torn_first)) {
      torn_last = moves.size();
      break;
    }
    const bool any = apply(moves, originals);
    if (!any && !again) {
      torn_last = moves.size();
      break;
    }
    again = any;
  }
  // Moves tear other places. Bodies would tell as much, but what leaves show would have to be found for them.
  if (!torn_last) torn_last = collect_at<InterfaceMove>(all, move).size();
  moving_is_hopeless_ = is_hopeless(*torn_last, torn_first);
  if (moving_is_hopeless_) restore(std::exchange(originals, {}));
  return originals;
}

void BodyMending::restore(const Distances& originals) {
  for (const auto& [where, original] : originals)
    find_near(state_.hierarchy.payload(where.first).distances, where.second)->distance = original;
}

/// Applies these moves, adds the original values of newly moved distances, and returns whether any was moved.
bool BodyMending::apply(const std::vector<std::pair<std::uint32_t, InterfaceMove>>& moves,
                        Distances& originals) {
  const double most = kMostMoved * state_.options.interface_error;
  // Each distance gets the greatest of the moves that its places need.
  Distances wanted;
  for (const auto& [place, move] : moves) {
    for (const VertexId v : state_.hierarchy.vertices(move.leaf)) {
      double& by = wanted[{v, move.interface}];
      const double size = std::abs(move.by);
      if (size > std::abs(by) || (size == std::abs(by) && move.by < by)) by = move.by;
    }
  }
  bool any = false;
  for (const auto& [where, by] : wanted) {
    NearDistance* near = find_near(state_.hierarchy.payload(where.first).distances, where.second);
    if (near == nullptr) continue;
    const auto known = originals.find(where);
    const double original = known == originals.end() ? near->distance : known->second;
    const double moved = std::clamp(near->distance + by, original - most, original + most);
    if (moved == near->distance) continue;
    originals.emplace(where, original);
    near->distance = moved;
    any = true;
  }
  return any;
}

/// Returns the leaves that have one of these corners, which must be ascending.
std::vector<TetrahedronId> BodyMending::leaves_at(const std::vector<VertexId>& corners) const {
  std::vector<TetrahedronId> result = state_.leaves();
  std::erase_if(result, [&](TetrahedronId t) {
    return std::ranges::none_of(state_.hierarchy.vertices(t),
                                [&](VertexId v) { return std::ranges::binary_search(corners, v); });
  });
  return result;
}

/// Reduces the moves of distances at these corners, which must be ascending, to a share of them.
void BodyMending::move_back(const Distances& originals, const std::vector<VertexId>& corners, double share) {
  for (const auto& [where, original] : originals) {
    if (!std::ranges::binary_search(corners, where.first)) continue;
    double& distance = find_near(state_.hierarchy.payload(where.first).distances, where.second)->distance;
    distance = original + share * (distance - original);
  }
  state_.forget_contacts(corners);
}

bool BodyMending::move_interfaces(std::size_t part) {
  const BodyFaults before = faults();
  // If distances to vertices displace interfaces too, they could be moved so far that no cell is within the
  // target.
  const bool moved_otherwise = state_.options.distance != DistanceMode::kExact;
  // Such moves cannot mend a mesh that may not grow and is much farther away.
  const bool far_off =
      state_.budget_spent && shown_.comparison().greatest() > kFarOff * state_.options.interface_error;
  if (before.torn == 0 || moved_otherwise || far_off || moving_is_hopeless_) return false;
  const bool within = shown_.comparison().within();
  const std::size_t off = volumes_.bodies_off();
  find_places();
  const Distances originals = move_for_wrong_bodies();
  if (originals.empty()) return false;
  const std::vector<VertexId> moved = vertices_of(originals);
  ResamplingState::ShownByLeaves shown_by_leaves = state_.forget_contacts(moved);
  // Bodies tell in less time than distances whether it may be worth it.
  Shown unmoved = extract_and_measure();
  BodyFaults now = faults();
  moving_is_hopeless_ = now.torn >= before.torn || now.lost_or_joined > before.lost_or_joined;
  std::optional<InterfaceComparison> unmoved_distances;
  if (!moving_is_hopeless_ && 2 * now.torn <= before.torn) {
    unmoved_distances = shown_.comparison();
    shown_.measure_extracted(true);
    for (int i = 1; within && !shown_.comparison().within() && i <= kMostReturns; ++i) {
      std::vector<VertexId> corners = state_.corners(shown_.failing_leaves());
      if (corners.empty()) break;
      if (i > kReturnsAlone) corners = state_.corners(leaves_at(corners));
      move_back(originals, corners, i == 1 ? 0.5 : 0);
      shown_.measure(true);
      measure();
      now = faults();
    }
    if (part * now.torn <= before.torn && now.lost_or_joined <= before.lost_or_joined &&
        (shown_.comparison().within() || !within) && volumes_.bodies_off() <= off)
      return true;
  }
  restore(originals);
  state_.forget_contacts(moved);
  state_.restore_contacts(std::move(shown_by_leaves));
  go_back(std::move(unmoved), std::move(unmoved_distances));
  return false;
}

}  // namespace adamas::interfaces
