#include "isosurface/extraction/surface_certificate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/distance/closest_point_tree.h"
#include "core/distance/hausdorff.h"

namespace adamas::isosurface {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// A box that is divided into blocks, and the triangles of a surface that meet each.
class Blocks {
 public:
  Blocks(const Box3& box, const Vec3& side) : box_(box) {
    for (int axis = 0; axis < 3; ++axis) {
      const double length = box.max[axis] - box.min[axis];
      counts_[axis] = std::max(1, static_cast<std::int32_t>(std::ceil(length / side[axis])));
      side_[axis] = length / counts_[axis];
    }
    triangles_.resize(static_cast<std::size_t>(counts_.i) * static_cast<std::size_t>(counts_.j) *
                      static_cast<std::size_t>(counts_.k));
  }

  void add(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
    for (const Triangle& t : triangles) {
      Box3 box;
      for (const std::uint32_t p : t) box.extend(points[p]);
      const LatticePoint first = block_of(box.min), last = block_of(box.max);
      for (LatticePoint b = first; b.k <= last.k; ++b.k)
        for (b.j = first.j; b.j <= last.j; ++b.j)
          for (b.i = first.i; b.i <= last.i; ++b.i) triangles_[place(b)].push_back(t);
    }
  }

  /// Calls visit(box, triangles, part) for each block; part: the part of the blocks before it.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (LatticePoint b{}; b.k < counts_.k; ++b.k) {
      for (b.j = 0; b.j < counts_.j; ++b.j) {
        for (b.i = 0; b.i < counts_.i; ++b.i) {
          const double part = static_cast<double>(place(b)) / static_cast<double>(triangles_.size());
          visit(Box3{corner(b), corner(b + LatticePoint{1, 1, 1})}, triangles_[place(b)], part);
        }
      }
    }
  }

 private:
  [[nodiscard]] std::size_t place(LatticePoint b) const {
    return static_cast<std::size_t>(b.i) +
           static_cast<std::size_t>(counts_.i) *
               (static_cast<std::size_t>(b.j) +
                static_cast<std::size_t>(counts_.j) * static_cast<std::size_t>(b.k));
  }
  /// Returns a corner of blocks, which is the same for all blocks that meet there.
  [[nodiscard]] Vec3 corner(LatticePoint b) const {
    Vec3 result;
    for (int axis = 0; axis < 3; ++axis)
      result[axis] = b[axis] == counts_[axis] ? box_.max[axis] : box_.min[axis] + b[axis] * side_[axis];
    return result;
  }
  /// Returns the block of a point. Rounding may give the next one; triangles go to neighbouring blocks, too.
  [[nodiscard]] LatticePoint block_of(const Vec3& p) const {
    LatticePoint result;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = side_[axis] > 0 ? (p[axis] - box_.min[axis]) / side_[axis] : 0;
      result[axis] = static_cast<std::int32_t>(std::clamp(at, 0.0, counts_[axis] - 1.0));
    }
    return result;
  }

  Box3 box_;
  LatticePoint counts_;
  Vec3 side_;
  std::vector<std::vector<Triangle>> triangles_;
};

Box3 grown(const Box3& box, double by) { return {box.min - Vec3{by, by, by}, box.max + Vec3{by, by, by}}; }

Box3 common(Box3 a, const Box3& b) {
  for (int axis = 0; axis < 3; ++axis) {
    a.min[axis] = std::max(a.min[axis], b.min[axis]);
    a.max[axis] = std::min(a.max[axis], b.max[axis]);
  }
  return a;
}

template <class Sample>
class Certifier {
 public:
  Certifier(SurfaceExtractor<Sample>& extractor, const SurfaceRequest& request, const Contour& surface,
            Progress& progress)
      : extractor_(extractor), request_(request), surface_(surface), progress_(progress) {
    full_ = request;
    full_.error = 0;
    full_.max_triangles.reset();
    full_.join = false;
    // Points keep their places of linear interpolation, and clipping moves none.
    full_.least_parameter = 0;
    full_.others_follow = true;
  }

  SurfaceCertificate run(int block_samples) {
    const Vec3 spacing = extractor_.spacing();
    const Box3 data = extractor_.data_box();
    const Box3 all = request_.region ? common(*request_.region, data) : data;
    least_spacing_ = std::min({spacing.x, spacing.y, spacing.z});
    Blocks blocks(all, block_samples * spacing);
    blocks.add(surface_.points, surface_.triangles);
    const ClosestPointTree tree(surface_.points, surface_.triangles);
    blocks.for_each([&](const Box3& box, const std::vector<Triangle>& triangles, double part) {
      progress_.step("certifying", part);
      add_block(box, all, triangles, tree);
    });
    return result_;
  }

