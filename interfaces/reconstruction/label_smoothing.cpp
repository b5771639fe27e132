#include "interfaces/reconstruction/label_smoothing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/label_faces.h"

namespace adamas {

namespace {

/// Taubin's steps: forward and back. Waves of more than some forty voxels, for which the two cancel, stay.
constexpr int kRounds = 24;
constexpr double kForward = 0.6, kBack = -0.611;

/// The faces between labels, with places that are smooth and the normals of these.
class SmoothFaces {
 public:
  explicit SmoothFaces(const MultiMaterialData& data) : faces_(data), sites_(data.grid) {
    const std::size_t count = faces_.size();
    neighbours_.resize(count);
    places_.resize(count);
    parallel_for(count, 4096, [&](std::size_t f) {
      neighbours_[f] = faces_.neighbours(f);
      places_[f] = faces_.middle(f);
    });
    next_ = places_;
    for (int round = 0; round < kRounds; ++round) {
      move(kForward);
      move(kBack);
    }
    parallel_for(count, 4096, [&](std::size_t f) { next_[f] = find_normal(f); });
  }

  [[nodiscard]] const LabelFaces& faces() const { return faces_; }
  [[nodiscard]] const Vec3& place(std::size_t face) const { return places_[face]; }
  /// Unit normal into the material whose face it is.
  [[nodiscard]] const Vec3& normal(std::size_t face) const { return next_[face]; }

 private:
  /// Moves faces towards the mean of their neighbours, but within half a voxel of where they belong.
  void move(double share) {
    parallel_for(places_.size(), 4096, [&](std::size_t f) {
      const auto& around = neighbours_[f];
      Vec3 sum;
      double count = 0;
      // Of two neighbours opposite each other both or none, so that planes stay planes at the border.
      for (std::size_t e = 0; e < 4; e += 2) {
        if (around[e] == LabelFaces::kNone || around[e + 1] == LabelFaces::kNone) continue;
        sum += places_[around[e]] + places_[around[e + 1]];
        count += 2;
      }
      Vec3 p = places_[f];
      if (count > 0) p += share * (1 / count * sum - p);
      const Vec3 middle = faces_.middle(f), half = 0.5 * sites_.cell(faces_.at(f).site).size();
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = std::clamp(p[axis], middle[axis] - half[axis], middle[axis] + half[axis]);
      next_[f] = p;
    });
    places_.swap(next_);
  }

  [[nodiscard]] Vec3 find_normal(std::size_t f) const {
    const auto& around = neighbours_[f];
    const int out = faces_.at(f).direction;
    const auto side = [&](std::size_t e) {
      return around[e] == LabelFaces::kNone ? places_[f] : places_[around[e]];
    };
    Vec3 axis;
    axis[out / 2] = out % 2 == 0 ? -1 : 1;
    const Vec3 normal = normalized(cross(side(0) - side(1), side(2) - side(3)));
    if (!(squared_norm(normal) > 0)) return axis;
    return out % 2 == 0 ? -normal : normal;
  }

  LabelFaces faces_;
  GridSites sites_;
  std::vector<std::array<std::uint32_t, 4>> neighbours_;
  std::vector<Vec3> places_, next_;  // normals take the room of `next_` in the end
};

}  // namespace

void smooth_label_values(const MultiMaterialData& data, SiteValues& values) {
  const SmoothFaces smooth(data);
  const LabelFaces& faces = smooth.faces();
  const GridSites sites(data.grid);
  parallel_for(data.grid.site_count(), 1024, [&](std::size_t site) {
    const std::span<SiteValues::Entry> own = values.at(site);
    if (own.empty()) return;
    const Vec3 centre = sites.position(site), size = sites.cell(site).size();
    const double near = 0.1 * squared_norm(size);
    for (SiteValues::Entry& entry : own) {
      const std::size_t label = values.material(entry.material).value;
      double sum = 0, weights = 0;
      const auto add = [&](std::size_t other, const std::array<int, 3>& offset) {
        if (data.labels[other] != label) return;
        for (int d = 0; d < LabelFaces::kDirections; ++d) {
          // Faces on the far side of the voxels round the site may be of another sheet.
          if (offset[static_cast<std::size_t>(d / 2)] == (d % 2 == 0 ? 1 : -1)) continue;
          const std::uint32_t face = faces.find(other, d);
          if (face == LabelFaces::kNone) continue;
          const Vec3 way = centre - smooth.place(face);
          const double w = 1 / ((squared_norm(way) + near) * (squared_norm(way) + near));
          sum += w * dot(smooth.normal(face), way);
          weights += w;
        }
      };
      add(site, {0, 0, 0});
      sites.for_each_neighbour(site, [&](std::size_t other, int di, int dj, int dk) {
        add(other, {di, dj, dk});
      });
      const double side = entry.fraction > 0 ? 1 : -1;
      entry.value =
          side * std::clamp(side * (weights > 0 ? sum / weights : 0), values.least(), values.greatest());
    }
  });
}

}  // namespace adamas
