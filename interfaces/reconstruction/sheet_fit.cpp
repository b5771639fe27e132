#include "interfaces/reconstruction/sheet_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/base/simd.h"
#include "interfaces/reconstruction/cut_volumes.h"
#include "interfaces/reconstruction/normal_distribution.h"
#include "interfaces/reconstruction/normal_equations.h"

namespace adamas::interfaces {

namespace {

/// Cells count up to this distance from a layer's middle, so that another layer two cells away does not
/// disturb the fit.
constexpr double kFarthest = 2.0;
/// The greatest variance of a layer along its normal, relative to the variance across it, and its greatest
/// excess over that of an even layer.
constexpr double kFlat = 0.5, kFlatBlurred = 0.85, kBlurred = 0.2;
/// Thicker layers need no special treatment; thinner ones are traces.
constexpr double kThickest = 1.5, kThinnest = 0.03;
/// The greatest distance of a layer's middle from a cell that it cuts; for a blurred layer, half its
/// thickness is added.
constexpr double kMostOffset = 1.2;
/// The least and the greatest width of a blurred layer's faces.
constexpr double kSharpest = 0.34, kWidest = 2.5;
/// The radius of a blurred layer's window is kNearRadius + kRadiusGrows * width; kMostCurved is the layer's
/// greatest curvature.
constexpr double kNearRadius = 2, kRadiusGrows = 1.8, kMostCurved = 0.4;
/// The greatest remaining differences of a fit: relative to the fractions and to a cell; for a blurred layer,
/// relative to the fractions plus kOfNoise times the noise.
constexpr double kMostRelative = 0.5, kMostLeft = 0.15, kMostRelativeBlurred = 0.2, kOfNoise = 1.3;
/// The layer is sought where fractions are greater than this times the noise.
constexpr double kAboveNoise = 2;
/// The least weight of the cells on either side of a layer.
constexpr double kLeastSeen = 0.1;
constexpr int kRounds = 6, kRoundsBlurred = 10;
/// A fit has converged when no unknown changes by more than this; kDamping is added to the diagonal of its
/// normal equations.
constexpr double kSettled = 1e-4, kSettledBlurred = 1e-3, kDamping = 1e-3;
/// A blurred fit is given up if after this many rounds the remaining difference is more than this part of the
/// fractions, or the layer is too thick or too far away.
constexpr int kFirstRounds = 4;
constexpr double kHopeless = 0.25;

struct Sides {
  std::array<double, 3> m;
  explicit Sides(const Vec3& n) : m{std::abs(n.x), std::abs(n.y), std::abs(n.z)} {
    std::sort(m.begin(), m.end());
  }
};

/// Returns the part of a cell in a sharp layer whose normal has these sides.
double part_of_sharp(const Slab& slab, const Sides& sides, const Vec3& centre) {
  const double y = slab.height(centre);
  return box_volume_below(sides.m, 0.5 * slab.thickness - y) -
         box_volume_below(sides.m, -0.5 * slab.thickness - y);
}

/// Returns the weight of a cell at a place of a window.
double weight(const SheetWindow& window, const Vec3& d) {
  const double u = 1 - squared_norm(d) / (window.radius * window.radius);
  return u > 0 ? u * u : 0;
}

/// Returns the greatest remaining sum of squares of a fit: that of a part of the fractions plus that of the
/// noise.
double most_left(double part, double all, double noise, double weights) {
  return part * part * all + kOfNoise * kOfNoise * noise * noise * weights;
}

/// Layers thicker than this need no special treatment.
double thickest(const Slab& slab) { return kThickest + slab.width; }

/// Returns whether a layer is too thick, or too far from the window's middle.
bool is_out_of_range(const Slab& slab) {
  const double farthest = kMostOffset + (slab.width > 0 ? 0.5 * slab.thickness : 0);
  return slab.thickness > thickest(slab) || std::abs(slab.offset) > farthest;
}

/// Returns two unit vectors that are orthogonal to n and to each other.
std::array<Vec3, 2> across(const Vec3& n) {
  const Vec3 axis = std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = normalized(cross(n, axis));
  return {u, cross(n, u)};
}

/// A curved layer: at tangential coordinates a and b, its middle is (xx a^2 + 2 xy a b + yy b^2) / 2 higher
/// along the normal than the flat layer's.
struct CurvedSlab {
  Slab slab;
  Vec3 u, v;  ///< orthogonal unit tangents
  double xx = 0, xy = 0, yy = 0;

