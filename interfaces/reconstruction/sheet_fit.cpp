#include "interfaces/reconstruction/sheet_fit.h"

// Vectors of 32 bytes are only passed to functions that are inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

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
/// A fit is given up if after this many rounds the remaining difference is more than this part of the
/// fractions.
constexpr int kFirstRounds = 3;
constexpr double kHopeless = 0.35;

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
/// width, and three curvatures. Sharp layers have the first kSharpUnknowns of them.
constexpr int kUnknowns = 8, kSharpUnknowns = 4;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

/// The cells of a window to which a layer is fitted: their places, weights and fractions. The last of four
/// may be followed by cells without weight.
struct Samples {
  static constexpr std::size_t kLanes = 4;
  static constexpr std::size_t kMost = 732;  ///< at least the cells of the largest window
  std::size_t count = 0;
  std::array<double, kMost> x, y, z, weight, fraction;

  [[nodiscard]] Vec3 place(std::size_t n) const { return {x[n], y[n], z[n]}; }
  void add(const Vec3& p, double w, double f) {
    set(count++, p, w, f);
    for (std::size_t n = count; n % kLanes != 0; ++n) set(n, {}, 0, 0);
  }

 private:
  void set(std::size_t n, const Vec3& p, double w, double f) {
    x[n] = p.x, y[n] = p.y, z[n] = p.z, weight[n] = w, fraction[n] = f;
  }
};

/// The equations for a change of a layer's unknowns that brings the fractions of samples nearest to the data,
/// and sums over the samples: of the squared differences, of the squared fractions and of the weights.
struct Equations {
  Eigen::Matrix<double, kUnknowns, kUnknowns> a = Eigen::Matrix<double, kUnknowns, kUnknowns>::Zero();
  Unknowns b = Unknowns::Zero();
  double left = 0, all = 0, weights = 0;
};

/// Sets up the equations for a sharp layer; derivatives are differences.
void set_up_sharp(const CurvedSlab& layer, const Samples& samples, Equations& equations) {
  constexpr double kStep = 1e-4;
  const Slab& slab = layer.slab;
  std::array<Slab, kSharpUnknowns> moved{slab, slab, slab, slab};  // with one unknown changed by kStep
  moved[0].normal = normalized(slab.normal + kStep * layer.u);
  moved[1].normal = normalized(slab.normal + kStep * layer.v);
  moved[2].offset += kStep;
  moved[3].thickness += kStep;
  const Sides own_sides(slab.normal);
  const std::array<Sides, kSharpUnknowns> sides{Sides(moved[0].normal), Sides(moved[1].normal), own_sides,
                                                own_sides};
  using Growth = std::array<double, kSharpUnknowns>;
  thread_local std::vector<Growth> growths;
  growths.resize(samples.count);
  for (std::size_t n = 0; n < samples.count; ++n) {
    const Vec3 place = samples.place(n);
    const double part = part_of_sharp(slab, own_sides, place), missing = samples.fraction[n] - part,
                 w = samples.weight[n];
    for (std::size_t i = 0; i < kSharpUnknowns; ++i) {
      growths[n][i] = (part_of_sharp(moved[i], sides[i], place) - part) / kStep;
      equations.b[static_cast<Eigen::Index>(i)] += w * missing * growths[n][i];
    }
    equations.left += w * missing * missing;
    equations.all += w * samples.fraction[n] * samples.fraction[n];
    equations.weights += w;
  }
  sum_squares<kSharpUnknowns>(
      samples.count, [&](std::size_t n) { return growths[n].data(); },
      [&](std::size_t n) { return samples.weight[n]; }, equations.a);
}

