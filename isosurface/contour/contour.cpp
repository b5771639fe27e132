#include "isosurface/contour/contour.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/large_pages.h"
#include "isosurface/contour/contour_clip.h"
#include "isosurface/contour/join_points.h"

namespace adamas::isosurface {

bool is_beyond(const std::array<LatticePoint, 4>& vertices, LatticePoint last_sample) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::all_of(vertices.begin(), vertices.end(),
                    [&](LatticePoint p) { return p[axis] >= last_sample[axis]; })) {
      return true;
    }
  }
  return false;
}

void remove_unused_points(Contour& contour) {
  std::vector<std::uint32_t> numbers(contour.points.size(), ContourBuilder::kNone);
  for (const auto& triangle : contour.triangles) {
    for (const std::uint32_t p : triangle) numbers[p] = 0;
  }
  const std::size_t edge_count = contour.edge_points.size();
  const std::size_t mean_begin = edge_count + contour.vertex_points.size();
  std::uint32_t kept = 0, edges = 0, vertices = 0, means = 0;
  for (std::size_t p = 0; p < numbers.size(); ++p) {
    if (numbers[p] == ContourBuilder::kNone) continue;
    contour.points[kept] = contour.points[p];
    numbers[p] = kept++;
    if (p < edge_count) {
      contour.edge_points[edges++] = contour.edge_points[p];
    } else if (p < mean_begin) {
      contour.vertex_points[vertices++] = contour.vertex_points[p - edge_count];
    } else {
      contour.mean_points[means++] = contour.mean_points[p - mean_begin];
    }
  }
  contour.points.resize(kept);
  contour.edge_points.resize(edges);
  contour.vertex_points.resize(vertices);
  contour.mean_points.resize(means);
  for (auto& triangle : contour.triangles) {
    for (std::uint32_t& p : triangle) p = numbers[p];
  }
}

ContourBuilder::ContourBuilder(const Domain& domain, double isovalue, const ContourOptions& options)
    : domain_(domain), isovalue_(isovalue), options_(options) {
  ADAMAS_ASSERT(options.least_parameter >= 0 && options.least_parameter < 0.5);
}

std::uint32_t ContourBuilder::edge_point(LatticePoint a, LatticePoint b, double value_a, double value_b) {
  if (b < a) {
    std::swap(a, b);
    std::swap(value_a, value_b);
  }
  const auto [number, is_new] = number_of_edge(a, b);
  if (is_new) {
    *number = next_number();
    const double t = std::clamp(edge_parameter(value_a, value_b, isovalue_), options_.least_parameter,
                                1 - options_.least_parameter);
    contour_.edge_points.push_back({a, b, t});
    contour_.points.push_back(point_between(domain_.position(a), domain_.position(b), t));
  }
  return *number;
}

std::uint32_t ContourBuilder::edge_point(const EdgePoint& point, const Vec3& position) {
  const auto [number, is_new] = number_of_edge(point.first, point.second);
  if (is_new) {
    *number = next_number();
    contour_.edge_points.push_back(point);
    contour_.points.push_back(position);
  }
  return *number;
}

std::uint32_t ContourBuilder::next_number() const {
  if (contour_.points.size() >= std::numeric_limits<std::uint32_t>::max())
    fail("a contour has more than 2^32 - 1 points: choose another isovalue or a coarser mesh");
  return static_cast<std::uint32_t>(contour_.points.size());
}

void ContourBuilder::append(std::span<const std::unique_ptr<ContourBuilder>> others) {
  std::vector<std::vector<std::uint32_t>> numbers(others.size());
  for (std::size_t n = 0; n < others.size(); ++n) {
    ContourBuilder& other = *others[n];
    std::vector<std::uint32_t>& of_other = numbers[n];
    of_other.assign(other.contour_.points.size(), kNone);
    other.numbers_.for_each_common(numbers_,
                                   [&](std::uint32_t there, std::uint32_t here) { of_other[there] = here; });
    for (std::size_t m = 0; m < n; ++m) {
      other.numbers_.for_each_common(others[m]->numbers_, [&](std::uint32_t there, std::uint32_t before) {
        of_other[there] = numbers[m][before];
      });
    }
    append(other.contour_, of_other);
    other.contour_ = {};
  }
}

void ContourBuilder::append(const Contour& other, std::vector<std::uint32_t>& numbers) {
  for (std::size_t p = 0; p < numbers.size(); ++p) {
    if (numbers[p] != kNone) continue;
    numbers[p] = next_number();
    contour_.points.push_back(other.points[p]);
    contour_.edge_points.push_back(other.edge_points[p]);
  }
  for (const auto& [a, b, c] : other.triangles)
    contour_.triangles.push_back({numbers[a], numbers[b], numbers[c]});
}

void ContourBuilder::reserve(std::size_t triangles) {
  // Closed surfaces have half as many points and two for each of their parts, open ones a few more.
  const std::size_t points = triangles / 2 + triangles / 32;
  reserve_in_large_pages(contour_.triangles, triangles);
  reserve_in_large_pages(contour_.points, points);
  reserve_in_large_pages(contour_.edge_points, points);
}

Contour ContourBuilder::finish() {
  if (options_.join) {
    numbers_ = {};
    join_points(contour_);
  }
  if (options_.last_sample)
    clip_contour(contour_, {domain_.box().min, domain_.position(*options_.last_sample)}, options_.spacing);
  return std::move(contour_);
}

std::uint32_t DiamondContour::edge_point(std::size_t a, std::size_t b) {
  std::uint32_t& point = edge_points_[std::min(a, b)][std::max(a, b)];
  if (point == ContourBuilder::kNone)
    point = builder_.edge_point(points_[a], points_[b], values_[a], values_[b]);
  return point;
}

void DiamondContour::add_tetrahedron(int slot) {
  const std::size_t r = 2 + static_cast<std::size_t>(slot), next = r + 1 == 2 + ring_ ? 2 : r + 1;
  const std::array<std::size_t, 4> members{0, 1, r, next};
  unsigned above = 0;
  for (std::size_t v = 0; v < 4; ++v) above |= unsigned{above_[members[v]]} << v;
  const TetrahedronContour& table = kTetrahedronContours[above];
  if (table.triangle_count == 0) return;
  for (const std::size_t m : members) {
    if (!std::isfinite(values_[m])) return;
  }
  if (last_sample_ && is_beyond({points_[0], points_[1], points_[r], points_[next]}, *last_sample_)) return;
  for (std::size_t n = 0; n < table.triangle_count; ++n) {
    std::array<std::uint32_t, 3> triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [v, w] = kTetrahedronEdges[table.triangles[n][c]];
      triangle[c] = edge_point(members[v], members[w]);
    }
    builder_.add_triangle(triangle);
  }
}

}  // namespace adamas::isosurface