  explicit CurvedSlab(const Slab& flat) : slab(flat) {
    const auto [first, second] = across(slab.normal);
    u = first, v = second;
  }
  /// Returns the point at which the flat layer has the part of the cell that this layer has at p.
  [[nodiscard]] Vec3 flattened(const Vec3& p) const {
    const double a = dot(u, p), b = dot(v, p);
    return p - 0.5 * (xx * a * a + 2 * xy * a * b + yy * b * b) * slab.normal;
  }
  [[nodiscard]] double part_of_cell(const Vec3& p) const { return slab.part_of_cell(flattened(p)); }
  /// Turns the normal towards the tangents; these stay orthogonal to it.
  void turn(double by_u, double by_v) {
    slab.normal = normalized(slab.normal + by_u * u + by_v * v);
    u = normalized(u - dot(u, slab.normal) * slab.normal);
    v = cross(slab.normal, u);
  }
};

/// The number of a layer's unknowns: rotations towards the two tangents, a move along the normal, thickness,
/// width, and three curvatures.
constexpr int kUnknowns = 8;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Growth = std::array<double, kUnknowns>;

/// The parts of cells in a layer, and their derivatives with respect to the unknowns.
class LayerParts {
 public:
  explicit LayerParts(const CurvedSlab& layer)
      : layer_(layer),
        slab_(layer.slab),
        moved_{slab_, slab_, slab_, slab_},
        sides_{Sides(slab_.normal), Sides(slab_.normal), Sides(slab_.normal), Sides(slab_.normal)},
        own_sides_(slab_.normal) {
    if (slab_.width > 0) return;
    moved_[0].normal = normalized(slab_.normal + kStep * layer.u);
    moved_[1].normal = normalized(slab_.normal + kStep * layer.v);
    moved_[2].offset += kStep;
    moved_[3].thickness += kStep;
    for (std::size_t i = 0; i < 2; ++i) sides_[i] = Sides(moved_[i].normal);
  }

  /// Returns the part of the cell at a place in the layer. Sets `growth` to its derivatives; for sharp layers
  /// only the first four are not 0.
  double find(const Vec3& place, Growth& growth) const {
    if (slab_.width > 0) {
      const double y = slab_.height(layer_.flattened(place)),
                   front = (0.5 * slab_.thickness - y) / slab_.width,
                   back = (-0.5 * slab_.thickness - y) / slab_.width;
      const auto [before, behind] = table_.at_both(front, back);
      const double at_front = before.density / slab_.width, at_back = behind.density / slab_.width,
                   by_height = at_back - at_front, a = dot(layer_.u, place), b = dot(layer_.v, place);
      growth = {by_height * a,
                by_height * b,
                -by_height,
                0.5 * (at_front + at_back),
                back * at_back - front * at_front,
                -0.5 * by_height * a * a,
                -by_height * a * b,
                -0.5 * by_height * b * b};
      return before.probability - behind.probability;
    }
    const double part = part_of_sharp(slab_, own_sides_, place);
    growth = {};
    for (std::size_t i = 0; i < 4; ++i)
      growth[i] = (part_of_sharp(moved_[i], sides_[i], place) - part) / kStep;
    return part;
  }

 private:
  static constexpr double kStep = 1e-4;

