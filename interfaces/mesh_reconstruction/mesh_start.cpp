#include "interfaces/mesh_reconstruction/mesh_start.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/median.h"
#include "core/base/parallel.h"
#include "interfaces/reconstruction/cut_volumes.h"
#include "interfaces/reconstruction/normal_distribution.h"

namespace adamas::interfaces {

namespace {

using Index = MeshSubdivision::Index;
using Entry = MeshValues::Entry;

/// Fractions show the width of a step if they are between this and the rest of 1.
constexpr double kShown = 0.1;
/// Widths are found from at most so many cells.
constexpr std::size_t kMostShown = 20000;
constexpr std::uint32_t kNone = 0xffffffffu;
/// The greatest width.
constexpr double kWidest = 3;
/// Values of blurred materials are clipped at this many widths.
constexpr double kFarthest = 3.5;
/// Planes are continued to so many layers of cells beside mixed ones.
constexpr int kLayers = 3;
/// Normals of planes are found again from distances so often.
constexpr int kNormalRounds = 3;

/// The plane of a material in a mixed cell: distances are positive inside.
struct CellPlane {
  Vec3 normal;          ///< of unit length, towards the material
  double distance = 0;  ///< that of the cell's centre
};

class Start {
 public:
  Start(const MeshWalls& walls, const MeshFilms& films, MeshValues& values)
      : values_(values),
        mesh_(values.subdivision().mesh()),
        subdivision_(values.subdivision()),
        walls_(walls),
        films_(films) {}

  Steps steps() {
    find_gradients_of_fractions();
    Steps result;
    result.extents = find_extents();
    result.widths = find_widths(result.extents);
    return result;
  }

  void run(const std::vector<double>& widths, const std::vector<double>& extents) {
    find_gradients_of_fractions();
    // Cells of one material have one value, from which points beside them are interpolated.
    for (std::size_t c = 0; c < mesh_.cell_count(); ++c) {
      for (Entry& entry : values_.at(c)) entry.value = 4 * values_.size(c);
    }
    for (int round = 0;; ++round) {
      find_planes(widths);
      for (int layer = 0; layer < kLayers; ++layer) continue_planes(widths);
      set_values(widths, extents);
      films_.set_values(values_);
      if (round == kNormalRounds) return;
      // The gradients of distances are better normals than those of fractions.
      find_gradients([this](Index cell, const Entry& entry) { return value(cell, entry.material); });
    }
  }

 private:
  static bool is_mixed(const Entry& entry) { return entry.fraction > 0 && entry.fraction < 1; }

  void find_gradients_of_fractions() {
    find_gradients([this](Index cell, const Entry& entry) { return fraction(cell, entry.material); });
  }

  void set_values(const std::vector<double>& widths, const std::vector<double>& extents) {
    const std::vector<Index>& active = values_.active_cells();
    const std::vector<std::uint32_t> firsts = first_active_entries(values_);
    std::vector<double> found(firsts.back());
    parallel_for(active.size(), 64, [&](std::size_t n) {
      const std::span<const Entry> own = std::as_const(values_).at(active[n]);
      for (std::size_t e = 0; e < own.size(); ++e)
        found[firsts[n] + e] = value_of(active[n], own[e], widths[own[e].material] * extents[firsts[n] + e]);
    });
    for (std::size_t n = 0; n < active.size(); ++n) {
      const std::span<Entry> own = values_.at(active[n]);
      for (std::size_t e = 0; e < own.size(); ++e) own[e].value = found[firsts[n] + e];
    }
  }

  /// The extents of cells along gradients, in the mean of the cells round them: blur is no property of single
  /// cells.
  [[nodiscard]] std::vector<double> find_extents() const {
    const std::vector<Index>& active = values_.active_cells();
    const std::vector<std::uint32_t> firsts = first_active_entries(values_);
    std::vector<double> own_extents(firsts.back(), 0), extents(firsts.back());
    std::vector<std::uint32_t> place(mesh_.cell_count(), kNone);
    for (std::uint32_t n = 0; n < active.size(); ++n) place[active[n]] = n;
    parallel_for(active.size(), 64, [&](std::size_t n) {
      const Index c = active[n];
      for (std::size_t e = 0; firsts[n] + e < firsts[n + 1]; ++e) {
        if (!gradients_[c].empty() && squared_norm(gradients_[c][e]) > 0)
          own_extents[firsts[n] + e] = values_.extent(c, normalized(gradients_[c][e]));
      }
    });
    parallel_for(active.size(), 64, [&](std::size_t n) {
      const Index c = active[n];
      thread_local std::vector<Index> ring;
      const std::array<Index, 1> self{c};
      subdivision_.find_ring(self, ring);
      const std::span<const Entry> own = std::as_const(values_).at(c);
      for (std::size_t e = 0; e < own.size(); ++e) {
        double sum = 0;
        int count = 0;
        for (const Index other : ring) {
          if (place[other] == kNone) continue;
          const std::span<const Entry> there = std::as_const(values_).at(other);
          const auto found = std::ranges::find(there, own[e].material, &Entry::material);
          if (found == there.end()) continue;
          const double extent =
              own_extents[firsts[place[other]] + static_cast<std::size_t>(found - there.begin())];
          sum += extent;
          count += extent > 0 ? 1 : 0;
        }
        extents[firsts[n] + e] = count > 0 ? sum / count : values_.size(c);
      }
    });
    return extents;
  }

