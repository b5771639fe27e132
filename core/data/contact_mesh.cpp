#include "core/data/contact_mesh.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "core/base/hash.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/release_memory.h"
#include "core/base/sort_unique.h"
#include "core/geometry/triangulate.h"

namespace adamas::inline core {

namespace {

constexpr std::size_t kPolygonsAPart = 16384;

/// The number of buffers of a task: some are of one cell, others of a whole layer of cells.
std::size_t buffers_per_task(std::span<const ContactBuffer* const> buffers) {
  constexpr std::size_t kTasks = 256;
  return buffers.size() / kTasks + 1;
}

/// Points by hashes of the boxes they lie in, which are as good as random: a table with open addressing.
class PointsByBox {
 public:
  /// `most`: the greatest number of points.
  explicit PointsByBox(std::size_t most) : slots_(std::bit_ceil(2 * most + 1)) {}

  void add(std::uint64_t box, std::uint32_t point) {
    std::size_t at = mix64(box) & (slots_.size() - 1);
    while (slots_[at].point != kFree) at = (at + 1) & (slots_.size() - 1);
    slots_[at] = {box, point};
  }
  /// Calls visit(point) for the points with this hash.
  template <class Visit>
  void for_each(std::uint64_t box, Visit&& visit) const {
    for (std::size_t at = mix64(box) & (slots_.size() - 1); slots_[at].point != kFree;
         at = (at + 1) & (slots_.size() - 1)) {
      if (slots_[at].box == box) visit(slots_[at].point);
    }
  }

