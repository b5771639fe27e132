#include "interfaces/resampling/resampler.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <numeric>
#include <queue>

#include "core/base/parallel.h"

namespace adamas {

namespace {

/// Rounds split all cells above a falling threshold while the mesh is below this part of the budget; from
/// there on one diamond at a time. Both end in the same mesh.
constexpr std::size_t kRoundsPart = 16;

/// Estimates are held to this part of the interface error that is wanted, so that the measured distance,
/// which looks at every point, seldom exceeds it.
constexpr double kEstimatePart = 0.95;

/// Views of cells, worked out by whichever thread needs one first and kept.
class ViewCache {
 public:
  explicit ViewCache(std::size_t cells) : views_(cells) {}
  ~ViewCache() {
    for (const auto& view : views_) delete view.load();
  }
  ViewCache(const ViewCache&) = delete;
  ViewCache& operator=(const ViewCache&) = delete;

  template <class Make>
  const CellView& get(TetrahedronId t, Make&& make) {
    std::atomic<const CellView*>& slot = views_[t.value];
    if (const CellView* found = slot.load(std::memory_order_acquire)) return *found;
    auto fresh = std::make_unique<const CellView>(make());
    const CellView* expected = nullptr;
    if (slot.compare_exchange_strong(expected, fresh.get())) return *fresh.release();
    return *expected;
  }

