#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "adamas/geometry.h"
#include "isosurface/contour/contour.h"
#include "isosurface/volume/error_scale.h"
#include "isosurface/volume/samples.h"
#include "tests/support/table_contour.h"
#include "tests/support/volume_store.h"

namespace adamas::test {

using namespace isosurface;

using Edge = std::pair<LatticePoint, LatticePoint>;
/// Triangles as the edges of the mesh that their corners lie on. Each begins with the least edge and keeps
/// its orientation.
using TriangleSet = std::multiset<std::array<Edge, 3>>;
/// Returns the triangles of a contour that nothing clipped.
TriangleSet triangle_set(const Contour& contour);

/// Values at points of the lattice.
using Field = std::function<double(LatticePoint)>;

/// Returns the number of lattice units between two samples.
inline std::int32_t lattice_step(int depth) { return std::int32_t{1} << (kRootBits - depth); }

/// Returns the values in the domain, which are those of the nearest samples.
template <class Sample>
Field field_of(const MemoryVolume<Sample>& volume, int depth) {
  return [&volume, shift = kRootBits - depth](LatticePoint p) {
    return static_cast<double>(volume.at({p.i >> shift, p.j >> shift, p.k >> shift}));
  };
}

/// What a store states of the diamonds that reach into the data, by their points in units of samples.
template <class Sample>
class DiamondTable {
 public:
  struct Values {
    double error = 0, low = 1, high = 0;  ///< the range is empty where low > high
    [[nodiscard]] bool is_crossed(double isovalue) const { return low < isovalue && isovalue <= high; }
  };

  explicit DiamondTable(OpenStore<Sample>& store)
      : domain_(store.extractor().domain()),
        depth_(store.pages().grid().depth()),
        last_(store.pages().grid().last()) {
    StoredPages<OrderedWord<Sample>>& pages = store.pages();
    const PageGrid& grid = pages.grid();
    std::vector<LatticePoint> beyond;
    for (int lod = 0; lod < depth_; ++lod) {
      const LatticePoint end = grid.extent(lod);
      for (std::int32_t k = 0; k <= end.k; ++k)
        for (std::int32_t j = 0; j <= end.j; ++j)
          for (std::int32_t i = 0; i <= end.i; ++i) {
            if (((i | j | k) & 1) == 0) continue;
            const LatticePoint p = (1 << lod) * LatticePoint{i, j, k};
            if (!reaches_data(p)) continue;
            const PageId id = grid.page(p);
            const LatticePoint q{p.i >> id.lod, p.j >> id.lod, p.k >> id.lod};
            if (PageShape{grid.count(id), true, id.lod}.owns(q - PageGrid::kSide * id.block)) {
              diamonds_[p] = values_in(*pages.bounds(id), p, lod, id.lod);
            } else {
              beyond.push_back(p);
            }
          }
    }
    for (const LatticePoint p : beyond) bounds_[p] = bound(p);
    diamonds_.merge(bounds_);
  }

  [[nodiscard]] const std::map<LatticePoint, Values>& diamonds() const { return diamonds_; }

  /// Returns the mesh in which those diamonds are split that the surface crosses with a greater error.
  [[nodiscard]] IndexedHierarchy mesh(double isovalue, double error) const {
    return mesh([&](const Values& values) { return values.error > error && values.is_crossed(isovalue); });
  }
  /// Returns the mesh in which every diamond is split that reaches into the data.
  [[nodiscard]] IndexedHierarchy full_mesh() const {
    return mesh([](const Values&) { return true; });
  }

 private:
  template <class Wanted>
  [[nodiscard]] IndexedHierarchy mesh(const Wanted& wanted) const {
    IndexedHierarchy result(domain_, depth_);
    std::vector<LatticePoint> done;
    for (const auto& [p, values] : diamonds_) {
      if (wanted(values)) result.split(lattice_step(depth_) * p, done);
    }
    return result;
  }

  Values values_in(const PageBounds<OrderedWord<Sample>>& page, LatticePoint p, int lod, int page_lod) {
    const std::size_t at = PageGrid::place(p, page_lod);
    Values values{scale(lod).decode(page.errors[at])};
    if (page.low[at] <= page.high[at]) {
      values.low = from_ordered<Sample>(page.low[at]);
      values.high = from_ordered<Sample>(page.high[at]);
      all_.low = all_.low > all_.high ? values.low : std::min(all_.low, values.low);
      all_.high = std::max(all_.high, values.high);
    }
    return values;
  }
  [[nodiscard]] const ErrorScale& scale(int lod) const {
    const auto found = scales_.find(lod);
    if (found != scales_.end()) return found->second;
    return scales_.emplace(lod, lod_error_scale(spacing(), lod)).first->second;
  }
  [[nodiscard]] Vec3 spacing() const { return std::ldexp(1.0, kRootBits - depth_) * domain_.spacing(); }

  /// Returns values of a diamond from those of its parents, which cover it. Pages have no place for the
  /// points of some diamonds that reach far beyond the data.
  [[nodiscard]] Values bound(LatticePoint p) const {
    Values result{scale(trailing_zeros(p)).greatest(), all_.low, all_.high};
    const std::int32_t step = std::int32_t{1} << (kRootBits - depth_);
    for (const LatticePoint parent : Diamond(step * p).parents(domain_)) {
      const LatticePoint q{parent.i / step, parent.j / step, parent.k / step};
      const auto known = diamonds_.find(q);
      const bool is_beyond = known == diamonds_.end();
      if (is_beyond && !reaches_data(q)) continue;
      const Values values = is_beyond ? bound(q) : known->second;
      result.error = std::min(result.error, values.error);
      result.low = std::max(result.low, values.low);
      result.high = std::min(result.high, values.high);
    }
    return result;
  }
  [[nodiscard]] bool reaches_data(LatticePoint p) const {
    const std::int32_t s = std::int32_t{1} << trailing_zeros(p);
    return trailing_zeros(p) < depth_ && p.i - s < last_.i && p.j - s < last_.j && p.k - s < last_.k;
  }

  Domain domain_;
  int depth_;
  LatticePoint last_;
  Values all_{};
  std::map<LatticePoint, Values> diamonds_, bounds_;
  mutable std::map<int, ErrorScale> scales_;  ///< the scales that were asked for so far
};

/// Returns options of a contour that ends where the data do.
template <class Sample>
ContourOptions options_of(const MemoryVolume<Sample>& volume, int depth, double least_parameter) {
  return {least_parameter, lattice_step(depth) * volume.last(),
          least_parameter > 0 ? volume.grid.spacing : Vec3{}};
}

/// Expects a surface that is sound for all data in which every sample is a number: edges with one triangle
/// lie in the sides of the box, all other edges have two triangles that run along them in opposite
/// directions, all triangles have an area, and points lie on edges of the mesh where their parameters state.
void expect_sound(const Contour& contour, const Box3& box);

/// The linear interpolation of values at the corners of the tetrahedron of the mesh that holds a point. The
/// tetrahedron is found by bisection from the root, so every mesh of the hierarchy will do.
class MeshFunction {
 public:
  MeshFunction(const IndexedHierarchy& mesh, Field values);
  struct Place {
    LatticePoint diamond;  ///< the diamond of the mesh's tetrahedron
    double value;
  };
  [[nodiscard]] Place at(const Vec3& point) const;

 private:
  const IndexedHierarchy& mesh_;
  Field values_;
};

/// Returns points on all parts of a surface: corners, middles of sides, and points inside triangles.
std::vector<Vec3> points_on(const Contour& contour);

}  // namespace adamas::test
