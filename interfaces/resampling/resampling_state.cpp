#include "interfaces/resampling/resampling_state.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/sort_unique.h"

namespace adamas::interfaces {

ResamplingState::ResamplingState(const ResamplingSource& from, ResamplingOptions wanted, Progress& reports)
    : source(from), options(std::move(wanted)), progress(reports), hierarchy(Domain::fit(from.box)) {
  if (!(options.interface_error > 0)) {
    fail("{}: expected a positive interface error, found {}", source.name, options.interface_error);
  }
  if (options.max_tetrahedra && *options.max_tetrahedra < hierarchy.leaf_count()) {
    fail("{}: expected room for at least {} tetrahedra, found a limit of {}", source.name,
         hierarchy.leaf_count(), *options.max_tetrahedra);
  }
  if (options.volume_error && !(*options.volume_error > 0))
    fail("{}: expected a positive error of volumes, found {}", source.name, *options.volume_error);
  if (source.body_volumes.empty()) {
    options.conserve = false;
    options.volume_error.reset();
  }
  shifts.assign(source.network->table().interface_count(), 0.0);
  options.field_errors.resize(source.fields ? source.fields->fields().size() : 0);
  displacement = options.interface_error;
}

double ResamplingState::volume(TetrahedronId t) const {
  const auto v = hierarchy.vertices(t);
  return signed_volume(hierarchy.position(v[0]), hierarchy.position(v[1]), hierarchy.position(v[2]),
                       hierarchy.position(v[3]));
}

Tetrahedron ResamplingState::frame(TetrahedronId t) const {
  const auto v = hierarchy.vertices(t);
  return Tetrahedron({hierarchy.position(v[0]), hierarchy.position(v[1]), hierarchy.position(v[2]),
                      hierarchy.position(v[3])});
}

Box3 ResamplingState::box(TetrahedronId t) const {
  Box3 result;
  for (const VertexId v : hierarchy.vertices(t)) result.extend(hierarchy.position(v));
  return result;
}

void ResamplingState::ownership(TetrahedronId t, CellOwnership& result, const OwnershipNeeds& needs) const {
  const auto v = hierarchy.vertices(t);
  find_cell_ownership(source.network->table(),
                      {&hierarchy.payload(v[0]).distances, &hierarchy.payload(v[1]).distances,
                       &hierarchy.payload(v[2]).distances, &hierarchy.payload(v[3]).distances},
                      result, needs);
}

std::vector<TetrahedronId> ResamplingState::leaves() const {
  std::vector<TetrahedronId> result;
  result.reserve(hierarchy.leaf_count());
  hierarchy.for_each_leaf([&](TetrahedronId t) { result.push_back(t); });
  return result;
}

CellSet ResamplingState::cells(std::vector<TetrahedronId> tetrahedra) const {
  const auto list = std::make_shared<const std::vector<TetrahedronId>>(std::move(tetrahedra));
  CellSet set;
  set.count = list->size();
  set.corners = [this, list](std::size_t i) {
    const auto v = hierarchy.vertices((*list)[i]);
    return std::array<std::uint32_t, 4>{v[0].value, v[1].value, v[2].value, v[3].value};
  };
  set.position = [this](std::uint32_t v) { return hierarchy.position(VertexId(v)); };
  set.distances = [this](std::uint32_t v) -> const VertexDistances& {
    return hierarchy.payload(VertexId(v)).distances;
  };
  return set;
}

void ResamplingState::add_contacts(TetrahedronId t, ContactBuffer& buffer) const {
  const CellContacts& contacts = hierarchy.payload(t).contacts;
  if (contacts.empty()) return;
  const auto v = hierarchy.vertices(t);
  contacts.add_to(buffer, {v[0].value, v[1].value, v[2].value, v[3].value}, frame(t).corners);
}

ResamplingState::ShownByLeaves ResamplingState::forget_contacts(const std::vector<VertexId>& vertices) {
  std::vector<char> changed(hierarchy.vertex_slots(), 0);
  for (const VertexId v : vertices) changed[v.value] = 1;
  ShownByLeaves shown;
  hierarchy.for_each_leaf([&](TetrahedronId t) {
    const auto corners = hierarchy.vertices(t);
    if (std::ranges::none_of(corners, [&](VertexId v) { return changed[v.value] != 0; })) return;
    CellRecord& cell = hierarchy.payload(t);
    if (cell.has_contacts) shown.emplace_back(t, std::move(cell.contacts));
    cell.forget_contacts();
  });
  return shown;
}

void ResamplingState::restore_contacts(ShownByLeaves shown) {
  for (auto& [t, contacts] : shown) {
    hierarchy.payload(t).contacts = std::move(contacts);
    hierarchy.payload(t).has_contacts = true;
  }
}

IdVector<BodyId, double> ResamplingState::volumes() const {
  return body_volumes(source.network->table(), cells(leaves()));
}

std::vector<VertexId> ResamplingState::corners(const std::vector<TetrahedronId>& tetrahedra) const {
  std::vector<VertexId> result;
  for (const TetrahedronId t : tetrahedra) {
    for (const VertexId v : hierarchy.vertices(t)) result.push_back(v);
  }
  sort_unique(result);
  return result;
}

SplitPlane ResamplingState::split_plane(TetrahedronId t) const {
  const auto v = hierarchy.vertices(t);
  const Vec3 first = hierarchy.position(v[0]), origin = hierarchy.position(v[2]);
  const Vec3 middle = 0.5 * (first + hierarchy.position(v[1]));
  Vec3 normal = cross(hierarchy.position(v[3]) - origin, middle - origin);
  if (dot(normal, first - origin) < 0) normal = -1 * normal;
  return {normal, origin};
}

TetrahedronId ResamplingState::root_at(const Vec3& p) const {
  const Domain& domain = hierarchy.domain();
  const auto counts = domain.roots();
  std::array<std::size_t, 3> cube{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double part = (p[axis] - domain.box().min[axis]) / domain.box().size()[axis];
    cube[a] = static_cast<std::size_t>(std::clamp(part * counts[a], 0.0, counts[a] - 1.0));
  }
  const std::size_t first =
      kRootsOfCube * (cube[0] + static_cast<std::size_t>(counts[0]) *
                                    (cube[1] + static_cast<std::size_t>(counts[1]) * cube[2]));
  std::size_t best = first;
  double greatest = -1e300;
  for (std::size_t r = first; r < first + kRootsOfCube; ++r) {
    const Weights w = root_frames[r].weights(p);
    const double least = std::min({w[0], w[1], w[2], w[3]});
    if (least > greatest) greatest = least, best = r;
  }
  return hierarchy.roots()[best];
}

TetrahedronId ResamplingState::leaf_at(const Vec3& p) const {
  TetrahedronId t = root_at(p);
  while (!hierarchy.is_leaf(t)) t = hierarchy.children(t)[split_plane(t).side(p)];
  return t;
}

std::vector<TetrahedronId> ResamplingState::leaves_at(std::span<const Vec3> points) const {
  std::vector<TetrahedronId> at(points.size());
  parallel_for(points.size(), 1024, [&](std::size_t i) { at[i] = root_at(points[i]); });
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::uint32_t i) { return std::pair(at[i], i); });
  // The points of a tetrahedron go to its children together.
  using Points = std::span<std::uint32_t>;
  const auto descend = [&](const auto& self, TetrahedronId t, Points here) -> void {
    if (here.empty()) return;
    if (hierarchy.is_leaf(t)) {
      for (const std::uint32_t i : here) at[i] = t;
      return;
    }
    const SplitPlane plane = split_plane(t);
    const auto middle =
        std::partition(here.begin(), here.end(), [&](std::uint32_t i) { return plane.side(points[i]) == 0; });
    const auto children = hierarchy.children(t);
    self(self, children[0], Points(here.begin(), middle));
    self(self, children[1], Points(middle, here.end()));
  };
  std::vector<Points> of_roots;
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    while (last < order.size() && at[order[last]] == at[order[first]]) ++last;
    of_roots.push_back(Points(order).subspan(first, last - first));
  }
  parallel_for(of_roots.size(), 1, [&](std::size_t r) { descend(descend, at[of_roots[r][0]], of_roots[r]); });
  return at;
}

