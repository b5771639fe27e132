#include "interfaces/reconstruction/interface_planes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "core/geometry/plane.h"
#include "interfaces/reconstruction/cut_volumes.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

namespace {

/// Gradients below this, in fractions per cell, are ignored.
constexpr double kLeastGradient = 0.05;
constexpr int kMostRounds = 12;
/// A normal has converged when neither it nor a neighbouring one has turned by more than this.
constexpr double kSettled = 1e-6;
/// A piece belongs to another surface if the cosine of the angle between the normals is at most this.
constexpr double kAlike = 0.7;

/// The part of a plane in its cell.
struct Piece {
  Vec3 middle;
  double area = 0;
};

Piece piece_of(const InterfacePlane& plane, const Vec3& site, const Box3& cell) {
  const std::vector<Vec3> polygon = clip_plane({site - plane.distance * plane.towards, plane.towards}, cell);
  Piece piece;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const double area = 0.5 * norm(cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]));
    piece.area += area;
    piece.middle += area / 3 * (polygon[0] + polygon[i - 1] + polygon[i]);
  }
  if (piece.area > 0) piece.middle *= 1 / piece.area;
  return piece;
}

/// Returns the normal of the plane fitted to weighted points, an eigenvector of their covariance; zero if
/// they lie along a line.
Vec3 fitted_normal(const std::vector<std::pair<Vec3, double>>& points, const Vec3& about) {
  Eigen::Matrix3d sums = Eigen::Matrix3d::Zero();
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  double weights = 0;
  for (const auto& [p, w] : points) {
    const Eigen::Vector3d d(p.x - about.x, p.y - about.y, p.z - about.z);
    sums += w * d * d.transpose();
    first += w * d;
    weights += w;
  }
  if (!(weights > 0)) return {};
  sums -= first * first.transpose() / weights;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> found(sums);
  const Eigen::Vector3d& by = found.eigenvalues();
  if (!(by[1] > 0.02 * by[2])) return {};
  const Eigen::Vector3d n = found.eigenvectors().col(0);
  return {n[0], n[1], n[2]};
}

/// Computes the planes of mixed sites' entries.
class PlaneFit {
 public:
  PlaneFit(const MultiMaterialData& data, const SiteValues& values)
      : data_(data), values_(values), sites_(data.grid), numbers_(values.entries().size()) {
    for (const std::uint32_t site : values.mixed_sites()) {
      const Entry* twin = nullptr;
      const Entry* first = lesser_of_two(site, &twin);
      if (first != nullptr && has_plane(*first, *twin)) numbers_.add(values.index(*twin));
      for_each_entry_at(site, [&](std::size_t, const Entry& entry) {
        numbers_.add(values.index(entry));
        own_.push_back({site, static_cast<std::uint32_t>(values.index(entry))});
      });
    }
    numbers_.number_all();
    planes_.resize(numbers_.size());
    pieces_.resize(numbers_.size());
  }

  InterfacePlanes run() && {
    next_ = planes_;
    for_each_entry([&](std::size_t site, const Entry& entry) {
      const Vec3 size = sites_.cell(site).size();
      const Vec3 g = fraction_gradient(sites_, site, data_.fractions[values_.material(entry.material)]);
      if (norm(g) * std::min({size.x, size.y, size.z}) >= kLeastGradient) place(site, entry, normalized(g));
    });
    std::vector<double> turned(planes_.size(), 0);
    last_ = turned;
    for_each_entry([&](std::size_t, const Entry& entry) { last_[index(entry)] = 1; });
    for (int round = 0; round < kMostRounds; ++round) {
      planes_ = next_;
      for_each_entry([&](std::size_t site, const Entry& entry) {
        const std::size_t e = index(entry);
        if (planes_[e].known() && last_[e] > kSettled)
          pieces_[e] = piece_of(planes_[e], sites_.position(site), sites_.cell(site));
      });
      for_each_entry([&](std::size_t site, const Entry& entry) { turned[index(entry)] = turn(site, entry); });
      last_.swap(turned);
      if (*std::max_element(last_.begin(), last_.end()) <= kSettled) break;
    }
    // If two materials share a cell, one has the plane of the other, reversed.
    for (const std::uint32_t site : values_.mixed_sites()) {
      const Entry* twin = nullptr;
      const Entry* first = lesser_of_two(site, &twin);
      if (first != nullptr && has_plane(*first, *twin))
        next_[index(*twin)] = {-next_[index(*first)].towards, -next_[index(*first)].distance};
    }
    return {std::move(numbers_), std::move(next_)};
  }

