#include "interfaces/resampling/resampler.h"

#include <algorithm>
#include <memory>
#include <queue>

#include "core/base/loop_progress.h"

namespace adamas::interfaces {

namespace {

/// Rounds split all cells above a falling threshold while the mesh is below this part of the budget; from
/// there on one diamond at a time. Both end in the same mesh.
constexpr std::size_t kRoundsPart = 16;

/// Estimates are held to this part of the interface error that is wanted, so that the measured distance,
/// which looks at every point, seldom exceeds it.
constexpr double kEstimatePart = 0.95;

}  // namespace

Resampler::Resampler(const ResamplingSource& source, ResamplingOptions options, Progress& progress)
    : source_(source),
      options_(std::move(options)),
      progress_(progress),
      hierarchy_(Domain::fit(source.box)) {
  if (!(options_.interface_error > 0)) {
    fail("{}: expected a positive interface error, found {}", source.name, options_.interface_error);
  }
  if (options_.max_tetrahedra && *options_.max_tetrahedra < hierarchy_.leaf_count()) {
    fail("{}: expected room for at least {} tetrahedra, found a limit of {}", source.name,
         hierarchy_.leaf_count(), *options_.max_tetrahedra);
  }
  if (options_.volume_error && !(*options_.volume_error > 0))
    fail("{}: expected a positive error of volumes, found {}", source.name, *options_.volume_error);
  if (source.body_volumes.empty()) {
    options_.conserve = false;
    options_.volume_error.reset();
  }
  conserves_ = options_.conserve && !options_.volume_error;
  shifts_.assign(source.network->table().interface_count(), 0.0);
  most_shifts_.assign(shifts_.size(), options_.interface_error);
  options_.field_errors.resize(source.fields ? source.fields->fields().size() : 0);
}

double Resampler::estimate_target() const { return kEstimatePart * options_.interface_error; }

Tetrahedron Resampler::frame(TetrahedronId t) const {
  const auto v = hierarchy_.vertices(t);
  return Tetrahedron({hierarchy_.position(v[0]), hierarchy_.position(v[1]), hierarchy_.position(v[2]),
                      hierarchy_.position(v[3])});
}

void Resampler::ownership(TetrahedronId t, CellOwnership& result) const {
  const auto v = hierarchy_.vertices(t);
  find_cell_ownership(source_.network->table(),
                      {&hierarchy_.payload(v[0]).distances, &hierarchy_.payload(v[1]).distances,
                       &hierarchy_.payload(v[2]).distances, &hierarchy_.payload(v[3]).distances},
                      result);
}

void Resampler::report(std::string_view stage) {
  progress_.step(fmt::format("{}: {} tetrahedra", stage, hierarchy_.leaf_count()), -1);
}

std::vector<TetrahedronId> Resampler::leaves() const {
  std::vector<TetrahedronId> result;
  result.reserve(hierarchy_.leaf_count());
  hierarchy_.for_each_leaf([&](TetrahedronId t) { result.push_back(t); });
  return result;
}

CellSet Resampler::cells() const { return cells_of(leaves()); }

/// These tetrahedra of the tree.
CellSet Resampler::cells_of(std::vector<TetrahedronId> tetrahedra) const {
  const auto list = std::make_shared<const std::vector<TetrahedronId>>(std::move(tetrahedra));
  CellSet set;
  set.count = list->size();
  set.corners = [this, list](std::size_t i) {
    const auto v = hierarchy_.vertices((*list)[i]);
    return std::array<std::uint32_t, 4>{v[0].value, v[1].value, v[2].value, v[3].value};
  };
  set.position = [this](std::uint32_t v) { return hierarchy_.position(VertexId(v)); };
  set.distances = [this](std::uint32_t v) -> const VertexDistances& {
    return hierarchy_.payload(VertexId(v)).distances;
  };
  return set;
}

Resampler::Priority Resampler::priority(TetrahedronId t) const {
  const CellRecord& cell = hierarchy_.payload(t);
  // Near a corner of a small cell there need be no vertex of the input's triangles: what distances to
  // vertices lose there, they would lose in smaller cells too.
  const bool too_small =
      options_.distance == DistanceMode::kNearestVertex && frame(t).diameter() <= options_.interface_error;
  if (cell.interface.distance > estimate_target() && !too_small) {
    return {cell.interface.lost ? 2 : 1, cell.interface.distance / estimate_target()};
  }
  Priority result;
  for (std::size_t f = 0; f < cell.fields.size(); ++f) {
    if (!options_.field_errors[f] || !(cell.fields[f].reducible > *options_.field_errors[f])) continue;
    result = std::max(result, Priority{0, cell.fields[f].reducible / *options_.field_errors[f]});
  }
  return result;
}

/// Whether a tetrahedron would be split if it were a leaf.
bool Resampler::demands_split(TetrahedronId t) const {
  return hierarchy_.can_split(t) && priority(t).rank >= 0;
}

bool Resampler::wants_split(TetrahedronId t) const { return hierarchy_.is_leaf(t) && demands_split(t); }

std::vector<TetrahedronId> Resampler::refine_in_rounds(std::vector<TetrahedronId> cells) {
  while (true) {
    std::erase_if(cells, [&](TetrahedronId t) { return !wants_split(t); });
    if (cells.empty()) return cells;
    report(fields_active_ ? "refining fields" : "refining interfaces");
    std::vector<TetrahedronId> now = cells;
    if (options_.max_tetrahedra) {
      if (hierarchy_.leaf_count() > *options_.max_tetrahedra / kRoundsPart) return cells;
      Priority threshold;
      for (const TetrahedronId t : cells) threshold = std::max(threshold, priority(t));
      threshold.ratio = std::max(1.0, 0.5 * threshold.ratio);
      std::erase_if(now, [&](TetrahedronId t) { return priority(t) < threshold; });
    }
    std::vector<Split> splits;
    for (const TetrahedronId t : now) {
      if (hierarchy_.is_leaf(t)) hierarchy_.split(t, splits);
    }
    const auto created = process(splits);
    if (!options_.max_tetrahedra) cells.clear();
    cells.insert(cells.end(), created.begin(), created.end());
  }
}

void Resampler::refine_greedily(const std::vector<TetrahedronId>& cells) {
  using Entry = std::pair<Priority, std::uint32_t>;
  // Of equal priorities that with the smaller id comes first.
  const auto later = [](const Entry& a, const Entry& b) {
    return a.first != b.first ? a.first < b.first : a.second > b.second;
  };
  std::priority_queue<Entry, std::vector<Entry>, decltype(later)> queue(later);
  const auto add = [&](const std::vector<TetrahedronId>& list) {
    for (const TetrahedronId t : list) {
      if (wants_split(t)) queue.emplace(priority(t), t.value);
    }
  };
  add(cells);
  for (std::size_t step = 0; !queue.empty(); ++step) {
    const TetrahedronId t(queue.top().second);
    queue.pop();
    if (!wants_split(t)) continue;
    if (step % 256 == 0) report(fields_active_ ? "refining fields" : "refining interfaces");
    std::vector<Split> splits;
    hierarchy_.split(t, splits);
    if (hierarchy_.leaf_count() > *options_.max_tetrahedra) {
      undo(splits);
      budget_spent_ = true;
      return;
    }
    add(process(splits));
  }
}

void Resampler::refine_to_targets(std::vector<TetrahedronId> cells) {
  if (budget_spent_) return;
  cells = refine_in_rounds(std::move(cells));
  if (options_.max_tetrahedra && !cells.empty()) refine_greedily(cells);
}

void Resampler::refine() {
  const LoopProgress loops(progress_);
  place_roots();
  refine_to_targets(leaves());
  refine_further();
}

void Resampler::refine(MeshHierarchy from) {
  const Domain &own = hierarchy_.domain(), &other = from.domain();
  if (other.roots() != own.roots() || other.box().min != own.box().min || other.box().max != own.box().max)
    fail("{}: expected the domain of the mesh that is adapted, found another one", source_.name);
  if (options_.max_tetrahedra) return refine();
  const LoopProgress loops(progress_);
  hierarchy_ = std::move(from);
  hierarchy_.reset_payloads();
  place_roots();
  adapt();
  refine_further();
}

/// What follows when no estimate of the interfaces is greater than wanted.
void Resampler::refine_further() {
  finish_interfaces();
  if (source_.fields) refine_fields();
  comparison_.reset();
  thin_places_.reset();
}

void Resampler::refine_fields() {
  fields_active_ = true;
  report("measuring fields");
  const auto wanted = [](const std::optional<double>& target) { return target.has_value(); };
  if (std::any_of(options_.field_errors.begin(), options_.field_errors.end(), wanted)) {
    measure_fields(leaves(), DisplacedErrors::kWithinTargets);
    const std::size_t before = hierarchy_.leaf_count();
    refine_to_targets(leaves());
    if (hierarchy_.leaf_count() != before) finish_interfaces();
  }
  // Errors of elements near an interface depend on the cells round theirs.
  measure_fields(leaves(), DisplacedErrors::kLeast);
}

Resampler::SplitPlane Resampler::split_plane(TetrahedronId t) const {
  const auto v = hierarchy_.vertices(t);
  const Vec3 first = hierarchy_.position(v[0]), origin = hierarchy_.position(v[2]);
  const Vec3 middle = 0.5 * (first + hierarchy_.position(v[1]));
  Vec3 normal = cross(hierarchy_.position(v[3]) - origin, middle - origin);
  if (dot(normal, first - origin) < 0) normal = -1 * normal;
  return {normal, origin};
}

TetrahedronId Resampler::leaf_at(const Vec3& p) const {
  TetrahedronId t = root_at(p);
  while (!hierarchy_.is_leaf(t)) t = hierarchy_.children(t)[split_plane(t).side(p)];
  return t;
}

BodyId Resampler::owner_at(const Vec3& p) const {
  const TetrahedronId leaf = leaf_at(p);
  CellOwnership owners;
  ownership(leaf, owners);
  if (owners.pure()) return BodyId(owners.problem.candidates[0].owner);
  return BodyId(owners.problem.owner(frame(leaf).weights(p)));
}

}  // namespace adamas::interfaces
