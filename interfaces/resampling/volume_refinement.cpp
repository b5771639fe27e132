// Cells are split until each body has its volume, but for a part of it that is allowed.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"
#include "interfaces/errors/volume_share.h"
#include "interfaces/network/network_measures.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

namespace {

/// Bodies are held to this part of the difference that is allowed, so that what follows does not push them
/// over it by round-off.
constexpr double kAimedPart = 0.99;
/// Cells that a body gets no more from, all of them together, than this part of what is allowed are not split
/// for it.
constexpr double kLeastPart = 0.125;
/// Of a body's cells those go first that it gets at least so much from, in relation to the one that it gets
/// most from.
constexpr double kLargePart = 0.5;
/// A body whose shape the cells show is given up where its volume is no better than by this part once there
/// are so many times more cells at its boundary.
constexpr double kBetterPart = 0.7;
constexpr double kMostGrowth = 16;
/// Cells show a body's shape where they are smaller than this part of its thickness: the diameter of a ball
/// of its volume and area, were it one.
constexpr double kShownThickness = 0.125;
/// Where interfaces are moved for the sake of volumes cells are split first until bodies have theirs but for
/// this part: what is lost or almost so cannot be had by moving, and would move all else too far. Where
/// moving does not do the rest, splitting leaves less to it, each time so many times less.
constexpr double kFirstSlack = 0.5, kLessSlack = 0.25;

}  // namespace

struct Resampler::WantingBody {
  struct Cell {
    TetrahedronId leaf;
    double gained = 0;  ///< what it gives the body more than the input does, an estimate
    double bound = 0;   ///< what it might
  };
  BodyId body;
  std::vector<Cell> cells;
  double best = std::numeric_limits<double>::infinity();  ///< least difference yet
  double cells_at_best = 0;
};

/// Works out what volumes to aim at.
void Resampler::find_volume_goals() {
  if (!volume_goals_.empty()) return;
  const InterfaceNetwork& network = *source_.network;
  const InterfaceTable& table = network.table();
  const NetworkMeasures measures = measure_network(network, source_.box, source_.materials.size());
  IdVector<BodyId, double> areas(table.body_count(), 0.0);
  for (InterfaceId i(0); i.value < table.interface_count(); ++i.value) {
    for (const BodyId b : table.sides(i)) areas[b] += measures.areas[i];
  }
  volume_goals_.resize(table.body_count());
  if (options_.conserve) volume_slack_ = kFirstSlack;
  for (BodyId b(0); b.value < volume_goals_.size(); ++b.value) {
    const double wanted = source_.body_volumes[b], enclosed = measures.body_volumes[b];
    // A body without a volume has no part of it either.
    if (!(wanted > 0 && enclosed > 0)) continue;
    const double allowed = *options_.volume_error * wanted;
    const bool reachable = options_.conserve || std::abs(enclosed - wanted) <= allowed;
    const double thickness = 6 * wanted / areas[b];
    volume_goals_[b] = {reachable ? wanted : enclosed, kAimedPart * allowed,
                        areas[b] / std::pow(kShownThickness * thickness, 2)};
  }
}

/// By how much a body's volume may differ from its goal for now.
double Resampler::allowed(BodyId body) const {
  const VolumeGoal& goal = volume_goals_[body];
  return std::max(goal.tolerance, volume_slack_ * goal.volume);
}

bool Resampler::is_off(BodyId body, double volume) const {
  return std::abs(volume - volume_goals_[body].volume) > allowed(body);
}

/// The number of bodies whose volumes are not as wanted; 0 where nothing is.
std::size_t Resampler::bodies_off() const {
  if (volume_goals_.empty()) return 0;
  const IdVector<BodyId, double> volumes = body_volumes(source_.network->table(), cells());
  std::size_t count = 0;
  for (BodyId b(0); b.value < volumes.size(); ++b.value) {
    if (is_off(b, volumes[b])) ++count;
  }
  return count;
}

/// Keeps the watched volumes up to date where leaves have been split.
void Resampler::watch_split(const std::vector<TetrahedronId>& parents,
                            const std::vector<TetrahedronId>& created) {
  const InterfaceTable& table = source_.network->table();
  for (const auto& [body, volume] : owned_volumes(table, cells_of(parents))) watch_->volumes[body] -= volume;
  for (const auto& [body, volume] : owned_volumes(table, cells_of(created))) watch_->volumes[body] += volume;
  watch_->created.insert(watch_->created.end(), created.begin(), created.end());
}

/// Lists those of the cells that are leaves with the bodies whose volumes they have to do with.
void Resampler::add_cells(const std::vector<TetrahedronId>& cells, std::vector<WantingBody>& wanting) const {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  IdVector<BodyId, std::size_t> places(source_.network->table().body_count(), kNone);
  for (std::size_t i = 0; i < wanting.size(); ++i) places[wanting[i].body] = i;
  const auto is_wanting = [&](BodyId b) { return places[b] != kNone; };
  std::vector<std::vector<VolumeShare>> shares(cells.size());
  parallel_chunks(cells.size(), 64, [&](std::size_t first, std::size_t last) {
    CellOwnership owners;
    for (std::size_t i = first; i < last; ++i) {
      if (!hierarchy_.is_leaf(cells[i])) continue;
      const bool known = std::ranges::any_of(hierarchy_.vertices(cells[i]), [&](VertexId v) {
        return std::ranges::any_of(hierarchy_.payload(v).distances.bodies, is_wanting);
      });
      if (!known) continue;
      ownership(cells[i], owners);
      shares[i] = estimate_volume_shares(*source_.network, frame(cells[i]), owners,
                                         hierarchy_.payload(cells[i]).triangles);
      std::erase_if(shares[i], [&](const VolumeShare& share) { return !is_wanting(share.body); });
    }
  });
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (const VolumeShare& share : shares[i]) {
      const double far =
          std::min(hierarchy_.payload(cells[i]).interface.distance, frame(cells[i]).diameter());
      wanting[places[share.body]].cells.push_back({cells[i], share.gained, share.area * far});
    }
  }
}

