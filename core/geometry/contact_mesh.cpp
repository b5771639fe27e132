#include "core/geometry/contact_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/geometry/triangulate.h"

namespace adamas {

namespace {

/// Weights below this are zero: the point lies on the smaller feature.
constexpr double kZeroWeight = 1e-12;
constexpr std::uint64_t kNone = ~std::uint64_t{0};
constexpr std::array<std::uint64_t, 4> kNoFunctions{kNone, kNone, kNone, kNone};

/// The ids of the feature that is left when the vertices in `zeros` are taken away.
std::array<std::uint64_t, 4> feature(std::array<std::uint64_t, 4> ids, unsigned zeros) {
  for (std::size_t i = 0; i < 4; ++i) {
    if ((zeros >> i & 1u) != 0u) ids[i] = kNone;
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::uint64_t mix(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ull;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// Whether p lies on the segment between a and b, away from its ends; `position` then tells how far along.
bool passes(const Vec3& p, const Vec3& a, const Vec3& b, double tolerance, double& position) {
  const Vec3 along = b - a;
  const double length = norm(along);
  if (!(length > 2 * tolerance)) return false;
  position = dot(p - a, along) / length;
  if (position <= tolerance || position >= length - tolerance) return false;
  return norm(p - a - (position / length) * along) <= tolerance;
}

}  // namespace

ContactBuffer::Key ContactBuffer::digest(const std::array<std::uint64_t, 4>& ids,
                                         const std::array<std::uint64_t, 4>& functions) {
  std::uint64_t low = 0x243f6a8885a308d3ull, high = 0x13198a2e03707344ull;
  for (const auto* part : {&ids, &functions}) {
    for (const std::uint64_t word : *part) {
      low = mix(low + word + 0x9e3779b97f4a7c15ull);
      high = mix((high ^ std::rotl(word, 32)) + 0xd1b54a32d192ed03ull);
    }
  }
  return {low | 1, high};
}

ContactBuffer::Corner ContactBuffer::make_corner(const ContactPolygon::Corner& corner,
                                                 const std::array<std::uint64_t, 4>& ids,
                                                 const std::array<Vec3, 4>& positions) const {
  Corner result;
  std::array<std::uint64_t, 4> support;
  support.fill(kNone);
  std::size_t count = 0, last = 0;
  Vec3 position;
  double total = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool by_construction = (corner.zero_weights >> i & 1u) != 0u;
    if (by_construction || corner.weights[i] < kZeroWeight) {
      result.zeros = static_cast<std::uint8_t>(result.zeros | 1u << i);
      result.crowded = result.crowded || !by_construction;
      continue;
    }
    support[count++] = ids[i];
    last = i;
    position += corner.weights[i] * positions[i];
    total += corner.weights[i];
  }
  result.position = count == 1 ? positions[last] : (1 / total) * position;
  std::array<std::uint64_t, 4> functions = corner.functions;
  if (count == 1) functions.fill(kNone);
  result.key = digest(support, functions);
  if (count == 2 || count == 3) result.own = digest(support, kNoFunctions);
  return result;
}

void ContactBuffer::add(const std::array<std::uint64_t, 4>& vertex_ids, const std::array<Vec3, 4>& positions,
                        const OwnershipProblem& problem) {
  if (problem.candidates.size() < 2) return;
  std::array<std::size_t, 4> order{0, 1, 2, 3};
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return vertex_ids[a] < vertex_ids[b]; });
  std::array<std::uint64_t, 4> ids;
  std::array<Vec3, 4> places;
  OwnershipProblem sorted = problem;
  for (std::size_t i = 0; i < 4; ++i) {
    ids[i] = vertex_ids[order[i]];
    places[i] = positions[order[i]];
    for (std::size_t f = 0; f < problem.functions.size(); ++f) {
      sorted.functions[f].values[i] = problem.functions[f].values[order[i]];
    }
  }
  std::vector<ContactPolygon> contacts;
  contact_polygons(sorted, contacts);
  const bool mirrored = signed_volume(places[0], places[1], places[2], places[3]) < 0;
  const bool crowded = problem.candidates.size() > 2 || problem.functions.size() > 2;
  const std::size_t first_polygon = polygons_.size();
  for (ContactPolygon& contact : contacts) {
    if (mirrored) std::reverse(contact.corners.begin(), contact.corners.end());
    const auto first = static_cast<std::uint32_t>(corners_.size());
    for (const auto& corner : contact.corners) {
      corners_.push_back(make_corner(corner, ids, places));
      corners_.back().crowded = corners_.back().crowded || crowded;
    }
    for (std::size_t c = 0; c < contact.corners.size(); ++c) {
      Corner& here = corners_[first + c];
      const Corner& next = corners_[first + (c + 1) % contact.corners.size()];
      if (const unsigned zeros = here.zeros & next.zeros; zeros != 0)
        here.leaving = digest(feature(ids, zeros), kNoFunctions);
      if (!here.crowded) here.own = {};
    }
    polygons_.push_back(
        {contact.front, contact.back, first, static_cast<std::uint32_t>(contact.corners.size())});
  }
  if (crowded && polygons_.size() - first_polygon > 1) {
    double size = 0;
    for (std::size_t i = 1; i < 4; ++i) size = std::max(size, distance(places[0], places[i]));
    insert_passed_points(first_polygon, 1e-10 * size);
  }
}

void ContactBuffer::insert_passed_points(std::size_t first_polygon, double tolerance) {
  const std::size_t begin = polygons_[first_polygon].first;
  const std::vector<Corner> all(corners_.begin() + static_cast<std::ptrdiff_t>(begin), corners_.end());
  corners_.resize(begin);
  for (std::size_t p = first_polygon; p < polygons_.size(); ++p) {
    Polygon& polygon = polygons_[p];
    const std::size_t old_first = polygon.first - begin;
    polygon.first = static_cast<std::uint32_t>(corners_.size());
    for (std::size_t c = 0; c < polygon.count; ++c) {
      const Corner& here = all[old_first + c];
      const Corner& next = all[old_first + (c + 1) % polygon.count];
      corners_.push_back(here);
      std::vector<std::pair<double, Corner>> passed;
      for (const Corner& other : all) {
        double position = 0;
        if (other.key == here.key || other.key == next.key) continue;
        if (!passes(other.position, here.position, next.position, tolerance, position)) continue;
        passed.emplace_back(position, other);
        passed.back().second.leaving = here.leaving;
      }
      std::sort(passed.begin(), passed.end(), [](const auto& a, const auto& b) {
        return std::tuple(a.first, a.second.key.low) < std::tuple(b.first, b.second.key.low);
      });
      for (std::size_t i = 0; i < passed.size(); ++i) {
        if (i == 0 || passed[i].second.key != passed[i - 1].second.key) corners_.push_back(passed[i].second);
      }
    }
    polygon.count = static_cast<std::uint32_t>(corners_.size() - polygon.first);
  }
}

std::uint32_t ContactMeshBuilder::point_of(const ContactBuffer::Corner& corner) {
  const auto [entry, fresh] =
      point_by_key_.try_emplace(corner.key, static_cast<std::uint32_t>(points_.size()));
  if (fresh) points_.push_back(corner.position);
  if (corner.crowded) crowded_.push_back(entry->second);
  if (corner.own != ContactBuffer::Key{}) points_in_feature_[corner.own].push_back(entry->second);
  return entry->second;
}

void ContactMeshBuilder::append(const ContactBuffer& buffer) {
  for (const auto& polygon : buffer.polygons_) {
    polygons_.push_back(
        {polygon.front, polygon.back, static_cast<std::uint32_t>(corners_.size()), polygon.count});
    for (std::uint32_t c = polygon.first; c < polygon.first + polygon.count; ++c) {
      corners_.push_back(point_of(buffer.corners_[c]));
      leaving_.push_back(buffer.corners_[c].leaving);
    }
  }
}

void ContactMeshBuilder::add(const std::array<std::uint64_t, 4>& vertex_ids,
                             const std::array<Vec3, 4>& positions, const OwnershipProblem& problem) {
  ContactBuffer buffer;
  buffer.add(vertex_ids, positions, problem);
  append(buffer);
}

void ContactMeshBuilder::weld_crowded_points() {
  welded_.resize(points_.size());
  std::iota(welded_.begin(), welded_.end(), 0u);
  std::sort(crowded_.begin(), crowded_.end());
  crowded_.erase(std::unique(crowded_.begin(), crowded_.end()), crowded_.end());
  const auto box_of = [](std::int64_t i, std::int64_t j, std::int64_t k) {
    return mix(mix(mix(static_cast<std::uint64_t>(i)) + static_cast<std::uint64_t>(j)) +
               static_cast<std::uint64_t>(k));
  };
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> boxes;
  for (const std::uint32_t p : crowded_) {
    const Vec3& x = points_[p];
    std::array<std::int64_t, 3> low{}, high{}, own{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double scaled = x[axis] / (4 * tolerance_);
      low[a] = static_cast<std::int64_t>(std::floor(scaled - 0.25));
      high[a] = static_cast<std::int64_t>(std::floor(scaled + 0.25));
      own[a] = static_cast<std::int64_t>(std::floor(scaled));
    }
    std::uint32_t found = p;
    for (std::int64_t i = low[0]; i <= high[0]; ++i) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        for (std::int64_t k = low[2]; k <= high[2]; ++k) {
          const auto box = boxes.find(box_of(i, j, k));
          if (box == boxes.end()) continue;
          for (const std::uint32_t q : box->second) {
            if (distance(points_[q], x) <= tolerance_) found = std::min(found, q);
          }
        }
      }
    }
    welded_[p] = welded_[found];
    if (found == p) boxes[box_of(own[0], own[1], own[2])].push_back(p);
  }
}