std::vector<TetrahedronId> ResamplingState::leaves_near(std::span<const TetrahedronId> tetrahedra,
                                                        double distance) const {
  std::vector<Box3> boxes;
  boxes.reserve(tetrahedra.size());
  for (const TetrahedronId t : tetrahedra) boxes.push_back(box(t));
  const Vec3 reach{distance, distance, distance};
  // The boxes near a tetrahedron are among those near its parent.
  const auto descend = [&](const auto& self, TetrahedronId t, std::span<const std::uint32_t> above,
                           std::vector<TetrahedronId>& found) -> void {
    const Box3 own = box(t), wide{own.min - reach, own.max + reach};
    std::vector<std::uint32_t> near;
    std::ranges::copy_if(above, std::back_inserter(near),
                         [&](std::uint32_t b) { return wide.touches(boxes[b]); });
    if (near.empty()) return;
    if (hierarchy.is_leaf(t)) {
      found.push_back(t);
      return;
    }
    for (const TetrahedronId child : hierarchy.children(t)) self(self, child, near, found);
  };
  std::vector<std::uint32_t> all(boxes.size());
  std::iota(all.begin(), all.end(), 0u);
  const auto& roots = hierarchy.roots();
  return parallel_collect<TetrahedronId>(
      roots.size(), 1, [&](std::size_t begin, std::size_t end, std::vector<TetrahedronId>& found) {
        for (std::size_t r = begin; r < end; ++r) descend(descend, roots[r], all, found);
      });
}

void ResamplingState::add_leaf_at(const Vec3& p, double finest, std::vector<TetrahedronId>& list) const {
  const TetrahedronId leaf = leaf_at(p);
  if (frame(leaf).diameter() > finest) list.push_back(leaf);
}

std::string ResamplingState::stage(std::string_view name) const {
  return fmt::format("{}: {} tetrahedra", name, hierarchy.leaf_count());
}

void ResamplingState::report(std::string_view name) const { progress.step(stage(name), -1); }

}  // namespace adamas::interfaces