 private:
  static constexpr std::uint32_t kFree = 0xffffffffu;
  struct Slot {
    std::uint64_t box = 0;
    std::uint32_t point = kFree;
  };
  std::vector<Slot> slots_;
};

}  // namespace

void ContactMeshBuilder::reserve(std::size_t polygons, std::size_t corners) {
  polygons_.reserve(polygons);
  corners_.reserve(corners);
  leaving_.reserve(corners);
}

void ContactMeshBuilder::append(std::span<const ContactBuffer* const> buffers) {
  std::vector<Place> places;
  places.reserve(buffers.size() + 1);
  Place end{polygons_.size(), corners_.size()};
  for (const ContactBuffer* buffer : buffers) {
    places.push_back(end);
    end.polygon += buffer->polygons_.size();
    end.corner += buffer->corners_.size();
  }
  places.push_back(end);
  add_points(buffers, places);
  polygons_.resize(end.polygon);
  leaving_.resize(end.corner);
  parallel_for(buffers.size(), buffers_per_task(buffers), [&](std::size_t b) {
    auto [polygon, corner] = places[b];
    for (const auto& p : buffers[b]->polygons_) {
      polygons_[polygon++] = {p.front, p.back, static_cast<std::uint32_t>(corner), p.count};
      for (std::uint32_t c = 0; c < p.count; ++c)
        leaving_[corner++] = buffers[b]->corners_[p.first + c].leaving;
    }
  });
  add_line_uses(buffers, places);
}

/// Numbers the points of corners. Each has the position of its first corner.
void ContactMeshBuilder::add_points(std::span<const ContactBuffer* const> buffers,
                                    const std::vector<Place>& places) {
  const std::size_t known = corners_.size();
  std::vector<Digest> keys(places.back().corner - known);
  parallel_for(buffers.size(), buffers_per_task(buffers), [&](std::size_t b) {
    std::size_t at = places[b].corner - known;
    for (const auto& corner : buffers[b]->corners_) keys[at++] = corner.key;
  });
  const DigestNumbers::Added added = point_by_key_.add(keys);
  corners_.insert(corners_.end(), added.numbers.begin(), added.numbers.end());
  points_.resize(point_by_key_.size());
  crowded_.resize(points_.size(), 0);
  const std::size_t fresh = points_.size() - added.firsts.size();
  parallel_for(buffers.size(), buffers_per_task(buffers), [&](std::size_t b) {
    std::size_t at = places[b].corner;
    for (const auto& corner : buffers[b]->corners_) {
      const std::uint32_t point = corners_[at];
      if (point >= fresh && added.firsts[point - fresh] == at - known) points_[point] = corner.position;
      if (corner.crowded) std::atomic_ref(crowded_[point]).store(1, std::memory_order_relaxed);
      ++at;
    }
  });
}

/// Adds the edges at whose first corners others may lie on their line.
void ContactMeshBuilder::add_line_uses(std::span<const ContactBuffer* const> buffers,
                                       const std::vector<Place>& places) {
  struct Edge {
    Digest line;
    std::array<std::uint32_t, 2> ends;
  };
  const auto edges =
      parallel_collect<Edge>(buffers.size(), buffers_per_task(buffers),
                             [&](std::size_t begin, std::size_t end, std::vector<Edge>& list) {
                               for (std::size_t b = begin; b < end; ++b) {
                                 std::size_t first = places[b].corner;
                                 for (const auto& polygon : buffers[b]->polygons_) {
                                   for (std::uint32_t c = 0; c < polygon.count; ++c) {
                                     const auto& corner = buffers[b]->corners_[polygon.first + c];
                                     const auto [low, high] = std::minmax(
                                         corners_[first + c], corners_[first + (c + 1) % polygon.count]);
                                     if (corner.crowded) list.push_back({corner.leaving, {low, high}});
                                   }
                                   first += polygon.count;
                                 }
                               }
                             });
  std::vector<Digest> lines(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) lines[e] = edges[e].line;
  const std::vector<std::uint32_t> numbers = line_by_key_.add(lines).numbers;
  for (std::size_t e = 0; e < edges.size(); ++e) line_uses_.push_back({numbers[e], edges[e].ends});
}

ContactMeshBuilder::Line ContactMeshBuilder::ordered_line(std::vector<std::uint32_t> points) const {
  sort_unique(points);
  Line line{points_[points.front()], {}, {}};
  for (const std::uint32_t p : points) {
    const Vec3 offset = points_[p] - line.origin;
    if (squared_norm(offset) > squared_norm(line.direction)) line.direction = offset;
  }
  for (const std::uint32_t p : points) line.points.push_back(line.place(p, points_[p]));
  std::sort(line.points.begin(), line.points.end());
  return line;
}

/// Most lines have the two points of one edge, which several polygons share. The others are put in order.
void ContactMeshBuilder::order_lines() {
  line_points_.assign(line_by_key_.size(), {0, 0});
  std::vector<std::vector<std::uint32_t>> points;
  std::vector<char> seen(line_points_.size(), 0);
  for (const auto& [line, ends] : line_uses_) {
    auto& found = line_points_[line];
    if (seen[line] == 0) found = ends, seen[line] = 1;
    if (found == ends || found[0] == kManyPoints) continue;
    found = {kManyPoints, static_cast<std::uint32_t>(points.size())};
    points.emplace_back();
  }
  for (const auto& [line, ends] : line_uses_) {
    const auto& [first, place] = line_points_[line];
    if (first == kManyPoints) points[place].insert(points[place].end(), ends.begin(), ends.end());
  }
  release_memory(line_uses_);
  lines_.resize(points.size());
  parallel_for(points.size(), 1024, [&](std::size_t i) { lines_[i] = ordered_line(std::move(points[i])); });
}

/// Adds the points of a line that the edge from a to b passes.
void ContactMeshBuilder::add_passed(const Line& line, std::uint32_t a, std::uint32_t b,
                                    std::vector<std::uint32_t>& loop) const {
  const auto from = line.place(a, points_[a]), to = line.place(b, points_[b]);
  const auto first = std::upper_bound(line.points.begin(), line.points.end(), std::min(from, to));
  const auto last = std::lower_bound(first, line.points.end(), std::max(from, to));
  const auto begin = static_cast<std::ptrdiff_t>(loop.size());
  for (auto p = first; p < last; ++p) loop.push_back(welded_[p->second]);
  if (to < from) std::reverse(loop.begin() + begin, loop.end());
}

void ContactMeshBuilder::find_loop(const Polygon& polygon, std::vector<std::uint32_t>& loop) const {
  loop.clear();
  for (std::uint32_t c = 0; c < polygon.count; ++c) {
    const std::size_t here = polygon.first + c;
    const std::uint32_t a = corners_[here], b = corners_[polygon.first + (c + 1) % polygon.count];
    loop.push_back(welded_[a]);
    const auto line = line_by_key_.find(leaving_[here]);
    if (!line) continue;
    const auto& [low, high] = line_points_[*line];
    if (low == kManyPoints) {
      add_passed(lines_[high], a, b, loop);
    } else if (std::min(a, b) != low || std::max(a, b) != high) {
      add_passed(ordered_line({low, high}), a, b, loop);
    }
  }
  drop_repeated(loop);
}

std::vector<ContactMeshBuilder::Loops> ContactMeshBuilder::find_loops() const {
  std::vector<Loops> parts((polygons_.size() + kPolygonsAPart - 1) / kPolygonsAPart);
  parallel_chunks(polygons_.size(), kPolygonsAPart, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> loop;
    for (std::size_t p = begin; p < end; ++p) {
      find_loop(polygons_[p], loop);
      parts[begin / kPolygonsAPart].add(loop);
    }
  });
  return parts;
}