/// Chooses leaves to split for a body of this volume, each with how much it matters: those that it gets most
/// of its difference from, and no more than explain all of it.
void Resampler::choose_cells(WantingBody& wanting, double volume,
                             std::vector<std::pair<double, TetrahedronId>>& chosen) {
  std::erase_if(wanting.cells, [&](const auto& cell) { return !hierarchy_.is_leaf(cell.leaf); });
  const VolumeGoal& goal = volume_goals_[wanting.body];
  const double tolerance = allowed(wanting.body);
  const double difference = std::abs(volume - goal.volume);
  const auto count = static_cast<double>(wanting.cells.size());
  if (difference < kBetterPart * wanting.best) {
    wanting.best = difference;
    wanting.cells_at_best = count;
  }
  RefinementEnd& end = volume_ends_[wanting.body];
  end = RefinementEnd::kSmallestCells;
  if (count > kMostGrowth * std::max(wanting.cells_at_best, goal.cells)) return;
  const double sign = volume > goal.volume ? 1 : -1;
  const double explained = std::accumulate(
      wanting.cells.begin(), wanting.cells.end(), 0.0,
      [sign](double sum, const auto& cell) { return sum + std::max(0.0, sign * cell.gained); });
  const bool is_explained = explained >= difference - tolerance;
  std::vector<std::pair<double, TetrahedronId>> cells;
  for (const WantingBody::Cell& cell : wanting.cells) {
    const double gained = is_explained ? sign * cell.gained : std::max(sign * cell.gained, cell.bound);
    if (!(gained * count > kLeastPart * tolerance)) continue;
    const bool small = options_.distance == DistanceMode::kNearestVertex &&
                       frame(cell.leaf).diameter() <= options_.interface_error;
    if (!hierarchy_.can_split(cell.leaf)) end = RefinementEnd::kDepth;
    if (hierarchy_.can_split(cell.leaf) && !small) cells.emplace_back(gained, cell.leaf);
  }
  if (cells.empty()) return;
  end = RefinementEnd::kReached;
  std::ranges::sort(cells, [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  double sum = 0;
  for (const auto& [gained, leaf] : cells) {
    if (gained < kLargePart * cells.front().first || sum > difference) break;
    chosen.emplace_back(gained / tolerance, leaf);
    sum += gained;
  }
}

/// Splits until these bodies have their volumes, or no splitting helps; returns whether anything was split.
bool Resampler::split_for_volumes(std::vector<WantingBody>& wanting, VolumeWatch& watch) {
  for (bool any = false;; any = true) {
    report("refining volumes");
    std::vector<std::pair<double, TetrahedronId>> chosen;
    for (WantingBody& each : wanting) {
      if (is_off(each.body, watch.volumes[each.body])) choose_cells(each, watch.volumes[each.body], chosen);
    }
    std::ranges::stable_sort(chosen, [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<TetrahedronId> cells;
    cells.reserve(chosen.size());
    for (const auto& [matter, leaf] : chosen) cells.push_back(leaf);
    watch.created.clear();
    std::vector<TetrahedronId> created = split_in_order(cells, false);
    if (created.empty()) return any;
    refine_to_targets(std::move(created));
    if (budget_spent_) return true;
    add_cells(watch.created, wanting);
  }
}

/// Splits cells at the boundaries of bodies whose volumes are off, until they are as wanted or no splitting
/// helps; returns whether anything was split, or interfaces shall be moved from now on.
bool Resampler::refine_for_volumes() {
  if (!options_.volume_error) return false;
  if (split_for_all_volumes()) return true;
  return !std::exchange(conserves_, options_.conserve) && conserves_;
}

bool Resampler::split_for_all_volumes() {
  find_volume_goals();
  volume_ends_.assign(volume_goals_.size(), RefinementEnd::kReached);
  for (bool any = false;;) {
    // Splitting for some bodies may take others away from theirs.
    VolumeWatch watch{body_volumes(source_.network->table(), cells()), {}};
    std::vector<WantingBody> wanting;
    for (BodyId b(0); b.value < watch.volumes.size(); ++b.value) {
      if (is_off(b, watch.volumes[b])) wanting.push_back({.body = b, .cells = {}});
    }
    if (budget_spent_) return any;
    if (wanting.empty()) {
      if (any || conserves_ != options_.conserve || volume_slack_ == 0) return any;
      // Moving interfaces has not made up for it.
      volume_slack_ *= kLessSlack;
      if (volume_slack_ < *options_.volume_error) volume_slack_ = 0;
      continue;
    }
    add_cells(leaves(), wanting);
    watch_ = &watch;
    const bool split = split_for_volumes(wanting, watch);
    watch_ = nullptr;
    if (!split) return any;
    any = true;
  }
}

}  // namespace adamas::interfaces