 private:
  using Entry = SiteValues::Entry;

  /// Returns the index of an entry in arrays; 0 for all entries without planes.
  [[nodiscard]] std::size_t index(const Entry& entry) const { return numbers_.number(values_.index(entry)); }

  /// Returns the entry with the lesser fraction, which is the more exact number, if exactly two materials
  /// share a cell; null otherwise. Sets `other` to the second entry.
  const Entry* lesser_of_two(std::size_t site, const Entry** other) const {
    std::array<const Entry*, 2> two{};
    std::size_t count = 0;
    for (const Entry& entry : values_.at(site)) {
      if (entry.fraction <= 0) continue;
      if (count < 2) two[count] = &entry;
      ++count;
    }
    if (count != 2) return nullptr;
    if (two[1]->fraction < two[0]->fraction) std::swap(two[0], two[1]);
    *other = two[1];
    return two[0];
  }

  /// Calls visit(site, entry) for the entries that need a plane of their own.
  template <class Visit>
  void for_each_entry(const Visit& visit) const {
    parallel_for(own_.size(), 128,
                 [&](std::size_t n) { visit(own_[n].site, values_.entries()[own_[n].entry]); });
  }
  template <class Visit>
  void for_each_entry_at(std::size_t site, const Visit& visit) const {
    const Entry* twin = nullptr;
    if (const Entry* first = lesser_of_two(site, &twin)) {
      if (has_plane(*first, *twin)) visit(site, *first);
      return;
    }
    for (const Entry& entry : values_.at(site)) {
      if (!entry.is_pure() && entry.width == 0) visit(site, entry);
    }
  }

  /// Returns whether two entries that share a cell have a plane, which belongs to the first one.
  [[nodiscard]] bool has_plane(const Entry& first, const Entry& twin) const {
    return first.width == 0 || values_.is_wall(twin);
  }

  void place(std::size_t site, const Entry& entry, const Vec3& towards) {
    const Box3 cell = sites_.cell(site);
    next_[index(entry)] = {towards,
                           plane_distance(towards, cell.size(), static_cast<double>(entry.fraction)) +
                               dot(towards, sites_.position(site) - cell.center())};
  }

  /// Returns whether a plane or one beside it turned in the last round.
  [[nodiscard]] bool has_moved(std::size_t site, const Entry& entry) const {
    bool moved = last_[index(entry)] > kSettled;
    sites_.for_each_neighbour(site, [&](std::size_t other, int, int, int) {
      if (moved) return;
      const Entry* twin = nullptr;
      const Entry* first = lesser_of_two(other, &twin);
      for (const Entry& there : values_.at(other)) {
        if (there.material == entry.material)
          moved = last_[index(first != nullptr && &there == twin ? *first : there)] > kSettled;
      }
    });
    return moved;
  }

  /// Turns a plane to fit those round it; returns the change of its normal.
  double turn(std::size_t site, const Entry& entry) {
    const InterfacePlane plane = planes_[index(entry)];
    if (!plane.known() || !has_moved(site, entry)) return 0;
    thread_local std::vector<std::pair<Vec3, double>> points;
    const Piece own = pieces_[index(entry)];
    points.assign(1, {own.middle, own.area});
    Vec3 mean;
    sites_.for_each_neighbour(site, [&](std::size_t other, int, int, int) {
      const Entry* twin = nullptr;
      const Entry* first = lesser_of_two(other, &twin);
      for (const Entry& there : values_.at(other)) {
        if (there.material != entry.material || there.is_pure()) continue;
        const bool turned = first != nullptr && &there == twin;
        const std::size_t o = index(turned ? *first : there);
        const Vec3 normal = turned ? -planes_[o].towards : planes_[o].towards;
        if (!planes_[o].known() || dot(normal, plane.towards) <= kAlike) continue;
        points.emplace_back(pieces_[o].middle, pieces_[o].area);
        mean += pieces_[o].area * normal;
      }
    });
    Vec3 normal = fitted_normal(points, own.middle);
    if (squared_norm(normal) == 0) normal = normalized(mean);
    if (dot(normal, plane.towards) < 0) normal = -normal;
    if (dot(normal, plane.towards) <= kAlike) return 0;
    place(site, entry, normal);
    return distance(normal, plane.towards);
  }

  const MultiMaterialData& data_;
  const SiteValues& values_;
  GridSites sites_;
  NumberedEntries numbers_;  // of the entries with planes
  struct Own {
    std::uint32_t site, entry;
  };
  std::vector<Own> own_;  // the entries that need a plane of their own
  std::vector<InterfacePlane> planes_, next_;
  std::vector<Piece> pieces_;
  std::vector<double> last_;  // the changes of normals in the last round
};

}  // namespace