std::vector<InterfaceTriangle> ContactMeshBuilder::triangulate(const std::vector<Loops>& parts) const {
  std::vector<std::vector<InterfaceTriangle>> triangles(parts.size());
  parallel_for(parts.size(), 1, [&](std::size_t part) {
    parts[part].for_each([&](std::size_t i, std::span<const std::uint32_t> loop) {
      const Polygon& polygon = polygons_[part * kPolygonsAPart + i];
      triangulate_convex(points_, loop, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (a == b || b == c || c == a) return;
        triangles[part].push_back({{a, b, c}, MaterialId(polygon.front), MaterialId(polygon.back)});
      });
    });
  });
  std::vector<InterfaceTriangle> all;
  all.reserve(2 * polygons_.size());
  for (auto& some : triangles) {
    all.insert(all.end(), some.begin(), some.end());
    release_memory(some);
  }
  return all;
}

/// Numbers points in the order of their first use. `keys`, unless it is null, has the digests of points
/// before and after.
void ContactMeshBuilder::number_points(InterfaceMesh& mesh, std::vector<Digest>* keys) const {
  std::vector<Digest> kept;
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> number(points_.size(), kUnused);
  for (InterfaceTriangle& triangle : mesh.triangles) {
    for (std::uint32_t& p : triangle.points) {
      if (number[p] == kUnused) {
        number[p] = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(points_[p]);
        if (keys != nullptr) kept.push_back((*keys)[p]);
      }
      p = number[p];
    }
  }
  if (keys != nullptr) *keys = std::move(kept);
}

InterfaceMesh ContactMeshBuilder::finish(std::vector<Digest>* keys) {
  order_lines();
  LoopProgress::check();
  weld_crowded_points();
  if (keys != nullptr) *keys = point_by_key_.digests();
  point_by_key_.clear();
  InterfaceMesh mesh;
  std::vector<Loops> loops = find_loops();
  release_memory(corners_);
  release_memory(leaving_);
  release_memory(lines_);
  release_memory(line_points_);
  line_by_key_.clear();
  LoopProgress::check();
  close_spikes(loops);
  mesh.triangles = triangulate(loops);
  release_memory(loops);
  LoopProgress::check();
  cancel_coinciding(mesh);
  LoopProgress::check();
  number_points(mesh, keys);
  LoopProgress::check();
  *this = ContactMeshBuilder(tolerance_);
  return mesh;
}

void ContactMeshBuilder::weld_crowded_points() {
  welded_.resize(points_.size());
  std::iota(welded_.begin(), welded_.end(), 0u);
  const auto box_of = [](std::int64_t i, std::int64_t j, std::int64_t k) {
    std::uint64_t hash = 0;
    for (const std::int64_t index : {i, j, k})
      hash = hash_combine(hash, static_cast<std::uint64_t>(index)) + (hash >> 29);
    return hash;
  };
  PointsByBox boxes(static_cast<std::size_t>(std::count(crowded_.begin(), crowded_.end(), 1)));
  const auto first = std::find(crowded_.begin(), crowded_.end(), 1);
  const Vec3 origin =
      first == crowded_.end() ? Vec3{} : points_[static_cast<std::size_t>(first - crowded_.begin())];
  for (std::uint32_t p = 0; p < points_.size(); ++p) {
    LoopProgress::check_step(p);
    if (crowded_[p] == 0) continue;
    const Vec3& x = points_[p];
    std::array<std::int64_t, 3> low{}, high{}, own{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double scaled = (x[axis] - origin[axis]) / (4 * tolerance_);
      low[a] = static_cast<std::int64_t>(std::floor(scaled - 0.25));
      high[a] = static_cast<std::int64_t>(std::floor(scaled + 0.25));
      own[a] = static_cast<std::int64_t>(std::floor(scaled));
    }
    std::uint32_t found = p;
    for (std::int64_t i = low[0]; i <= high[0]; ++i) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        for (std::int64_t k = low[2]; k <= high[2]; ++k) {
          boxes.for_each(box_of(i, j, k), [&](std::uint32_t q) {
            if (distance(points_[q], x) <= tolerance_) found = std::min(found, q);
          });
        }
      }
    }
    welded_[p] = welded_[found];
    if (found == p) boxes.add(box_of(own[0], own[1], own[2]), p);
  }
}

void ContactMeshBuilder::drop_repeated(std::vector<std::uint32_t>& loop) {
  // An edge that was traversed in both directions leaves a point between two equal ones.
  for (std::size_t before = 0; before != loop.size();) {
    before = loop.size();
    loop.erase(std::unique(loop.begin(), loop.end()), loop.end());
    while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
    for (std::size_t i = 0; loop.size() > 2 && i < loop.size(); ++i) {
      const std::size_t next = (i + 1) % loop.size(), last = (i + 2) % loop.size();
      if (loop[i] != loop[last]) continue;
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(next));
      break;
    }
  }
  if (loop.size() < 3) loop.clear();
}