  const NormalTable& table_ = NormalTable::instance();
  const CurvedSlab& layer_;
  const Slab& slab_;
  std::array<Slab, 4> moved_;  // the layer with one unknown changed by kStep
  std::array<Sides, 4> sides_;
  Sides own_sides_;
};

/// Changes a layer's unknowns; each change is limited.
void change(CurvedSlab& layer, const Unknowns& by) {
  const auto limited = [](double value, double most) { return std::clamp(value, -most, most); };
  Slab& slab = layer.slab;
  layer.turn(limited(by[0], 0.3), limited(by[1], 0.3));
  slab.offset += limited(by[2], 0.4);
  slab.thickness = std::max(slab.thickness + limited(by[3], 0.3), 0.5 * kThinnest);
  if (slab.width == 0) return;
  slab.width = std::clamp(slab.width + limited(by[4], 0.3), kSharpest, kWidest);
  layer.xx = limited(layer.xx + limited(by[5], 0.1), kMostCurved);
  layer.xy = limited(layer.xy + limited(by[6], 0.1), kMostCurved);
  layer.yy = limited(layer.yy + limited(by[7], 0.1), kMostCurved);
}

}  // namespace

double Slab::part_of_cell(const Vec3& centre) const {
  if (width == 0) return part_of_sharp(*this, Sides(normal), centre);
  const double y = height(centre);
  const auto [before, behind] =
      NormalTable::instance().at_both((0.5 * thickness - y) / width, (-0.5 * thickness - y) / width);
  return before.probability - behind.probability;
}

const std::vector<Vec3>& SheetWindow::places_within(int reach) {
  const auto make = [](int r) {
    std::vector<Vec3> places;
    for (int k = -r; k <= r; ++k) {
      for (int j = -r; j <= r; ++j) {
        for (int i = -r; i <= r; ++i)
          places.push_back({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
      }
    }
    return places;
  };
  static const std::vector<Vec3> kNear = make(kReach), kFar = make(kBlurredReach);
  return reach == kReach ? kNear : kFar;
}

namespace {

/// The cells of a window that hold something of the thin material, with arrays by cell.
class HeldCellsOfWindow {
 public:
  explicit HeldCellsOfWindow(const SheetWindow& window) : squared_radius_(window.radius * window.radius) {
    const double least = kAboveNoise * window.noise;
    for (std::size_t c = 0; c < window.cells; ++c) {
      const double above = static_cast<double>(window.fraction[c]) - least;
      if (!(above > 0)) continue;
      const Vec3 p = window.place(c);
      x_[count_] = p.x, y_[count_] = p.y, z_[count_] = p.z, above_[count_] = above;
      ++count_;
    }
  }

  /// Calls visit(offset, weight) for the cells. `offset`: of the cell's centre from a point. Weights are
  /// those of weight() times the fractions.
  template <class Visit>
  void for_each(const Vec3& from, const Visit& visit) {
    for (std::size_t c = 0; c < count_; ++c) {
      const double x = x_[c] - from.x, y = y_[c] - from.y, z = z_[c] - from.z;
      const double u = 1 - (x * x + y * y + z * z) / squared_radius_;
      // This is u where it is positive, else 0, without a branch.
      const double positive = 0.5 * (u + std::abs(u));
      weight_[c] = positive * positive * above_[c];
    }
    for (std::size_t c = 0; c < count_; ++c)
      visit(Vec3{x_[c] - from.x, y_[c] - from.y, z_[c] - from.z}, weight_[c]);
  }

 private:
  static constexpr std::size_t kMost = (2 * SheetWindow::kBlurredReach + 1) *
                                       (2 * SheetWindow::kBlurredReach + 1) *
                                       (2 * SheetWindow::kBlurredReach + 1);
  double squared_radius_;
  std::size_t count_ = 0;
  std::array<double, kMost> x_, y_, z_, above_, weight_;
};

/// Returns the weights of the cells of a window whose radius has not been changed.
const std::vector<double>& weights_within(const SheetWindow& window) {
  const auto make = [](bool blurred) {
    const SheetWindow fresh(blurred);
    std::vector<double> weights;
    for (std::size_t c = 0; c < fresh.cells; ++c) weights.push_back(weight(fresh, fresh.place(c)));
    return weights;
  };
  static const std::vector<double> kOfSharp = make(false), kOfBlurred = make(true);
  return window.blurred() ? kOfBlurred : kOfSharp;
}

/// Returns the volume of the thin material near a layer's middle divided by the area there; 0 if the window
/// shows no part of the area.
double thickness_of(const SheetWindow& window, const Slab& slab) {
  constexpr double kHalf = 0.05, kBeyond = 0.06;
  double held = 0, area = 0;
  const Sides sides(slab.normal);
  const std::vector<double>& weights = weights_within(window);
  const double farthest = 0.5 * (sides.m[0] + sides.m[1] + sides.m[2]) + kBeyond;
  for (std::size_t c = 0; c < window.cells; ++c) {
    if (window.known[c] == 0) continue;
    const double w = weights[c], y = slab.height(window.place(c));
    if (w == 0 || (!window.blurred() && std::abs(y) > kFarthest)) continue;
    held += w * static_cast<double>(window.fraction[c]);
    // Cells farther away have no part of the area.
    if (std::abs(y) > farthest) continue;
    area += w * (box_volume_below(sides.m, kHalf - y) - box_volume_below(sides.m, -kHalf - y)) / 0.1;
  }
  return area > 0 ? held / area : 0;
}

}  // namespace

std::optional<Slab> guess_sheet(const SheetWindow& window) {
  HeldCellsOfWindow cells(window);
  Vec3 middle;
  double sum = 0;
  // The window's middle is moved to the layer, since a layer cut off by the window would seem nearer than it
  // is.
  for (int round = 0; round < 3; ++round) {
    Vec3 first;
    sum = 0;
    cells.for_each(middle, [&](const Vec3& p, double w) { first += w * p, sum += w; });
    if (!(sum > 0)) return {};
    middle += (1 / sum) * first;
  }
  std::array<double, 6> sums{};  // xx, xy, xz, yy, yz, zz
  cells.for_each(middle, [&](const Vec3& p, double w) {
    const double part = w / sum, x = part * p.x, y = part * p.y, z = part * p.z;
    sums[0] += x * p.x, sums[1] += y * p.x, sums[2] += z * p.x;
    sums[3] += y * p.y, sums[4] += z * p.y, sums[5] += z * p.z;
  });
  Eigen::Matrix3d spread;
  spread << sums[0], sums[1], sums[2], sums[1], sums[3], sums[4], sums[2], sums[4], sums[5];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> found(spread);
  const Eigen::Vector3d& by = found.eigenvalues();
  if (by[0] > (window.blurred() ? kFlatBlurred : kFlat) * by[1]) return {};
  const Eigen::Vector3d n = found.eigenvectors().col(0);
  Slab slab{{n[0], n[1], n[2]}, 0, 0};
  slab.offset = dot(slab.normal, middle);
  slab.thickness = thickness_of(window, slab);
  if (!(slab.thickness > 0)) return {};
  if (window.blurred())
    slab.width = std::clamp(std::sqrt(std::max(0.0, by[0] - slab.thickness * slab.thickness / 12)), kSharpest,
                            kWidest);
  if (slab.thickness > 1.3 * thickest(slab) || slab.thickness < 0.5 * kThinnest) return {};
  const double even = (slab.thickness * slab.thickness + 1) / 12;
  if (!window.blurred() && by[0] > even + kBlurred) return {};
  return slab;
}

namespace {

/// A cell to which a layer is fitted.
struct FittedCell {
  Vec3 place;
  double weight, fraction;
};

/// Fits a layer to cells; returns whether it may be one, and sets `off` as fit_sheet() does where not.
bool fit_layer(const SheetWindow& window, const std::vector<FittedCell>& samples, CurvedSlab& layer,
               double& off) {
  thread_local std::vector<Growth> growths;
  const Slab& slab = layer.slab;
  const bool blurred = window.blurred();
  const int rounds = blurred ? kRoundsBlurred : kRounds;
  for (int round = 0; round < rounds; ++round) {
    using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
    Matrix a = Matrix::Zero();
    Unknowns b = Unknowns::Zero();
    double left = 0, all = 0, weights = 0;
    const LayerParts parts(layer);
    growths.resize(samples.size());
    for (std::size_t n = 0; n < samples.size(); ++n) {
      const FittedCell& sample = samples[n];
      Growth& g = growths[n];
      const double missing = sample.fraction - parts.find(sample.place, g);
      for (std::size_t i = 0; i < kUnknowns; ++i)
        b[static_cast<Eigen::Index>(i)] += sample.weight * missing * g[i];
      left += sample.weight * missing * missing;
      all += sample.weight * sample.fraction * sample.fraction;
      weights += sample.weight;
    }
    const auto terms_of = [&](std::size_t n) { return growths[n].data(); };
    const auto weight_of = [&](std::size_t n) { return samples[n].weight; };
    with_wide_lanes([&](auto) {
      blurred ? sum_squares<kUnknowns>(samples.size(), terms_of, weight_of, a)
              : sum_squares<4>(samples.size(), terms_of, weight_of, a);
    });
    if (blurred && round == kFirstRounds &&
        (left > most_left(kHopeless, all, window.noise, weights) || is_out_of_range(slab))) {
      off = std::sqrt(left / all);
      return false;
    }
    a.diagonal().array() += kDamping;
    const Unknowns x = a.ldlt().solve(b);
    change(layer, x);
    if (x.lpNorm<Eigen::Infinity>() < (blurred ? kSettledBlurred : kSettled)) break;
  }
  return true;
}

}  // namespace

std::optional<Slab> fit_sheet(SheetWindow& window, const Slab& guess, double& off) {
  CurvedSlab layer(guess);
  Slab& slab = layer.slab;
  const bool blurred = window.blurred();
  if (blurred) window.radius = std::min(kNearRadius + kRadiusGrows * slab.width, window.reach + 0.5);
  thread_local std::vector<FittedCell> samples;
  samples.clear();
  for (std::size_t c = 0; c < window.cells; ++c) {
    const Vec3 p = window.place(c);
    const double w = weight(window, p);
    if (w > 0 && window.known[c] != 0 && (blurred || std::abs(slab.height(p)) <= kFarthest))
      samples.push_back({p, w, static_cast<double>(window.fraction[c])});
  }
  if (samples.size() < 12 || !fit_layer(window, samples, layer, off)) return {};
  // A side is visible in cells with little of the layer; for a blurred one, relative to its middle.
  const double seen = blurred ? 0.4 * slab.part_of_cell(slab.offset * slab.normal) : 0.02;
  double left = 0, all = 0, weights = 0, before = 0, behind = 0;
  for (const FittedCell& sample : samples) {
    const double part = layer.part_of_cell(sample.place), y = slab.height(sample.place);
    left += sample.weight * (sample.fraction - part) * (sample.fraction - part);
    all += sample.weight * sample.fraction * sample.fraction;
    weights += sample.weight;
    if (part < seen) (y > 0 ? before : behind) += sample.weight;
  }
  off = std::sqrt(left / all);
  if (is_out_of_range(slab) || slab.thickness < kThinnest) return {};
  if (blurred && left > most_left(kMostRelativeBlurred, all, window.noise, weights)) return {};
  if (off > kMostRelative || left > kMostLeft * kMostLeft * weights) return {};
  if (std::min(before, behind) < kLeastSeen) return {};
  return slab;
}

}  // namespace adamas::interfaces
