#include "interfaces/reconstruction/label_smoothing.h"

#include <algorithm>
#include <array>
#include <bit>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "interfaces/reconstruction/grid_sites.h"

namespace adamas::interfaces {

namespace {

/// The number and the lengths of Taubin's steps, forward and back. Waves longer than about forty voxels, for
/// which the two cancel, stay.
constexpr int kRounds = 24;
constexpr double kForward = 0.6, kBack = -0.611;

/// The faces between voxels of different labels, each twice: once for the voxel on either side. The faces of
/// one side are a surface, in which each has a neighbour across each of its edges, but for edges on the
/// domain's boundary. At an edge where only two opposite ones of the four voxels share a label, the surface
/// bends round each of them.
class LabelFaces {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  /// A direction is 2 * axis, and one more where it points down the axis.
  static constexpr int kDirections = 6;
  struct Face {
    std::uint32_t site;  ///< the site to which the face belongs
    int direction;       ///< the direction out of the site's voxel
  };

  explicit LabelFaces(const MultiMaterialData& data);

  [[nodiscard]] std::size_t size() const { return faces_.size(); }
  [[nodiscard]] std::uint16_t label(std::size_t site) const { return labels_[site]; }
  [[nodiscard]] const Face& at(std::size_t face) const { return faces_[face]; }
  /// Returns the number of a site's face in a direction; kNone if the site has none there.
  [[nodiscard]] std::uint32_t find(std::size_t site, int direction) const {
    const unsigned mask = mask_[site], bit = 1u << static_cast<unsigned>(direction);
    if ((mask & bit) == 0) return kNone;
    return first_[site] + static_cast<std::uint32_t>(std::popcount(mask & (bit - 1)));
  }
  /// Returns the faces across the edges: those up and down the first other axis, in the cyclic order of axes,
  /// and those up and down the second.
  [[nodiscard]] std::array<std::uint32_t, 4> neighbours(std::size_t face) const;
  /// Returns the middle of a face; for data of points, it is halfway to the other site along its axis.
  [[nodiscard]] Vec3 middle(std::size_t face) const;

 private:
  /// Returns the site next to another one in a direction; the count of sites if there is none.
  [[nodiscard]] std::size_t step(std::size_t site, int direction) const;

  const MultiMaterialData& data_;
  SiteArray<std::uint16_t> labels_;
  GridSites sites_;
  std::array<std::size_t, 3> n_;
  std::vector<std::uint8_t> mask_;    // by site: bits of the directions of its faces
  std::vector<std::uint32_t> first_;  // by site: its first face
  std::vector<Face> faces_;
};

LabelFaces::LabelFaces(const MultiMaterialData& data)
    : data_(data),
      labels_(data.labels.dense()),
      sites_(data.grid),
      n_{data.grid.sites(0), data.grid.sites(1), data.grid.sites(2)} {
  const std::size_t count = data.grid.site_count();
  mask_.resize(count);
  parallel_for(count, 1 << 14, [&](std::size_t site) {
    unsigned mask = 0;
    for (int d = 0; d < kDirections; ++d) {
      const std::size_t other = step(site, d);
      if (other < count && label(other) != label(site)) mask |= 1u << static_cast<unsigned>(d);
    }
    mask_[site] = static_cast<std::uint8_t>(mask);
  });
  std::uint64_t total = 0;
  first_.resize(count);
  for (std::size_t site = 0; site < count; ++site) {
    first_[site] = static_cast<std::uint32_t>(total);
    total += static_cast<std::uint64_t>(std::popcount(unsigned{mask_[site]}));
    if (total >= kNone) fail("{}: expected fewer faces between labels, found too many", data.source);
  }
  faces_.resize(total);
  parallel_for(count, 1 << 14, [&](std::size_t site) {
    for (int d = 0; d < kDirections; ++d) {
      const std::uint32_t face = find(site, d);
      if (face != kNone) faces_[face] = {static_cast<std::uint32_t>(site), d};
    }
  });
}

std::size_t LabelFaces::step(std::size_t site, int direction) const {
  const auto axis = static_cast<std::size_t>(direction / 2);
  const std::size_t at = sites_.indices(site)[axis], stride = axis == 0   ? 1
                                                              : axis == 1 ? n_[0]
                                                                          : n_[0] * n_[1];
  if (direction % 2 == 0) return at + 1 < n_[axis] ? site + stride : n_[0] * n_[1] * n_[2];
  return at > 0 ? site - stride : n_[0] * n_[1] * n_[2];
}

std::array<std::uint32_t, 4> LabelFaces::neighbours(std::size_t face) const {
  const auto [site, out] = faces_[face];
  const std::uint16_t own = label(site);
  std::array<std::uint32_t, 4> result{};
  for (int e = 0; e < 4; ++e) {
    const int axis = (out / 2 + 1 + e / 2) % 3, along = 2 * axis + e % 2, back = along ^ 1;
    const std::size_t beside = step(site, along);
    auto& found = result[static_cast<std::size_t>(e)];
    if (beside >= mask_.size()) {
      found = kNone;
    } else if (label(beside) != own) {
      found = find(site, along);  // the face is on the same voxel
    } else {
      const std::size_t ahead = step(beside, out);
      found = label(ahead) == own ? find(ahead, back) : find(beside, out);
    }
  }
  return result;
}

Vec3 LabelFaces::middle(std::size_t face) const {
  const auto [site, out] = faces_[face];
  Vec3 result = sites_.position(site);
  const int axis = out / 2;
  const std::size_t i = sites_.indices(site)[static_cast<std::size_t>(axis)], low = out % 2 == 0 ? i : i - 1;
  const auto& x = data_.grid.nodes[static_cast<std::size_t>(axis)];
  result[axis] = data_.grid.centering == Centering::kCells ? x[low + 1] : 0.5 * (x[low] + x[low + 1]);
  return result;
}

/// The faces between labels with smoothed places and their normals.
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
  /// Returns the unit normal that points into the material to which the face belongs.
  [[nodiscard]] const Vec3& normal(std::size_t face) const { return next_[face]; }

 private:
  /// Moves faces towards the mean of their neighbours, by at most half a voxel from their original places.
  void move(double share) {
    parallel_for(places_.size(), 4096, [&](std::size_t f) {
      const auto& around = neighbours_[f];
      Vec3 sum;
      double count = 0;
      // Two opposite neighbours count only together, so that planes stay planes at the border.
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
  std::vector<Vec3> places_, next_;  // `next_` holds the normals in the end
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
        if (faces.label(other) != label) return;
        for (int d = 0; d < LabelFaces::kDirections; ++d) {
          // Faces on the far sides of the neighbouring voxels may belong to another sheet.
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
      entry.value = side * std::clamp(side * (weights > 0 ? sum / weights : 0), values.least_label_value(),
                                      values.greatest_value());
    }
  });
}

}  // namespace adamas::interfaces