std::array<double, 3> plane_sides(const Vec3& towards, const Vec3& size) {
  std::array<double, 3> m{std::abs(towards.x) * size.x, std::abs(towards.y) * size.y,
                          std::abs(towards.z) * size.z};
  std::sort(m.begin(), m.end());
  return m;
}

double plane_distance(const Vec3& towards, const Vec3& size, double f) {
  const std::array<double, 3> m = plane_sides(towards, size);
  // The root is found by the secant method in which the value at a retained end is halved (Illinois).
  double low = -0.5 * (m[0] + m[1] + m[2]), high = -low, below = -f, above = 1 - f, middle = 0;
  int kept = 0;
  for (int step = 0; step < 60 && high - low > 1e-15 * size.x; ++step) {
    middle = low + (high - low) * below / (below - above);
    const double value = box_volume_below(m, middle) - f;
    if (std::abs(value) < 1e-15) break;
    if (value < 0) {
      low = middle, below = value;
      if (kept == -1) above *= 0.5;
      kept = -1;
    } else {
      high = middle, above = value;
      if (kept == 1) below *= 0.5;
      kept = 1;
    }
  }
  return middle;
}

double part_behind_plane(const Vec3& towards, const Vec3& size, double distance) {
  return box_volume_below(plane_sides(towards, size), distance);
}

Vec3 fraction_gradient(const GridSites& sites, std::size_t site, std::span<const float> fractions) {
  const auto ways = sites.ways_round<1>(site);
  const auto value = static_cast<double>(fractions[site]);
  // The weight of a neighbour is the product of weights along the axes, 1 and 2 in the middle, and so the
  // sums of products of its coordinates are products of sums along the axes.
  std::array<std::array<double, 3>, 3> along{};  // of 1, x and x^2
  std::array<bool, 27> known{};
  std::array<double, 27> differences{};
  sites.for_each_within(site, 1, [&](std::size_t other, int di, int dj, int dk) {
    const auto n = static_cast<std::size_t>(di + 1 + 3 * (dj + 1) + 9 * (dk + 1));
    known[n] = true;
    differences[n] = static_cast<double>(fractions[other]) - value;
  });
  constexpr std::array<std::size_t, 3> kStride{1, 3, 9};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!known[13 - kStride[a] + i * kStride[a]]) continue;
      const double x = ways.along(a, static_cast<int>(i) - 1), w = i == 1 ? 2 : 1;
      along[a][0] += w, along[a][1] += w * x, along[a][2] += w * x * x;
    }
  }
  // The sums of the differences times the coordinate along an axis, for one axis after another.
  Vec3 b;
  for (std::size_t k = 0; k < 3; ++k) {
    double plane = 0;
    Vec3 of_plane;
    for (std::size_t j = 0; j < 3; ++j) {
      const double* d = differences.data() + 3 * j + 9 * k;
      const double row = d[0] + 2 * d[1] + d[2], w = j == 1 ? 2 : 1;
      of_plane.x += w * (ways.along(0, -1) * d[0] + ways.along(0, 1) * d[2]);
      of_plane.y += w * ways.along(1, static_cast<int>(j) - 1) * row;
      plane += w * row;
    }
    const double w = k == 1 ? 2 : 1;
    b += w * Vec3{of_plane.x, of_plane.y, ways.along(2, static_cast<int>(k) - 1) * plane};
  }
  const auto sum = [&](std::size_t x, std::size_t y, std::size_t z) {
    return along[0][x] * along[1][y] * along[2][z];
  };
  std::array<double, 6> a{sum(2, 0, 0), sum(0, 2, 0), sum(0, 0, 2),
                          sum(1, 1, 0), sum(1, 0, 1), sum(0, 1, 1)};  // xx, yy, zz, xy, xz, yz
  // Axes with one site only do not count.
  for (std::size_t i = 0; i < 3; ++i) {
    if (a[i] == 0) a[i] = 1;
  }
  const Vec3 x{a[0], a[3], a[4]}, y{a[3], a[1], a[5]}, z{a[4], a[5], a[2]};
  const double det = dot(x, cross(y, z));
  return (1 / det) * (b.x * cross(y, z) + b.y * cross(z, x) + b.z * cross(x, y));
}

InterfacePlanes interface_planes(const MultiMaterialData& data, const SiteValues& values) {
  return PlaneFit(data, values).run();
}

}  // namespace adamas::interfaces
