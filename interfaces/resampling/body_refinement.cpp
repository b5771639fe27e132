#include <algorithm>
#include <array>

#include "core/base/parallel.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

namespace {

/// Cells this small, in relation to the target, are not split further for the sake of contacts.
constexpr double kFinestForContacts = 0.0625;
/// Cells much smaller than the thickness of a body show it, if any do.
constexpr double kFinestForThickness = 0.25;
/// How thick a body may be where it is looked at whether it is torn, in relation to the target.
constexpr double kMostTornThickness = 4;
/// How far from each other the places are that are looked at, in relation to the target.
constexpr double kSpacing = 0.5;
/// Bodies that are lost or joined are split for so often before they are measured again; three halve a cell.
constexpr int kSplitsForLost = 3;
/// Of the cells that tear bodies those are split that are at least so large, in relation to the largest.
constexpr double kLargeCells = 0.7;
/// What has to be left of all tears at most, for it to be worth more cells. Fewer leaves than these are
/// always worth it; above, tears have to become fewer faster than leaves become more, which is judged once
/// there are so many more.
constexpr double kTornPart = 0.7;
constexpr std::size_t kHopeForBodies = 20'000;
constexpr double kJudgedGrowth = 1.5;
/// Splitting is taken back where it has brought nothing by the time that there are so many more leaves.
constexpr std::size_t kMostGrowth = 2;

double product(std::size_t a, std::size_t b) { return static_cast<double>(a) * static_cast<double>(b); }

}  // namespace

bool Resampler::ShownBodies::are_better_than(const ShownBodies& other) const {
  if (faults.lost_or_joined != other.faults.lost_or_joined)
    return faults.lost_or_joined < other.faults.lost_or_joined;
  if (static_cast<double>(faults.torn) > kTornPart * static_cast<double>(other.faults.torn)) return false;
  return leaves <= kHopeForBodies || product(faults.torn, leaves) <= product(other.faults.torn, other.leaves);
}

std::size_t Resampler::ShownBodies::most_leaves() const {
  return std::max(kHopeForBodies, kMostGrowth * leaves);
}

void Resampler::find_thin_places() {
  const double target = options_.interface_error;
  if (!thin_places_)
    thin_places_ = thin_places(*source_.network, source_.box, kMostTornThickness * target, kSpacing * target);
}

/// Bodies larger than the target that the mesh does not show as they are.
IdVector<BodyId, char> Resampler::wrong_bodies() const {
  IdVector<BodyId, char> wrong(source_.network->table().body_count(), 0);
  for (BodyId b(0); b.value < wrong.size(); ++b.value)
    wrong[b] = !bodies_->report().kept(b) && bodies_->size(b) > options_.interface_error ? 1 : 0;
  return wrong;
}

/// The thin places within some bodies.
Resampler::PlacesByLeaf Resampler::places_by_leaf(const IdVector<BodyId, char>& bodies) const {
  std::vector<std::uint32_t> within;
  for (std::uint32_t i = 0; i < thin_places_->size(); ++i) {
    if (bodies[(*thin_places_)[i].body] != 0) within.push_back(i);
  }
  PlacesByLeaf places(within.size());
  parallel_for(places.size(), 256, [&](std::size_t n) {
    places[n] = {leaf_at((*thin_places_)[within[n]].middle), within[n]};
  });
  std::sort(places.begin(), places.end());
  return places;
}

/// Calls back with each place, its leaf and who owns it; the owners in a leaf are worked out once for many
/// places.
void Resampler::look_at(
    const PlacesByLeaf& places,
    const std::function<void(std::uint32_t, TetrahedronId, BodyId, const CellOwnership&)>& look) const {
  parallel_chunks(places.size(), 256, [&](std::size_t begin, std::size_t end) {
    CellOwnership owners;
    OwnershipProblem fewer;
    for (std::size_t n = begin; n < end; ++n) {
      const auto& [leaf, place] = places[n];
      if (n == begin || leaf != places[n - 1].first) {
        ownership(leaf, owners);
        fewer = owners.problem;
        if (!owners.pure()) drop_dominated(fewer);
      }
      const std::uint32_t owner = fewer.candidates.size() == 1
                                      ? fewer.candidates[0].owner
                                      : fewer.owner(frame(leaf).weights((*thin_places_)[place].middle));
      look(place, leaf, BodyId(owner), owners);
    }
  });
}