 private:
  /// Measures a block: from the block's part of the full surface to the surface, and from the surface's part
  /// in the block to the full surface in the block and round it. The distance to all of the full surface is
  /// not greater than that to this part.
  void add_block(const Box3& box, const Box3& all, const std::vector<Triangle>& triangles,
                 const ClosestPointTree& tree) {
    bool is_first = true;
    for (double margin = 4 * least_spacing_;; margin *= 4) {
      const Box3 near = common(grown(box, margin), all);
      full_.region = near;
      const Contour full = extractor_.extract(full_).contour;
      if (is_first) add(measure(full.points, full.triangles, tree, box));
      is_first = false;
      if (triangles.empty()) return;
      DistanceBound bound = measure(surface_.points, triangles, {full.points, full.triangles}, box);
      const bool is_whole = near.contains(all.min) && near.contains(all.max);
      if (bound.upper > margin && !is_whole) continue;
      // Parts beyond the margin may be nearer than those that were found.
      if (!is_whole) bound.lower = std::min(bound.lower, margin);
      add(bound);
      return;
    }
  }

  void add(const DistanceBound& bound) {
    constexpr double kRoundOff = 1e-12;
    result_.certified = std::max(result_.certified, (1 + kRoundOff) * bound.upper);
    result_.found = std::max(result_.found, bound.lower);
  }

  DistanceBound measure(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                        const ClosestPointTree& to, const Box3& box) const {
    HausdorffOptions options;
    options.domain = box;
    // Distances less than the one found, or clearly less than the wanted one, need not be exact.
    options.accept = std::max({0.5 * request_.error, 0.01 * least_spacing_, result_.found});
    return directed_distance_bound({points, triangles}, to, options, progress_);
  }

  SurfaceExtractor<Sample>& extractor_;
  const SurfaceRequest& request_;
  const Contour& surface_;
  Progress& progress_;
  SurfaceRequest full_;
  double least_spacing_ = 1;
  SurfaceCertificate result_;
};

}  // namespace

SurfaceCertificate in_space(const VolumeGrid& grid, const SurfaceCertificate& in_frame) {
  // No singular value of the directions is greater than this, and their product is that of all three.
  const double greatest = grid.greatest_stretch();
  const auto& [i, j, k] = grid.directions;
  const double least = std::abs(dot(cross(i, j), k)) / (greatest * greatest);
  return {greatest * in_frame.certified, std::min(least, 1.0) * in_frame.found};
}

template <class Sample>
SurfaceCertificate certify_surface(SurfaceExtractor<Sample>& extractor, const SurfaceRequest& request,
                                   const Contour& surface, Progress& progress, int block_samples) {
  return Certifier<Sample>(extractor, request, surface, progress).run(block_samples);
}

template <class Sample>
CertifiedSurface extract_certified(SurfaceExtractor<Sample>& extractor, const SurfaceRequest& request,
                                   Progress& progress) {
  SurfaceRequest tried = request;
  tried.others_follow = true;
  for (;;) {
    CertifiedSurface result{extractor.extract(tried, progress), {}};
    result.certificate = certify_surface(extractor, request, result.surface.contour, progress);
    const double certified = result.certificate.certified;
    if (certified <= request.error || request.error == 0 || request.max_triangles) return result;
    if (!tried.join && tried.error == 0) return result;
    if (result.surface.max_error == 0) {
      tried.error = 0;
      tried.join = false;
    } else {
      constexpr double kLeast = 0.25, kMost = 0.7;
      tried.error *=
          std::isfinite(certified) ? std::clamp(0.8 * request.error / certified, kLeast, kMost) : kLeast;
    }
  }
}

#define ADAMAS_INSTANTIATE(Sample)                                                              \
  template SurfaceCertificate certify_surface(SurfaceExtractor<Sample>&, const SurfaceRequest&, \
                                              const Contour&, Progress&, int);                  \
  template CertifiedSurface extract_certified(SurfaceExtractor<Sample>&, const SurfaceRequest&, Progress&)
ADAMAS_INSTANTIATE(std::uint8_t);
ADAMAS_INSTANTIATE(std::uint16_t);
ADAMAS_INSTANTIATE(std::int16_t);
ADAMAS_INSTANTIATE(float);
#undef ADAMAS_INSTANTIATE

}  // namespace adamas::isosurface