  /// Finds the gradients of what value_of(cell, entry) says, at mixed entries, from the cells round, by least
  /// squares.
  template <class ValueOf>
  void find_gradients(ValueOf&& value_of) {
    gradients_.assign(mesh_.cell_count(), {});
    const std::vector<Index>& active = values_.active_cells();
    parallel_for(active.size(), 64, [&](std::size_t n) {
      const Index c = active[n];
      const std::span<const Entry> own = std::as_const(values_).at(c);
      if (std::ranges::none_of(own, is_mixed)) return;
      thread_local std::vector<Index> ring;
      const std::array<Index, 1> self{c};
      subdivision_.find_ring(self, ring);
      Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
      std::vector<Eigen::Vector3d> right(own.size(), Eigen::Vector3d::Zero());
      for (const Index other : ring) {
        if (other == c || walls_.fills(other)) continue;
        const Vec3 d = mesh_.cell_center(other) - mesh_.cell_center(c);
        const Eigen::Vector3d row(d.x, d.y, d.z);
        const double w = 1 / squared_norm(d);
        normal += w * row * row.transpose();
        for (std::size_t e = 0; e < own.size(); ++e)
          right[e] += w * (value_of(other, own[e]) - value_of(c, own[e])) * row;
      }
      normal.diagonal().array() += 1e-9 * normal.trace();
      const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
      gradients_[c].resize(own.size());
      for (std::size_t e = 0; e < own.size(); ++e) {
        const Eigen::Vector3d g = solver.solve(right[e]);
        gradients_[c][e] = {g[0], g[1], g[2]};
      }
    });
  }

  [[nodiscard]] double fraction(Index cell, std::uint16_t material) const {
    for (const Entry& entry : std::as_const(values_).at(cell)) {
      if (entry.material == material) return static_cast<double>(entry.fraction);
    }
    return 0;
  }

  [[nodiscard]] double value(Index cell, std::uint16_t material) const {
    for (const Entry& entry : std::as_const(values_).at(cell)) {
      if (entry.material == material) return entry.value;
    }
    return -4 * values_.size(cell);
  }

  /// The widths of steps: the median of those with which the gradients found are those of a plane step.
  [[nodiscard]] std::vector<double> find_widths(const std::vector<double>& extents) const {
    struct Shown {
      Index cell;
      std::size_t entry;
      double extent;
    };
    std::vector<std::vector<Shown>> shown(values_.material_count());
    const std::vector<std::uint32_t> firsts = first_active_entries(values_);
    for (std::size_t n = 0; n < values_.active_cells().size(); ++n) {
      const Index c = values_.active_cells()[n];
      const std::span<const Entry> own = std::as_const(values_).at(c);
      for (std::size_t e = 0; e < own.size() && !gradients_[c].empty(); ++e) {
        // The steps of a film are those of both its sides.
        if (own[e].fraction >= kShown && own[e].fraction <= 1 - kShown && !films_.holds(c))
          shown[own[e].material].push_back({c, e, extents[firsts[n] + e]});
      }
    }
    std::vector<double> result;
    for (const std::vector<Shown>& of_one : shown) {
      const std::size_t stride = of_one.size() / kMostShown + 1;
      std::vector<double> widths((of_one.size() + stride - 1) / stride);
      parallel_for(widths.size(), 32, [&](std::size_t n) {
        const auto& [c, e, extent] = of_one[n * stride];
        widths[n] = width_at(c, std::as_const(values_).at(c)[e], gradients_[c][e], extent);
      });
      result.push_back(widths.empty() ? 0 : std::min(median(widths), kWidest));
    }
    return result;
  }