/// Leaves that give places within bodies larger than the target, which the mesh does not show as they are, to
/// other bodies; the largest of them.
Resampler::TornLeaves Resampler::torn_leaves() const {
  struct Torn {
    TetrahedronId leaf;
    double diameter = 0;  ///< zero: not torn here, or the leaf is small enough
    bool given_away = false;
  };
  std::vector<Torn> torn(thin_places_->size());
  look_at(places_by_leaf(wrong_bodies()),
          [&](std::uint32_t i, TetrahedronId leaf, BodyId owner, const CellOwnership&) {
            const ThinPlace& place = (*thin_places_)[i];
            if (owner == place.body) return;
            const double diameter = frame(leaf).diameter();
            torn[i] = {leaf, diameter > kFinestForThickness * place.thickness ? diameter : 0, true};
          });
  TornLeaves result;
  double largest = 0;
  for (const Torn& t : torn) {
    largest = std::max(largest, t.diameter);
    if (t.given_away) ++result.places;
  }
  // Larger cells go first, since what they tear is often all that is torn.
  for (const Torn& t : torn) {
    if (t.diameter > 0 && t.diameter >= kLargeCells * largest) result.leaves.push_back(t.leaf);
  }
  return result;
}

/// Splits the leaves at places where bodies are lost, or touch others that they do not touch in the input;
/// returns whether there were any to split.
bool Resampler::refine_for_lost_bodies(const InterfaceMesh& shown) {
  struct Place {
    Vec3 position;
    double finest;
  };
  std::vector<Place> places;
  for (const std::uint32_t t : bodies_->contact_triangles())
    places.push_back({shown.centroid(t), kFinestForContacts * options_.interface_error});
  for (const ThinPlace& place : *thin_places_) {
    if (bodies_->report().mesh[place.body].pieces == 0 &&
        bodies_->size(place.body) > options_.interface_error)
      places.push_back({place.middle, kFinestForThickness * place.thickness});
  }
  bool any = false;
  for (int i = 0; i < kSplitsForLost; ++i) {
    std::vector<TetrahedronId> leaves;
    for (const Place& place : places) add_leaf_at(place.position, place.finest, leaves);
    std::vector<TetrahedronId> created = split_all(std::move(leaves));
    if (created.empty()) break;
    any = true;
    refine_to_targets(std::move(created));
  }
  return any;
}

/// Splits where the mesh loses, joins or tears bodies, until so many fewer places are given to others that
/// they should be measured again. Returns why there is nothing to split, or not worth it; none otherwise.
std::optional<RefinementEnd> Resampler::refine_for_bodies(const InterfaceMesh& shown, ShownBodies& best) {
  find_thin_places();
  if (refine_for_lost_bodies(shown)) return {};
  TornLeaves torn = torn_leaves();
  const double few = kTornPart * static_cast<double>(torn.places);
  if (!best.given_away) best.given_away = torn.places;
  std::optional<RefinementEnd> end = RefinementEnd::kSmallestCells;
  while (!torn.leaves.empty()) {
    std::vector<TetrahedronId> created = split_all(std::move(torn.leaves));
    if (created.empty()) return end ? (budget_spent_ ? RefinementEnd::kBudget : RefinementEnd::kDepth) : end;
    end = {};
    refine_to_targets(std::move(created));
    const std::size_t leaves = hierarchy_.leaf_count();
    if (budget_spent_ || leaves > best.most_leaves()) break;
    torn = torn_leaves();
    const bool hopeless = static_cast<double>(leaves) > kJudgedGrowth * static_cast<double>(best.leaves) &&
                          product(torn.places, leaves) > product(*best.given_away, best.leaves);
    if (hopeless && leaves > kHopeForBodies) return RefinementEnd::kSmallestCells;
    if (static_cast<double>(torn.places) <= few) break;
  }
  return end;
}

}  // namespace adamas::interfaces