/// Sets up the equations for a blurred layer, for four samples at a time on any processor, so that sums are
/// the same.
void set_up_blurred(const CurvedSlab& layer, const Samples& samples, Equations& equations) {
  constexpr std::size_t kBytes = Samples::kLanes * sizeof(double);
  using Vector = Simd<double, kBytes>;
  using Numbers = Vector::Numbers;
  with_wide_lanes([&](auto) {
    const NormalTable& table = NormalTable::instance();
    const Slab& slab = layer.slab;
    const double per_width = 1 / slab.width, half = 0.5 * slab.thickness;
    const Vec3 n = slab.normal;
    const double squared_normal = dot(n, n);
    std::array<std::array<Numbers, kUnknowns>, kUnknowns> squares{};
    std::array<Numbers, kUnknowns> right{};
    Numbers left{}, all{}, weights{};
    for (std::size_t at = 0; at < samples.count; at += Samples::kLanes) {
      const Numbers x = Vector::load(&samples.x[at]), y = Vector::load(&samples.y[at]),
                    z = Vector::load(&samples.z[at]), w = Vector::load(&samples.weight[at]),
                    f = Vector::load(&samples.fraction[at]);
      const Numbers a = layer.u.x * x + layer.u.y * y + layer.u.z * z,
                    b = layer.v.x * x + layer.v.y * y + layer.v.z * z;
      const Numbers raised = 0.5 * (layer.xx * a * a + 2 * layer.xy * a * b + layer.yy * b * b);
      const Numbers height = n.x * x + n.y * y + n.z * z - raised * squared_normal - slab.offset;
      const Numbers front = (half - height) * per_width, back = (-half - height) * per_width;
      const auto before = table.at_lanes<kBytes>(front), behind = table.at_lanes<kBytes>(back);
      const Numbers at_front = before.density * per_width, at_back = behind.density * per_width,
                    by_height = at_back - at_front;
      const std::array<Numbers, kUnknowns> growth{by_height * a,
                                                  by_height * b,
                                                  -by_height,
                                                  0.5 * (at_front + at_back),
                                                  back * at_back - front * at_front,
                                                  -0.5 * by_height * a * a,
                                                  -by_height * a * b,
                                                  -0.5 * by_height * b * b};
      const Numbers missing = f - (before.probability - behind.probability), weighted = w * missing;
      left += weighted * missing;
      all += w * f * f;
      weights += w;
      for (std::size_t i = 0; i < kUnknowns; ++i) {
        right[i] += weighted * growth[i];
        const Numbers by = w * growth[i];
        for (std::size_t j = 0; j <= i; ++j) squares[i][j] += by * growth[j];
      }
    }
    const auto total = [](const Numbers& lanes) { return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]); };
    for (int i = 0; i < kUnknowns; ++i) {
      const auto row = static_cast<std::size_t>(i);
      equations.b[i] = total(right[row]);
      for (int j = 0; j <= i; ++j) equations.a(i, j) = total(squares[row][static_cast<std::size_t>(j)]);
    }
    equations.left = total(left), equations.all = total(all), equations.weights = total(weights);
  });
}

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
  const NormalTable& table = NormalTable::instance();
  return table.at((0.5 * thickness - y) / width).probability -
         table.at((-0.5 * thickness - y) / width).probability;
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

/// Sums over the cells of a window that hold something of the thin material, four cells at a time on any
/// processor. A cell's weight is that of weight() times its fraction, about some point.
class HeldCellsOfWindow {
 public:
  explicit HeldCellsOfWindow(const SheetWindow& window) : squared_radius_(window.radius * window.radius) {
    const double least = kAboveNoise * window.noise;
    for (std::size_t c = 0; c < window.cells; ++c) {
      const double above = static_cast<double>(window.fraction[c]) - least;
      if (above > 0) samples_.add(window.place(c), above, above);
    }
  }

  /// The sum of weights, and of weights times places relative to the point.
  struct First {
    double weights;
    Vec3 places;
  };
  [[nodiscard]] First first(const Vec3& about) const {
    std::array<double, 4> sums{};
    add<4>(about, sums, [](const auto& x, const auto& y, const auto& z, const auto& w, auto& totals) {
      totals[0] += w, totals[1] += w * x, totals[2] += w * y, totals[3] += w * z;
    });
    return {sums[0], {sums[1], sums[2], sums[3]}};
  }
  /// Returns the sums of weights times products of coordinates: xx, xy, xz, yy, yz, zz.
  [[nodiscard]] std::array<double, 6> second(const Vec3& about) const {
    std::array<double, 6> sums{};
    add<6>(about, sums, [](const auto& x, const auto& y, const auto& z, const auto& w, auto& totals) {
      const auto wx = w * x, wy = w * y;
      totals[0] += wx * x, totals[1] += wx * y, totals[2] += wx * z;
      totals[3] += wy * y, totals[4] += wy * z, totals[5] += w * z * z;
    });
    return sums;
  }