  /// Returns the width, in extents of the cell, of a plane step whose gradient over the cells round, as
  /// find_gradients() finds it, is as steep as that found.
  [[nodiscard]] double width_at(Index c, const Entry& entry, const Vec3& gradient, double size) const {
    thread_local std::vector<Index> ring;
    const std::array<Index, 1> self{c};
    subdivision_.find_ring(self, ring);
    const Vec3 towards = normalized(gradient);
    const double slope = norm(gradient) * size, at = normal_quantile(static_cast<double>(entry.fraction));
    std::vector<std::array<double, 2>> round;  // heights along the gradient, with weights
    double squares = 0;
    for (const Index other : ring) {
      if (other == c || walls_.fills(other)) continue;
      const Vec3 d = mesh_.cell_center(other) - mesh_.cell_center(c);
      const double height = dot(d, towards) / size, weight = size * size / squared_norm(d);
      round.push_back({height, weight});
      squares += weight * height * height;
    }
    const auto slope_of = [&](double width) {
      double sum = 0;
      for (const auto& [height, weight] : round)
        sum +=
            weight * height * (normal_probability(at + height / width) - static_cast<double>(entry.fraction));
      return sum / squares;
    };
    double narrow = 0.02, wide = 2 * kWidest;
    for (int step = 0; step < 30; ++step) {
      const double width = 0.5 * (narrow + wide);
      (slope_of(width) > slope ? narrow : wide) = width;
    }
    return narrow;
  }

  /// Finds the planes that cut off the fractions of mixed cells.
  void find_planes(const std::vector<double>& widths) {
    planes_.assign(mesh_.cell_count(), {});
    const std::vector<Index>& active = values_.active_cells();
    parallel_for(active.size(), 16, [&](std::size_t n) {
      const Index c = active[n];
      const std::span<const Entry> own = std::as_const(values_).at(c);
      planes_[c].resize(own.size());
      for (std::size_t e = 0; e < own.size() && !gradients_[c].empty(); ++e) {
        const double slope = norm(gradients_[c][e]);
        if (!is_mixed(own[e]) || !(slope > 0) || widths[own[e].material] > 0 || !(mesh_.cell_volume(c) > 0))
          continue;
        const Vec3 towards = (1 / slope) * gradients_[c][e];
        planes_[c][e] = CellPlane{towards, cut(c, towards, static_cast<double>(own[e].fraction))};
      }
    });
  }

  /// Continues planes to the cells beside those that have them: those of cells that one material fills or is
  /// absent from are the mean of those round them.
  void continue_planes(const std::vector<double>& widths) {
    struct Found {
      Index cell;
      std::size_t entry;
      CellPlane plane;
    };
    const std::vector<Index>& active = values_.active_cells();
    const std::vector<Found> all = parallel_collect<Found>(
        active.size(), 64, [&](std::size_t begin, std::size_t end, std::vector<Found>& list) {
          std::vector<Index> ring;
          for (std::size_t n = begin; n < end; ++n) {
            const Index c = active[n];
            const std::span<const Entry> own = std::as_const(values_).at(c);
            bool known = false;
            for (std::size_t e = 0; e < own.size(); ++e) {
              if (is_mixed(own[e]) || planes_[c][e] || widths[own[e].material] > 0) continue;
              if (!std::exchange(known, true)) subdivision_.find_ring(std::array{c}, ring);
              if (const auto plane = continued_plane(c, own[e].material, ring))
                list.push_back({c, e, *plane});
            }
          }
        });
    for (const Found& found : all) planes_[found.cell][found.entry] = found.plane;
  }

  /// Returns the mean of the planes of a material in cells of the ring, seen from a cell's centre.
  [[nodiscard]] std::optional<CellPlane> continued_plane(Index c, std::uint16_t material,
                                                         const std::vector<Index>& ring) const {
    Vec3 normal;
    double sum = 0, weights = 0;
    for (const Index other : ring) {
      if (planes_[other].empty()) continue;
      const std::span<const Entry> there = std::as_const(values_).at(other);
      const auto found = std::ranges::find(there, material, &Entry::material);
      if (found == there.end()) continue;
      const std::optional<CellPlane>& plane = planes_[other][static_cast<std::size_t>(found - there.begin())];
      if (!plane) continue;
      const Vec3 d = mesh_.cell_center(c) - mesh_.cell_center(other);
      const double squared = squared_norm(d), w = 1 / (squared * squared);
      sum += w * (plane->distance + dot(plane->normal, d));
      normal += w * plane->normal;
      weights += w;
    }
    if (!(weights > 0) || !std::isfinite(weights)) return {};
    return CellPlane{normalized(normal), sum / weights};
  }