bool ContactMeshBuilder::passes(std::uint32_t a, std::uint32_t b, std::uint32_t p) const {
  const Vec3 along = points_[b] - points_[a], offset = points_[p] - points_[a];
  const double length = norm(along), at = dot(offset, along) / length;
  return at > tolerance_ && at < length - tolerance_ &&
         squared_norm(cross(offset, along)) <= tolerance_ * tolerance_ * length * length;
}

void ContactMeshBuilder::close_spikes(std::vector<Loops>& parts) const {
  // Each round makes edges shorter; the bound guards against round-off.
  constexpr int kMostRounds = 64;
  using Passed = std::pair<std::uint64_t, std::uint32_t>;  // an edge, and a point that it passes
  for (int round = 0; round < kMostRounds; ++round) {
    std::vector<std::vector<Passed>> found(parts.size());
    parallel_for(parts.size(), 1, [&](std::size_t part) {
      parts[part].for_each([&](std::size_t, std::span<const std::uint32_t> loop) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const std::uint32_t a = loop[i], tip = loop[(i + 1) % loop.size()], b = loop[(i + 2) % loop.size()];
          if (passes(a, tip, b)) found[part].emplace_back(edge_key(a, tip), b);
          if (passes(tip, b, a)) found[part].emplace_back(edge_key(tip, b), a);
        }
      });
    });
    std::unordered_map<std::uint64_t, std::uint32_t> passed;
    for (const auto& some : found) passed.insert(some.begin(), some.end());
    if (passed.empty()) return;
    for (Loops& part : parts) {
      Loops divided;
      std::vector<std::uint32_t> longer;
      part.for_each([&](std::size_t, std::span<const std::uint32_t> loop) {
        longer.clear();
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
          longer.push_back(a);
          if (const auto point = passed.find(edge_key(a, b)); point != passed.end())
            longer.push_back(point->second);
        }
        if (longer.size() != loop.size()) drop_repeated(longer);
        divided.add(longer);
      });
      part = std::move(divided);
    }
  }
}

void ContactMeshBuilder::cancel_coinciding(InterfaceMesh& mesh) const {
  // Triangles by their corners in ascending order.
  struct Side {
    std::array<std::uint32_t, 3> points;
    std::uint32_t triangle;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  const auto turned = [](const InterfaceTriangle& t) {
    auto p = t.points;
    std::sort(p.begin(), p.end());
    return p;
  };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& p = mesh.triangles[t].points;
    if (crowded_[p[0]] != 0 && crowded_[p[1]] != 0 && crowded_[p[2]] != 0)
      sides.push_back({turned(mesh.triangles[t]), t});
  }
  std::sort(sides.begin(), sides.end());
  const auto even = [&](const InterfaceTriangle& t) {
    const auto& p = t.points;
    return (p[0] < p[1]) == (p[1] < p[2]) ? p[0] < p[1] : p[2] < p[0];
  };
  std::vector<char> gone(mesh.triangles.size(), 0);
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last].points == sides[first].points) ++last;
    if (last - first < 2) continue;
    // How often each region lies in front of the stack of triangles rather than behind it.
    std::vector<std::pair<std::uint32_t, int>> net;
    const auto count = [&](MaterialId side, int by) {
      const auto found =
          std::find_if(net.begin(), net.end(), [&](const auto& entry) { return entry.first == side.value; });
      if (found == net.end()) {
        net.emplace_back(side.value, by);
      } else {
        found->second += by;
      }
    };
    for (std::size_t i = first; i < last; ++i) {
      const InterfaceTriangle& t = mesh.triangles[sides[i].triangle];
      count(t.front, even(t) ? 1 : -1);
      count(t.back, even(t) ? -1 : 1);
      gone[sides[i].triangle] = 1;
    }
    std::erase_if(net, [](const auto& entry) { return entry.second == 0; });
    if (net.empty()) continue;
    if (net.size() != 2 || std::abs(net[0].second) != 1) {
      for (std::size_t i = first; i < last; ++i) gone[sides[i].triangle] = 0;
      continue;
    }
    InterfaceTriangle& kept = mesh.triangles[sides[first].triangle];
    if ((net[0].second > 0) != even(kept)) std::swap(net[0], net[1]);
    kept.front = MaterialId(net[0].first);
    kept.back = MaterialId(net[1].first);
    gone[sides[first].triangle] = 0;
  }
  std::size_t left = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (gone[t] == 0) mesh.triangles[left++] = mesh.triangles[t];
  }
  mesh.triangles.resize(left);
}

}  // namespace adamas::inline core