 private:
  template <std::size_t kSums, class Add>
  void add(const Vec3& about, std::array<double, kSums>& sums, const Add& add_cells) const {
    using Vector = Simd<double, Samples::kLanes * sizeof(double)>;
    using Numbers = Vector::Numbers;
    with_wide_lanes([&](auto) {
      std::array<Numbers, kSums> totals{};
      for (std::size_t at = 0; at < samples_.count; at += Samples::kLanes) {
        const Numbers x = Vector::load(&samples_.x[at]) - about.x,
                      y = Vector::load(&samples_.y[at]) - about.y,
                      z = Vector::load(&samples_.z[at]) - about.z;
        const Numbers u = Vector::greater(1 - (x * x + y * y + z * z) / squared_radius_, Numbers{});
        add_cells(x, y, z, u * u * Vector::load(&samples_.weight[at]), totals);
      }
      for (std::size_t n = 0; n < kSums; ++n)
        sums[n] = (totals[n][0] + totals[n][1]) + (totals[n][2] + totals[n][3]);
    });
  }

  double squared_radius_;
  Samples samples_;
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
  const HeldCellsOfWindow cells(window);
  Vec3 middle;
  double sum = 0;
  // The window's middle is moved to the layer, since a layer cut off by the window would seem nearer than it
  // is.
  for (int round = 0; round < 3; ++round) {
    const auto [weights, places] = cells.first(middle);
    sum = weights;
    if (!(sum > 0)) return {};
    middle += (1 / sum) * places;
  }
  std::array<double, 6> sums = cells.second(middle);  // xx, xy, xz, yy, yz, zz
  for (double& each : sums) each /= sum;
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

std::optional<Slab> fit_sheet(SheetWindow& window, const Slab& guess, double& off) {
  CurvedSlab layer(guess);
  Slab& slab = layer.slab;
  const bool blurred = window.blurred();
  if (blurred) window.radius = std::min(kNearRadius + kRadiusGrows * slab.width, window.reach + 0.5);
  thread_local Samples samples;
  samples.count = 0;
  for (std::size_t c = 0; c < window.cells; ++c) {
    const Vec3 p = window.place(c);
    const double w = weight(window, p);
    if (w > 0 && window.known[c] != 0 && (blurred || std::abs(slab.height(p)) <= kFarthest))
      samples.add(p, w, static_cast<double>(window.fraction[c]));
  }
  if (samples.count < 12) return {};
  const int rounds = blurred ? kRoundsBlurred : kRounds;
  for (int round = 0; round < rounds; ++round) {
    Equations equations;
    blurred ? set_up_blurred(layer, samples, equations) : set_up_sharp(layer, samples, equations);
    if (blurred && round == kFirstRounds &&
        equations.left > most_left(kHopeless, equations.all, window.noise, equations.weights)) {
      off = std::sqrt(equations.left / equations.all);
      return {};
    }
    equations.a.diagonal().array() += kDamping;
    const Unknowns x = equations.a.ldlt().solve(equations.b);
    change(layer, x);
    if (x.lpNorm<Eigen::Infinity>() < (blurred ? kSettledBlurred : kSettled)) break;
  }
  // A side is visible in cells with little of the layer; for a blurred one, relative to its middle.
  const double seen = blurred ? 0.4 * slab.part_of_cell(slab.offset * slab.normal) : 0.02;
  double left = 0, all = 0, weights = 0, before = 0, behind = 0;
  for (std::size_t n = 0; n < samples.count; ++n) {
    const Vec3 place = samples.place(n);
    const double part = layer.part_of_cell(place), y = slab.height(place), w = samples.weight[n],
                 f = samples.fraction[n];
    left += w * (f - part) * (f - part);
    all += w * f * f;
    weights += w;
    if (part < seen) (y > 0 ? before : behind) += w;
  }
  off = std::sqrt(left / all);
  const double farthest = kMostOffset + (blurred ? 0.5 * slab.thickness : 0);
  if (slab.thickness > thickest(slab) || slab.thickness < kThinnest || std::abs(slab.offset) > farthest)
    return {};
  if (blurred && left > most_left(kMostRelativeBlurred, all, window.noise, weights)) return {};
  if (off > kMostRelative || left > kMostLeft * kMostLeft * weights) return {};
  if (std::min(before, behind) < kLeastSeen) return {};
  return slab;
}

}  // namespace adamas::interfaces