 private:
  std::vector<std::atomic<const CellView*>> views_;
};

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

CellSet Resampler::cells() const {
  auto list = std::make_shared<std::vector<TetrahedronId>>(leaves());
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

void Resampler::place_roots() {
  std::vector<VertexId> vertices;
  hierarchy_.for_each_vertex([&](VertexId v) { vertices.push_back(v); });
  evaluate_vertices(vertices);
  const auto& roots = hierarchy_.roots();
  if (source_.fields) {
    const auto& elements = source_.fields->native_elements();
    std::vector<std::uint32_t> root_of(elements.size());
    std::vector<Tetrahedron> frames;
    for (const TetrahedronId t : roots) frames.push_back(frame(t));
    const Domain& domain = hierarchy_.domain();
    const auto counts = domain.roots();
    parallel_for(elements.size(), 4096, [&](std::size_t e) {
      std::array<std::size_t, 3> cube{};
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double part = (elements[e].position[axis] - domain.box().min[axis]) / domain.box().size()[axis];
        cube[a] = static_cast<std::size_t>(std::clamp(part * counts[a], 0.0, counts[a] - 1.0));
      }
      const std::size_t first = 6 * (cube[0] + static_cast<std::size_t>(counts[0]) *
                                                   (cube[1] + static_cast<std::size_t>(counts[1]) * cube[2]));
      double best = -1e300;
      for (std::size_t r = first; r < first + 6; ++r) {
        const Weights w = frames[r].weights(elements[e].position);
        const double least = std::min({w[0], w[1], w[2], w[3]});
        if (least > best) best = least, root_of[e] = static_cast<std::uint32_t>(r);
      }
    });
    element_order_.resize(elements.size());
    std::iota(element_order_.begin(), element_order_.end(), 0u);
    std::stable_sort(element_order_.begin(), element_order_.end(),
                     [&](auto a, auto b) { return root_of[a] < root_of[b]; });
    for (std::uint32_t r = 0, e = 0; r < roots.size(); ++r) {
      CellRecord& cell = hierarchy_.payload(roots[r]);
      cell.first_element = e;
      while (e < element_order_.size() && root_of[element_order_[e]] == r) ++e;
      cell.last_element = e;
    }
  }
  parallel_for(roots.size(), 1, [&](std::size_t r) {
    const Tetrahedron cell = frame(roots[r]);
    Box3 box;
    for (const Vec3& corner : cell.corners) box.extend(corner);
    std::vector<std::uint32_t> near;
    source_.network->tree().overlapping(box, near);
    for (const std::uint32_t t : near) {
      const auto& corners = source_.network->triangle_corners(t);
      if (!ClippedTriangle(cell, corners[0], corners[1], corners[2]).empty())
        hierarchy_.payload(roots[r]).triangles.push_back(t);
    }
    evaluate_interface(roots[r]);
  });
}

void Resampler::evaluate_vertices(const std::vector<VertexId>& vertices) {
  parallel_for(vertices.size(), 64, [&](std::size_t i) {
    VertexRecord& record = hierarchy_.payload(vertices[i]);
    const Vec3 position = hierarchy_.position(vertices[i]);
    record.distances.radius = hierarchy_.domain().diameter(hierarchy_.lattice(vertices[i]));
    record.distances.body = source_.body_at(position, &record.distances.flagged);
    std::vector<NearInterface> near;
    source_.network->near_interfaces(position, record.distances.radius, record.distances.body, near,
                                     options_.distance);
    for (const NearInterface& n : near) {
      record.distances.near.push_back({n.interface, n.signed_distance});
      record.closest.push_back(n.closest);
    }
  });
}

void Resampler::evaluate_interface(TetrahedronId t) {
  CellRecord& cell = hierarchy_.payload(t);
  CellOwnership owners;
  ownership(t, owners);
  cell.interface = estimate_interface_error(*source_.network, frame(t), owners, cell.triangles,
                                            estimate_target(), cell.trusted);
  cell.evaluated = true;
}

void Resampler::distribute(TetrahedronId parent) {
  CellRecord& from = hierarchy_.payload(parent);
  const Tetrahedron whole = frame(parent);
  const auto children = hierarchy_.children(parent);
  const auto begin = element_order_.begin();
  std::uint32_t middle = from.first_element;
  if (source_.fields) {
    const auto& elements = source_.fields->native_elements();
    const auto at =
        std::stable_partition(begin + from.first_element, begin + from.last_element, [&](std::uint32_t e) {
          const Weights w = whole.weights(elements[e].position);
          return w[0] >= w[1];
        });
    middle = static_cast<std::uint32_t>(at - begin);
  }
  for (std::size_t side = 0; side < 2; ++side) {
    CellRecord& to = hierarchy_.payload(children[side]);
    to.first_element = side == 0 ? from.first_element : middle;
    to.last_element = side == 0 ? middle : from.last_element;
    to.trusted = from.trusted;
    const Tetrahedron part = frame(children[side]);
    for (const std::uint32_t t : from.triangles) {
      const auto& corners = source_.network->triangle_corners(t);
      if (!ClippedTriangle(part, corners[0], corners[1], corners[2]).empty()) to.triangles.push_back(t);
    }
    if (hierarchy_.is_leaf(children[side])) {
      evaluate_interface(children[side]);
    } else {
      distribute(children[side]);
    }
  }
  from.triangles = {};
  from.evaluated = false;
}

std::vector<TetrahedronId> Resampler::process(const std::vector<Split>& splits) {
  std::vector<VertexId> vertices;
  std::vector<TetrahedronId> parents, created;
  for (const Split& split : splits) {
    if (!hierarchy_.payload(split.vertex).distances.body.valid()) vertices.push_back(split.vertex);
    if (hierarchy_.payload(split.parent).evaluated) parents.push_back(split.parent);
    for (const TetrahedronId child : split.children) {
      if (hierarchy_.is_leaf(child)) created.push_back(child);
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  evaluate_vertices(vertices);
  parallel_for(parents.size(), 16, [&](std::size_t i) { distribute(parents[i]); });
  if (fields_active_) measure_fields(created);
  return created;
}

void Resampler::compute_rows(std::vector<std::pair<VertexId, BodyId>> needs) {
  std::sort(needs.begin(), needs.end());
  needs.erase(std::unique(needs.begin(), needs.end()), needs.end());
  std::erase_if(needs, [&](const auto& need) {
    const auto& rows = hierarchy_.payload(need.first).rows;
    return std::any_of(rows.begin(), rows.end(), [&](const auto& row) { return row.body == need.second; });
  });
  std::vector<std::vector<double>> computed(needs.size());
  parallel_for(needs.size(), 32, [&](std::size_t i) {
    computed[i] = fields_at_vertex(source_, options_.ghost, hierarchy_.position(needs[i].first),
                                   hierarchy_.payload(needs[i].first), needs[i].second);
  });
  for (std::size_t i = 0; i < needs.size(); ++i) {
    auto& rows = hierarchy_.payload(needs[i].first).rows;
    const auto at = std::lower_bound(rows.begin(), rows.end(), needs[i].second,
                                     [](const VertexRecord::BodyRow& r, BodyId b) { return r.body < b; });
    rows.insert(at, {needs[i].second, std::move(computed[i])});
  }
}

void Resampler::measure_fields(const std::vector<TetrahedronId>& cells) {
  constexpr std::size_t kChunk = 512;
  std::vector<std::vector<std::pair<VertexId, BodyId>>> needs((cells.size() + kChunk - 1) / kChunk);
  parallel_chunks(cells.size(), kChunk, [&](std::size_t first, std::size_t last) {
    CellOwnership owners;
    for (std::size_t i = first; i < last; ++i) {
      ownership(cells[i], owners);
      if (!owners.pure()) keep_owners(owners.problem);
      for (const VertexId v : hierarchy_.vertices(cells[i])) {
        for (const auto& candidate : owners.problem.candidates)
          needs[first / kChunk].emplace_back(v, BodyId(candidate.owner));
      }
    }
  });
  std::vector<std::pair<VertexId, BodyId>> all;
  for (const auto& part : needs) all.insert(all.end(), part.begin(), part.end());
  compute_rows(std::move(all));
  const std::size_t fields = source_.fields->fields().size();
  std::vector<std::vector<std::uint32_t>> displaced(cells.size());
  parallel_for(cells.size(), 64, [&](std::size_t i) {
    CellRecord& cell = hierarchy_.payload(cells[i]);
    cell.fields.assign(fields, {});
    const std::uint32_t count = cell.last_element - cell.first_element;
    if (count == 0) return;
    const auto elements = std::span(element_order_).subspan(cell.first_element, count);
    displaced[i] = measure_field_errors(source_, view(cells[i]), elements, cell.fields);
  });
  // Of displaced elements no more is asked than the target, or what the others have anyway.
  std::vector<double> limits(fields, 0.0);
  for (std::size_t f = 0; f < fields; ++f) {
    for (const TetrahedronId t : cells) limits[f] = std::max(limits[f], hierarchy_.payload(t).fields[f].max);
    if (options_.field_errors[f]) limits[f] = *options_.field_errors[f];
  }
  const double warp =
      distance_ ? std::max(options_.interface_error, distance_->upper) : options_.interface_error;
  ViewCache cache(hierarchy_.tetrahedron_slots());
  const CellsInBox nearby = [&](const Box3& box, MaterialId material, const auto& visit) {
    cells_in_box(box, material,
                 [&](TetrahedronId t) { visit(cache.get(t, [&] { return view_with_parts(t); })); });
  };
  parallel_for(cells.size(), 16, [&](std::size_t i) {
    if (displaced[i].empty()) return;
    measure_displaced_errors(source_, view(cells[i]), displaced[i], warp, nearby, limits,
                             hierarchy_.payload(cells[i]).fields);
  });
}

CellView Resampler::view(TetrahedronId t) const {
  const auto v = hierarchy_.vertices(t);
  CellView result{frame(t),
                  {},
                  {&hierarchy_.payload(v[0]), &hierarchy_.payload(v[1]), &hierarchy_.payload(v[2]),
                   &hierarchy_.payload(v[3])},
                  {}};
  ownership(t, result.owners);
  if (!result.owners.pure()) keep_owners(result.owners.problem);
  return result;
}

CellView Resampler::view_with_parts(TetrahedronId t) const {
  CellView result = view(t);
  if (result.owners.pure()) {
    const std::array<Weights, 4> whole{Weights{1, 0, 0, 0}, Weights{0, 1, 0, 0}, Weights{0, 0, 1, 0},
                                       Weights{0, 0, 0, 1}};
    result.parts.push_back({result.owners.problem.candidates[0].owner, whole});
  } else {
    partition_tetrahedron(result.owners.problem, result.parts);
  }
  return result;
}

bool Resampler::may_hold(TetrahedronId t, MaterialId material) const {
  const InterfaceTable& table = source_.network->table();
  for (const VertexId v : hierarchy_.vertices(t)) {
    const VertexDistances& known = hierarchy_.payload(v).distances;
    if (table.material(known.body) == material) return true;
    for (const NearDistance& near : known.near) {
      for (const BodyId side : table.sides(near.interface)) {
        if (table.material(side) == material) return true;
      }
    }
  }
  return false;
}

void Resampler::cells_in_box(const Box3& box, MaterialId material,
                             const std::function<void(TetrahedronId)>& visit) const {
  std::vector<TetrahedronId> stack(hierarchy_.roots().rbegin(), hierarchy_.roots().rend());
  while (!stack.empty()) {
    const TetrahedronId t = stack.back();
    stack.pop_back();
    Box3 bounds;
    for (const VertexId v : hierarchy_.vertices(t)) bounds.extend(hierarchy_.position(v));
    bool apart = false;
    for (int axis = 0; axis < 3; ++axis) {
      apart = apart || bounds.min[axis] > box.max[axis] || bounds.max[axis] < box.min[axis];
    }
    if (apart) continue;
    if (hierarchy_.is_leaf(t)) {
      if (may_hold(t, material)) visit(t);
    } else {
      for (const TetrahedronId child : hierarchy_.children(t)) stack.push_back(child);
    }
  }
}

void Resampler::complete_fields() {
  if (!source_.fields) return;
  if (!fields_active_) {
    fields_active_ = true;
    measure_fields(leaves());
  }
}

Resampler::Priority Resampler::priority(TetrahedronId t) const {
  const CellRecord& cell = hierarchy_.payload(t);
  if (cell.interface.distance > estimate_target()) {
    return {cell.interface.lost ? 2 : 1, cell.interface.distance / estimate_target()};
  }
  Priority result;
  for (std::size_t f = 0; f < cell.fields.size(); ++f) {
    if (!options_.field_errors[f] || !(cell.fields[f].max > *options_.field_errors[f])) continue;
    result = std::max(result, Priority{0, cell.fields[f].max / *options_.field_errors[f]});
  }
  return result;
}

bool Resampler::wants_split(TetrahedronId t) const {
  return hierarchy_.is_leaf(t) && hierarchy_.can_split(t) && priority(t).rank >= 0;
}

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

void Resampler::undo(const std::vector<Split>& splits) {
  std::vector<TetrahedronId> restored;
  for (auto split = splits.rbegin(); split != splits.rend(); ++split) {
    const DiamondId diamond = hierarchy_.diamond(split->parent);
    if (hierarchy_.is_split(diamond)) hierarchy_.merge(diamond, restored);
  }
}

void Resampler::refine_greedily(const std::vector<TetrahedronId>& cells) {
  using Entry = std::pair<Priority, std::uint32_t>;
  // Of equal priorities the smaller id first.
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
  place_roots();
  refine_to_targets(leaves());
  if (options_.certify) certify();
  if (!source_.fields) return;
  fields_active_ = true;
  report("measuring fields");
  measure_fields(leaves());
  const std::size_t before = hierarchy_.leaf_count();
  refine_to_targets(leaves());
  if (hierarchy_.leaf_count() == before) return;
  if (options_.certify) certify();
  // Errors of elements near an interface depend on the cells round theirs.
  measure_fields(leaves());
}

TetrahedronId Resampler::leaf_at(const Vec3& p) const {
  TetrahedronId best = hierarchy_.roots().front();
  double greatest = -1e300;
  for (const TetrahedronId root : hierarchy_.roots()) {
    const Weights w = frame(root).weights(p);
    const double least = std::min({w[0], w[1], w[2], w[3]});
    if (least > greatest) greatest = least, best = root;
  }
  while (!hierarchy_.is_leaf(best)) {
    const Weights w = frame(best).weights(p);
    best = hierarchy_.children(best)[w[0] >= w[1] ? 0 : 1];
  }
  return best;
}

}  // namespace adamas