void ContactMeshBuilder::emit(const Polygon& polygon, InterfaceMesh& mesh) {
  std::vector<std::uint32_t> loop;
  for (std::uint32_t c = 0; c < polygon.count; ++c) {
    const std::size_t here = polygon.first + c;
    const std::uint32_t a = welded_[corners_[here]],
                        b = welded_[corners_[polygon.first + (c + 1) % polygon.count]];
    loop.push_back(a);
    if (a == b || leaving_[here] == ContactBuffer::Key{}) continue;
    const auto face = points_in_feature_.find(leaving_[here]);
    if (face == points_in_feature_.end()) continue;
    std::vector<std::pair<double, std::uint32_t>> passed;
    for (const std::uint32_t raw : face->second) {
      const std::uint32_t p = welded_[raw];
      double position = 0;
      if (p != a && p != b && passes(points_[p], points_[a], points_[b], tolerance_, position)) {
        passed.emplace_back(position, p);
      }
    }
    std::sort(passed.begin(), passed.end());
    for (const auto& [position, p] : passed) loop.push_back(p);
  }
  loop.erase(std::unique(loop.begin(), loop.end()), loop.end());
  while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
  if (loop.size() < 3) return;
  triangulate_convex(points_, loop, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangles.push_back({{a, b, c}, MaterialId(polygon.front), MaterialId(polygon.back)});
  });
}

InterfaceMesh ContactMeshBuilder::finish() {
  weld_crowded_points();
  point_by_key_.clear();
  for (auto& [face, points] : points_in_feature_) {
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
  }
  InterfaceMesh mesh;
  mesh.triangles.reserve(2 * polygons_.size());
  for (const Polygon& polygon : polygons_) emit(polygon, mesh);
  // Points in the order of their first use.
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> renumbered(points_.size(), kUnused);
  for (InterfaceTriangle& triangle : mesh.triangles) {
    for (std::uint32_t& p : triangle.points) {
      if (renumbered[p] == kUnused) {
        renumbered[p] = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(points_[p]);
      }
      p = renumbered[p];
    }
  }
  *this = ContactMeshBuilder(tolerance_);
  return mesh;
}

}  // namespace adamas
