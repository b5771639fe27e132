#include "interfaces/reconstruction/sheet_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "interfaces/reconstruction/cut_volumes.h"

namespace adamas {

namespace {

/// How far cells count, round the window's middle, and beyond a layer's: so that another one two cells away
/// does not disturb.
constexpr double kRadius = 2.5, kFarthest = 2.0;
/// A layer's spread along its normal in relation to that across, and beyond that of an even layer.
constexpr double kFlat = 0.5, kBlurred = 0.2;
/// Layers thicker than the greatest need no care, and thinner ones are traces.
constexpr double kThickest = 1.5, kThinnest = 0.03;
/// The middle of a layer is no farther away from a cell that it cuts.
constexpr double kMostOffset = 1.2;
/// What a fit may leave, as a part of the fractions' and of a cell.
constexpr double kMostRelative = 0.5, kMostLeft = 0.15;
/// The weight of cells on either side of a layer at least.
constexpr double kLeastSeen = 0.1;
constexpr int kRounds = 6;

struct Sides {
  std::array<double, 3> m;
  explicit Sides(const Vec3& n) : m{std::abs(n.x), std::abs(n.y), std::abs(n.z)} {
    std::sort(m.begin(), m.end());
  }
};

double weight(const Vec3& d) {
  const double u = 1 - squared_norm(d) / (kRadius * kRadius);
  return u > 0 ? u * u : 0;
}

/// Two unit vectors that are at right angles to a third, and to each other.
std::array<Vec3, 2> across(const Vec3& n) {
  const Vec3 axis = std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = normalized(cross(n, axis));
  return {u, cross(n, u)};
}

}  // namespace

double Slab::part_of_cell(const Vec3& centre) const {
  const Sides sides(normal);
  const double y = height(centre);
  return box_volume_below(sides.m, 0.5 * thickness - y) - box_volume_below(sides.m, -0.5 * thickness - y);
}

std::optional<Slab> guess_sheet(const SheetWindow& window) {
  Vec3 middle;
  double sum = 0;
  const auto gather = [&](auto&& visit) {
    for (std::size_t c = 0; c < SheetWindow::kCells; ++c) {
      if (window.fraction[c] <= 0) continue;
      const Vec3 p = SheetWindow::place(c) - middle;
      const double w = weight(p) * static_cast<double>(window.fraction[c]);
      if (w > 0) visit(p, w);
    }
  };
  // The middle moves to where the layer is, for what lies on one side of the window only would seem nearer.
  for (int round = 0; round < 3; ++round) {
    Vec3 first;
    sum = 0;
    gather([&](const Vec3& p, double w) { first += w * p, sum += w; });
    if (!(sum > 0)) return {};
    middle += (1 / sum) * first;
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  gather([&](const Vec3& p, double w) {
    const Eigen::Vector3d d(p.x, p.y, p.z);
    spread += w / sum * d * d.transpose();
  });
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> found(spread);
  const Eigen::Vector3d& by = found.eigenvalues();
  if (by[0] > kFlat * by[1]) return {};
  const Eigen::Vector3d n = found.eigenvectors().col(0);
  Slab slab{{n[0], n[1], n[2]}, 0, 0};
  slab.offset = dot(slab.normal, middle);
  // The thickness is what the volume near the middle says.
  double held = 0, area = 0;
  const Sides sides(slab.normal);
  for (std::size_t c = 0; c < SheetWindow::kCells; ++c) {
    const Vec3 p = SheetWindow::place(c);
    const double w = weight(p), y = slab.height(p);
    if (w == 0 || window.known[c] == 0 || std::abs(y) > kFarthest) continue;
    held += w * static_cast<double>(window.fraction[c]);
    area += w * (box_volume_below(sides.m, 0.05 - y) - box_volume_below(sides.m, -0.05 - y)) / 0.1;
  }
  if (!(area > 0)) return {};
  slab.thickness = held / area;
  if (slab.thickness > 1.3 * kThickest || slab.thickness < 0.5 * kThinnest) return {};
  const double even = (slab.thickness * slab.thickness + 1) / 12;
  if (by[0] > even + kBlurred) return {};
  return slab;
}

std::optional<Slab> fit_sheet(const SheetWindow& window, const Slab& guess) {
  Slab slab = guess;
  struct Sample {
    Vec3 place;
    double weight, fraction;
  };
  std::array<Sample, SheetWindow::kCells> samples{};
  std::size_t count = 0;
  for (std::size_t c = 0; c < SheetWindow::kCells; ++c) {
    const Vec3 p = SheetWindow::place(c);
    const double w = weight(p);
    if (w > 0 && window.known[c] != 0 && std::abs(slab.height(p)) <= kFarthest)
      samples[count++] = {p, w, static_cast<double>(window.fraction[c])};
  }
  if (count < 12) return {};
  // A turn about either direction across, a move, and a growth.
  for (int round = 0; round < kRounds; ++round) {
    constexpr double kStep = 1e-4;
    const auto [u, v] = across(slab.normal);
    std::array<Slab, 4> moved{slab, slab, slab, slab};
    moved[0].normal = normalized(slab.normal + kStep * u);
    moved[1].normal = normalized(slab.normal + kStep * v);
    moved[2].offset += kStep;
    moved[3].thickness += kStep;
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    Eigen::Vector4d b = Eigen::Vector4d::Zero();
    for (std::size_t s = 0; s < count; ++s) {
      const Sample& sample = samples[s];
      const double part = slab.part_of_cell(sample.place);
      Eigen::Vector4d g;
      for (int i = 0; i < 4; ++i)
        g[i] = (moved[static_cast<std::size_t>(i)].part_of_cell(sample.place) - part) / kStep;
      a += sample.weight * g * g.transpose();
      b += sample.weight * (sample.fraction - part) * g;
    }
    a.diagonal().array() += 1e-3;
    const Eigen::Vector4d x = a.ldlt().solve(b);
    const auto limited = [](double by, double most) { return std::clamp(by, -most, most); };
    slab.normal = normalized(slab.normal + limited(x[0], 0.3) * u + limited(x[1], 0.3) * v);
    slab.offset += limited(x[2], 0.4);
    slab.thickness = std::max(slab.thickness + limited(x[3], 0.3), 0.5 * kThinnest);
    if (x.lpNorm<Eigen::Infinity>() < 1e-4) break;
  }
  if (slab.thickness > kThickest || slab.thickness < kThinnest || std::abs(slab.offset) > kMostOffset)
    return {};
  double left = 0, all = 0, weights = 0, before = 0, behind = 0;
  for (std::size_t s = 0; s < count; ++s) {
    const Sample& sample = samples[s];
    const double part = slab.part_of_cell(sample.place), y = slab.height(sample.place);
    left += sample.weight * (sample.fraction - part) * (sample.fraction - part);
    all += sample.weight * sample.fraction * sample.fraction;
    weights += sample.weight;
    if (part < 0.02) (y > 0 ? before : behind) += sample.weight;
  }
  if (left > kMostRelative * kMostRelative * all || left > kMostLeft * kMostLeft * weights) return {};
  if (std::min(before, behind) < kLeastSeen) return {};
  return slab;
}

}  // namespace adamas