  /// Returns the distance of a cell's centre from the plane that cuts off this part of the cell on the side
  /// to which `towards` points.
  [[nodiscard]] double cut(Index cell, const Vec3& towards, double part) const {
    struct Corners {
      std::array<double, 4> heights;
      double volume;
    };
    thread_local std::vector<Corners> tetrahedra;
    tetrahedra.clear();
    double low = 0, high = 0;
    const Vec3 center = mesh_.cell_center(cell);
    subdivision_.for_each_tetrahedron(cell, [&](const std::array<Index, 4>& corners) {
      Corners found{{}, subdivision_.volume(corners) / mesh_.cell_volume(cell)};
      for (std::size_t i = 0; i < 4; ++i) {
        found.heights[i] = dot(towards, subdivision_.position(corners[i]) - center);
        low = std::min(low, found.heights[i]);
        high = std::max(high, found.heights[i]);
      }
      tetrahedra.push_back(found);
    });
    // The part above the height -d grows with d from 0 to 1.
    double less = -high, more = -low;
    for (int step = 0; step < 40 && more - less > 1e-12 * (high - low); ++step) {
      const double d = 0.5 * (less + more);
      double above = 0;
      for (const Corners& t : tetrahedra)
        above +=
            t.volume *
            positive_part({t.heights[0] + d, t.heights[1] + d, t.heights[2] + d, t.heights[3] + d}).volume;
      (above < part ? less : more) = d;
    }
    return 0.5 * (less + more);
  }

  /// Returns the value of an entry of an active cell. `width`: that of a blurred step as a length, or 0.
  [[nodiscard]] double value_of(Index c, const Entry& entry, double width) const {
    const double size = values_.size(c);
    if (width > 0) {
      const double f = std::clamp(static_cast<double>(entry.fraction), 1e-12, 1 - 1e-12);
      return width * std::clamp(normal_quantile(f), -kFarthest, kFarthest);
    }
    const std::span<const Entry> own = std::as_const(values_).at(c);
    const auto place = static_cast<std::size_t>(&entry - own.data());
    if (is_mixed(entry)) {
      if (planes_[c][place]) return planes_[c][place]->distance;
      return (static_cast<double>(entry.fraction) - 0.5) * size;
    }
    const double side = entry.fraction > 0 ? 1 : -1;
    if (const std::optional<CellPlane>& plane = planes_[c][place])
      return side * std::max(side * plane->distance, inner_radius(mesh_, c));
    // Interfaces along faces of cells leave no mixed cell: they are halfway between centres.
    thread_local std::vector<Index> ring, wider;
    ring.assign(1, c);
    for (int layer = 0; layer < kLayers; ++layer) {
      subdivision_.find_ring(ring, wider);
      ring.swap(wider);
    }
    return side * nearest_other(c, entry, ring);
  }

  /// Returns half the distance from a cell's centre to that of the nearest cell, among those of the ring, on
  /// the other side of the material's boundary.
  [[nodiscard]] double nearest_other(Index c, const Entry& entry, const std::vector<Index>& ring) const {
    double least = 8 * values_.size(c);
    for (const Index other : ring) {
      if ((fraction(other, entry.material) > 0.5) == (entry.fraction > 0.5f)) continue;
      const double d = distance(mesh_.cell_center(c), mesh_.cell_center(other));
      least = std::min(least, d - 0.5 * values_.size(other));
    }
    return std::max(least, inner_radius(mesh_, c));
  }

  MeshValues& values_;
  const PolyhedralMesh& mesh_;
  const MeshSubdivision& subdivision_;
  const MeshWalls& walls_;
  const MeshFilms& films_;
  std::vector<std::vector<Vec3>> gradients_;  // by cell and entry; empty for cells without mixed entries
  std::vector<std::vector<std::optional<CellPlane>>> planes_;  // in the same way
};

}  // namespace

Steps find_steps(const MeshWalls& walls, const MeshFilms& films, MeshValues& values) {
  return Start(walls, films, values).steps();
}

void set_start_values(const std::vector<double>& widths, const std::vector<double>& extents,
                      const MeshFilms& films, MeshWalls& walls, MeshValues& values) {
  Start(walls, films, values).run(widths, extents);
  walls.keep_distances(values);
  if (std::ranges::any_of(widths, [](double width) { return width > 0; })) walls.set_values(values);
}

}  // namespace adamas::interfaces
