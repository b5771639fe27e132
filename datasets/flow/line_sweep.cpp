#include "datasets/flow/line_sweep.h"

#include <algorithm>
#include <cmath>

#include "core/base/simd.h"

/// Put before a function, this compiles it for several sets of vector instructions, of which the machine's
/// widest one is used. Results are the same, since no operations are fused. It is empty with sanitizers,
/// which cannot follow the choice at the start of the program.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ADAMAS_VECTOR_CLONES [[gnu::flatten, gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define ADAMAS_VECTOR_CLONES
#endif

namespace adamas::datasets {

namespace {

/// The smaller of two differences with equal sign, else zero.
double minmod(double a, double b) {
  const double least = std::min(std::abs(a), std::abs(b));
  return a * b > 0 ? std::copysign(least, a) : 0.0;
}

/// The slope by van Leer's monotonised central difference: total variation diminishing, and of second order
/// on the flanks of smooth extrema.
double central_slope(double a, double b) {
  const double least = std::min(2 * std::min(std::abs(a), std::abs(b)), 0.5 * std::abs(a + b));
  return a * b > 0 ? std::copysign(least, a) : 0.0;
}

/// The greatest difference between the value at a cell's end and the cell's own, towards the cell beyond that
/// end: `beyond` is the difference to that cell, `behind` that on the other side. The value is as close as
/// possible to the one downstream, so that interfaces stay within two or three cells, but not so close that
/// the cell would overshoot the one upstream while `courant` of it flows out (Kokh and Lagoutiere 2010).
double sharp_reach(double beyond, double behind, double courant) {
  return minmod(beyond, behind * ((1 - courant) / courant));
}

/// Converts conserved to primitive variables.
template <std::size_t N>
ADAMAS_VECTOR_CLONES void to_primitive(const MixtureLaw<N>& law, const Row<N>& q, Row<N>& w) {
  using V = Variables<N>;
  // This is the least number whose inverse is finite: an absent material has density zero.
  constexpr double kTiny = 1e-300;
  ADAMAS_INDEPENDENT
  for (std::size_t l = 0; l < kLanes; ++l) {
    MixtureMeans mean;
    for_each_material<N>([&](std::size_t k) __attribute__((always_inline)) {
      const double fraction = q[V::kFraction + k][l], mass = q[V::kMass + k][l];
      mean.density += mass;
      mean.inverse += fraction * law.inverse[k];
      mean.offset += fraction * law.offset[k];
      w[V::kFraction + k][l] = fraction;
      w[V::kDensity + k][l] = mass / std::max(fraction, kTiny);
    });
    const double volume = 1 / mean.density;
    const double a = q[V::kNormal][l] * volume, b = q[V::kTransverse][l] * volume,
                 c = q[V::kTransverse + 1][l] * volume;
    w[V::kNormal][l] = a;
    w[V::kTransverse][l] = b;
    w[V::kTransverse + 1][l] = c;
    const double internal = q[V::kEnergy][l] - 0.5 * mean.density * (a * a + (b * b + c * c));
    w[V::kPressure][l] = (internal - mean.offset) / mean.inverse;
  }
}

/// Primitive variables at a cell's two ends after half a step: they are linear in the cell and advanced by
/// the equations in primitive form (MUSCL-Hancock, see Toro's book, 14.4). `half` is half the step over the
/// size of a cell. If `order` is zero, or an end would have a state without a speed of sound, both ends get
/// the cell's own values.
template <std::size_t N>
ADAMAS_VECTOR_CLONES void reconstruct(const MixtureLaw<N>& law, const Row<N>& before, const Row<N>& w,
                                      const Row<N>& after, double half,
                                      const std::array<double, kLanes>& order, Row<N>& low, Row<N>& high) {
  using V = Variables<N>;
  // Faces may move faster than the cell between them.
  constexpr double kLeastCourant = 0.2, kMargin = 1.2;
  ADAMAS_INDEPENDENT
  for (std::size_t l = 0; l < kLanes; ++l) {
    const auto differences = [&](std::size_t v) __attribute__((always_inline)) {
      return std::pair(w[v][l] - before[v][l], after[v][l] - w[v][l]);
    };
    const auto slope = [&](std::size_t v) __attribute__((always_inline)) {
      const auto [a, b] = differences(v);
      return central_slope(a, b);
    };
    const double velocity = w[V::kNormal][l], pressure = w[V::kPressure][l];
    const double courant = std::min(1.0, std::max(kLeastCourant, kMargin * 2 * half * std::abs(velocity)));
    const double d_velocity = slope(V::kNormal), d_pressure = slope(V::kPressure);
    std::array<double, N> fraction_low, fraction_high, density_low, density_high;
    MixtureMeans mean;
    double sum_low = 0, sum_high = 0;
    for_each_material<N>([&](std::size_t k) __attribute__((always_inline)) {
      const double fraction = w[V::kFraction + k][l], density = w[V::kDensity + k][l];
      const auto [a, b] = differences(V::kFraction + k);
      const double d_density = slope(V::kDensity + k);
      fraction_low[k] = fraction - sharp_reach(a, b, courant);
      fraction_high[k] = fraction + sharp_reach(b, a, courant);
      sum_low += fraction_low[k];
      sum_high += fraction_high[k];
      const double thinned = density - half * (velocity * d_density + density * d_velocity);
      density_low[k] = thinned - 0.5 * d_density;
      density_high[k] = thinned + 0.5 * d_density;
      mean.density += fraction * density;
      mean.inverse += fraction * law.inverse[k];
      mean.offset += fraction * law.offset[k];
    });
    const double stiffness = mean.stiffness_at(pressure);
    const double p = pressure - half * (velocity * d_pressure + stiffness * d_velocity);
    const double p_low = p - 0.5 * d_pressure, p_high = p + 0.5 * d_pressure;
    // Limited slopes of three materials do not add up to zero, so the fractions are scaled.
    const double scale_low = 1 / sum_low, scale_high = 1 / sum_high;
    MixtureMeans at_low, at_high;
    double least = 1;
    for_each_material<N>([&](std::size_t k) __attribute__((always_inline)) {
      fraction_low[k] *= scale_low;
      fraction_high[k] *= scale_high;
      at_low.inverse += fraction_low[k] * law.inverse[k];
      at_high.inverse += fraction_high[k] * law.inverse[k];
      at_low.offset += fraction_low[k] * law.offset[k];
      at_high.offset += fraction_high[k] * law.offset[k];
      at_low.density += fraction_low[k] * density_low[k];
      at_high.density += fraction_high[k] * density_high[k];
      least = std::min(least, std::min(std::min(fraction_low[k], fraction_high[k]),
                                       std::min(density_low[k], density_high[k])));
    });
    // The pressure, measured from where the speed of sound vanishes, must not fall below a tenth of the
    // cell's.
    constexpr double kLeast = 0.1;
    const double room = kLeast * stiffness;
    const double spare =
        std::min(std::min(at_low.stiffness_at(p_low) - room, at_high.stiffness_at(p_high) - room),
                 std::min(at_low.density, at_high.density) - kLeast * mean.density);
    const bool good = order[l] > 0 && least >= 0 && spare > 0;
    for_each_material<N>([&](std::size_t k) __attribute__((always_inline)) {
      const double fraction = w[V::kFraction + k][l], density = w[V::kDensity + k][l];
      low[V::kFraction + k][l] = good ? fraction_low[k] : fraction;
      high[V::kFraction + k][l] = good ? fraction_high[k] : fraction;
      low[V::kDensity + k][l] = good ? density_low[k] : density;
      high[V::kDensity + k][l] = good ? density_high[k] : density;
    });
    const double u = velocity - half * (velocity * d_velocity + d_pressure / mean.density);
    low[V::kNormal][l] = good ? u - 0.5 * d_velocity : velocity;
    high[V::kNormal][l] = good ? u + 0.5 * d_velocity : velocity;
    for (const std::size_t v : {V::kTransverse, V::kTransverse + 1}) {
      const double d = slope(v), moved = w[v][l] - half * velocity * d;
      low[v][l] = good ? moved - 0.5 * d : w[v][l];
      high[v][l] = good ? moved + 0.5 * d : w[v][l];
    }
    low[V::kPressure][l] = good ? p_low : pressure;
    high[V::kPressure][l] = good ? p_high : pressure;
  }
}

/// One side of a Riemann problem in one lane.
struct RiemannSide {
  MixtureMeans mean;
  double velocity = 0, pressure = 0, energy = 0, sound = 0;
};

template <std::size_t N>
[[gnu::always_inline]] inline RiemannSide riemann_side(const MixtureLaw<N>& law, const Row<N>& w,
                                                       std::size_t l) {
  using V = Variables<N>;
  RiemannSide side;
  for_each_material<N>([&](std::size_t k) {
    const double fraction = w[V::kFraction + k][l];
    side.mean.density += fraction * w[V::kDensity + k][l];
    side.mean.inverse += fraction * law.inverse[k];
    side.mean.offset += fraction * law.offset[k];
  });
  side.velocity = w[V::kNormal][l];
  side.pressure = w[V::kPressure][l];
  const double b = w[V::kTransverse][l], c = w[V::kTransverse + 1][l];
  side.energy = side.mean.inverse * side.pressure + side.mean.offset +
                0.5 * side.mean.density * (side.velocity * side.velocity + (b * b + c * c));
  side.sound = std::sqrt(side.mean.stiffness_at(side.pressure) / side.mean.density);
  return side;
}

/// Solves the Riemann problem approximately with two waves and a contact (Toro, Spruce and Speares 1994),
/// with the speeds of Davis (1988). Everything that is advected, also fractions, has the same velocity on the
/// face as the mass, so that a contact in equilibrium stays so (Johnsen and Colonius 2006).
template <std::size_t N>
ADAMAS_VECTOR_CLONES void hllc(const MixtureLaw<N>& law, const Row<N>& left, const Row<N>& right,
                               FaceFlux<N>& face) {
  using V = Variables<N>;
  ADAMAS_INDEPENDENT
  for (std::size_t l = 0; l < kLanes; ++l) {
    const RiemannSide a = riemann_side(law, left, l), b = riemann_side(law, right, l);
    const double slowest = std::min(a.velocity - a.sound, b.velocity - b.sound);
    const double fastest = std::max(a.velocity + a.sound, b.velocity + b.sound);
    const double flow_a = a.mean.density * (slowest - a.velocity);
    const double flow_b = b.mean.density * (fastest - b.velocity);
    const double contact =
        (b.pressure - a.pressure + (flow_a * a.velocity - flow_b * b.velocity)) / (flow_a - flow_b);
    // These are the values of the side that the face lies on; behind its wave, if that has not passed the
    // face, the state is another one.
    const bool from_left = contact >= 0;
    const auto pick = [&](std::size_t v) {
      const double on_left = left[v][l], on_right = right[v][l];
      return from_left ? on_left : on_right;
    };
    const double density = from_left ? a.mean.density : b.mean.density;
    const double velocity = from_left ? a.velocity : b.velocity;
    const double pressure = from_left ? a.pressure : b.pressure;
    const double energy = from_left ? a.energy : b.energy;
    const double wave = from_left ? slowest : fastest;
    // This selects numbers, not conditions, so that the loop becomes vector instructions.
    const bool behind = (from_left ? slowest : -fastest) < 0;
    const double lead = wave - velocity;
    const double squeeze = lead / (wave - contact);
    const double star_pressure = pressure + density * lead * (contact - velocity);
    const double star_energy =
        squeeze * (energy + (contact - velocity) * (density * contact + pressure / lead));
    const double at = behind ? contact : velocity;
    const double push = behind ? star_pressure : pressure;
    const double carried = behind ? squeeze * contact : velocity;
    face.velocity[l] = carried;
    for_each_material<N>([&](std::size_t k) {
      const double fraction = pick(V::kFraction + k);
      face.flow[V::kFraction + k][l] = fraction * carried;
      face.flow[V::kMass + k][l] = fraction * pick(V::kDensity + k) * carried;
    });
    face.flow[V::kNormal][l] = density * carried * at + push;
    for (const std::size_t v : {V::kTransverse, V::kTransverse + 1}) {
      face.flow[v][l] = density * carried * pick(v);
    }
    face.flow[V::kEnergy][l] = ((behind ? star_energy : energy) + push) * at;
  }
}

/// Changes the share of void in one cell so that the pressure is the one that VoidOpening asks for; masses,
/// momentum and total energy keep every bit. Leaves the cell as it is if it contains only void or too little
/// energy.
template <std::size_t N>
void move_void(const MixtureLaw<N>& law, const VoidOpening& opening, Row<N>& q, std::size_t l) {
  using V = Variables<N>;
  const std::size_t v = opening.material;
  double density = 0, inverse = 0, offset = 0, filled = 0;
  for (std::size_t k = 0; k < N; ++k) {
    density += q[V::kMass + k][l];
    if (k == v) continue;
    filled += q[V::kFraction + k][l];
    inverse += q[V::kFraction + k][l] * law.inverse[k];
    offset += q[V::kFraction + k][l] * law.offset[k];
  }
  const double a = q[V::kNormal][l], b = q[V::kTransverse][l], c = q[V::kTransverse + 1][l];
  const double internal = q[V::kEnergy][l] - 0.5 * (a * a + (b * b + c * c)) / density;
  // If the shares of all other materials are multiplied by x, the pressure is the wanted one when x times
  // `each` equals `left`.
  const double each = offset + opening.pressure * (inverse - filled * law.inverse[v]);
  const double left = internal - opening.pressure * law.inverse[v];
  if (!(filled > 0) || !(each > 0) || !(left > 0)) return;
  double x = left / each;
  // Void shrinks only until it is dense enough to have a pressure of its own.
  const double most = (1 - q[V::kMass + v][l] / opening.density) / filled;
  if (x > 1) x = std::max(1.0, std::min(x, most));
  for (std::size_t k = 0; k < N; ++k) q[V::kFraction + k][l] *= x;
  q[V::kFraction + v][l] = std::max(0.0, 1 - filled * x);
}

constexpr std::size_t kGhosts = 2;
/// The number of attempts; by then all cells round a bad one have had first order for several attempts.
constexpr int kMostAttempts = 4;

/// The cell of which a ghost cell is a copy or a mirror image; ghost cells have the indices 0, 1 and cells +
/// 2, cells + 3.
std::size_t origin_of(std::size_t ghost, std::size_t cells, FlowBoundary boundary) {
  const bool low = ghost < kGhosts;
  const std::size_t away = low ? kGhosts - 1 - ghost : ghost - cells - kGhosts;  // 0 or 1
  std::size_t from_end = boundary == FlowBoundary::kOutflow ? 0 : away;
  from_end = std::min(from_end, cells - 1);
  const bool at_low = low != (boundary == FlowBoundary::kPeriodic);
  return kGhosts + (at_low ? from_end : cells - 1 - from_end);
}

/// Removes rounding errors from volume fractions: none is negative, and they add up to one.
template <std::size_t N>
void clean_fractions(Row<N>& q) {
  ADAMAS_INDEPENDENT
  for (std::size_t l = 0; l < kLanes; ++l) {
    double sum = 0;
    for_each_material<N>([&](std::size_t k) {
      q[k][l] = std::max(q[k][l], 0.0);
      sum += q[k][l];
    });
    const double scale = 1 / sum;
    for_each_material<N>([&](std::size_t k) { q[k][l] *= scale; });
  }
}

/// Marks, by 1, the lanes of a row whose pressure is below `least`, and those without a positive mass or a
/// speed of sound.
template <std::size_t N>
ADAMAS_VECTOR_CLONES void judge(const MixtureLaw<N>& law, const Row<N>& q, double least,
                                std::array<double, kLanes>& low, std::array<double, kLanes>& bad) {
  using V = Variables<N>;
  ADAMAS_INDEPENDENT
  for (std::size_t l = 0; l < kLanes; ++l) {
    MixtureMeans mean;
    double least_mass = 0;
    for_each_material<N>([&](std::size_t k) {
      const double fraction = q[V::kFraction + k][l];
      mean.density += q[V::kMass + k][l];
      mean.inverse += fraction * law.inverse[k];
      mean.offset += fraction * law.offset[k];
      least_mass = std::min(least_mass, q[V::kMass + k][l]);
    });
    const double a = q[V::kNormal][l], b = q[V::kTransverse][l], c = q[V::kTransverse + 1][l];
    const double internal = q[V::kEnergy][l] - 0.5 * (a * a + (b * b + c * c)) / mean.density;
    const double pressure = (internal - mean.offset) / mean.inverse;
    const bool sound = least_mass >= 0 && mean.density > 0 && mean.stiffness_at(pressure) > 0;
    bad[l] = sound ? 0.0 : 1.0;
    low[l] = pressure >= least ? 0.0 : 1.0;
  }
}

bool any(const std::array<double, kLanes>& flags) {
  double sum = 0;
  for (const double flag : flags) sum += flag;
  return sum > 0;
}

}  // namespace

template <std::size_t N>
void LineSweep<N>::load(const FlowLines<N>& lines, const std::array<LineEnd<N>, 2>& ends) {
  using V = Variables<N>;
  cells_ = lines.cells;
  before_.resize(cells_ + 2 * kGhosts);
  primitive_.resize(cells_ + 2 * kGhosts);
  order_.assign(cells_ + 2 * kGhosts, Lane{1, 1, 1, 1, 1, 1, 1, 1});
  faces_.resize(cells_ + 1);
  after_.resize(cells_);
  bad_.resize(cells_);
  std::array<std::size_t, kLanes> offset;
  for (std::size_t l = 0; l < kLanes; ++l) offset[l] = std::min(l, lines.lanes - 1) * lines.lane_stride;
  for (std::size_t s = 0; s < cells_; ++s) {
    for (std::size_t v = 0; v < V::kCount; ++v) {
      const double* from = lines.variables[v] + s * lines.stride;
      for (std::size_t l = 0; l < kLanes; ++l) before_[s + kGhosts][v][l] = from[offset[l]];
    }
  }
  for (const std::size_t ghost : {std::size_t{0}, std::size_t{1}, cells_ + 2, cells_ + 3}) {
    const LineEnd<N>& end = ends[ghost < kGhosts ? 0 : 1];
    before_[ghost] = before_[origin_of(ghost, cells_, end.boundary)];
    if (end.boundary == FlowBoundary::kGiven) {
      for (std::size_t v = 0; v < V::kCount; ++v) before_[ghost][v].fill(end.given[v]);
    }
    if (end.boundary != FlowBoundary::kMirror) continue;
    for (double& momentum : before_[ghost][V::kNormal]) momentum = -momentum;
  }
  for (std::size_t s = 0; s < before_.size(); ++s) to_primitive(law_, before_[s], primitive_[s]);
}

template <std::size_t N>
void LineSweep<N>::find_fluxes(double ratio) {
  std::array<Row<N>, 2> low, high;
  for (std::size_t s = 1; s <= cells_ + kGhosts; ++s) {
    const std::size_t here = s % 2;
    reconstruct(law_, primitive_[s - 1], primitive_[s], primitive_[s + 1], 0.5 * ratio, order_[s], low[here],
                high[here]);
    if (s >= kGhosts) hllc(law_, high[1 - here], low[here], faces_[s - kGhosts]);
  }
}

template <std::size_t N>
void LineSweep<N>::update(double ratio) {
  using V = Variables<N>;
  for (std::size_t s = 0; s < cells_; ++s) {
    const Row<N>& before = before_[s + kGhosts];
    const FaceFlux<N>&low = faces_[s], &high = faces_[s + 1];
    Row<N>& after = after_[s];
    for (std::size_t v = 0; v < V::kCount; ++v) {
      for (std::size_t l = 0; l < kLanes; ++l) {
        after[v][l] = before[v][l] - ratio * (high.flow[v][l] - low.flow[v][l]);
      }
    }
    for (std::size_t k = 0; k < N; ++k) {
      for (std::size_t l = 0; l < kLanes; ++l) {
        after[V::kFraction + k][l] +=
            ratio * (before[V::kFraction + k][l] * (high.velocity[l] - low.velocity[l]));
      }
    }
  }
}

template <std::size_t N>
void LineSweep<N>::settle() {
  Lane low, thin;
  for (std::size_t s = 0; s < cells_; ++s) {
    Row<N>& q = after_[s];
    clean_fractions<N>(q);
    judge(law_, q, opening_ ? opening_->pressure : 0, low, bad_[s]);
    if (!opening_) continue;
    find_thin(q, thin);
    if (!any(low) && !any(thin)) continue;
    for (std::size_t l = 0; l < kLanes; ++l) {
      if (low[l] > 0 || thin[l] > 0) move_void(law_, *opening_, q, l);
    }
    judge(law_, q, opening_->pressure, low, bad_[s]);
  }
}

/// Marks lanes with void and something else in which the void is thinner than allowed.
template <std::size_t N>
void LineSweep<N>::find_thin(const Row<N>& q, Lane& thin) const {
  const auto& fraction = q[opening_->material];
  const auto& mass = q[N + opening_->material];
  ADAMAS_INDEPENDENT
  for (std::size_t l = 0; l < kLanes; ++l) {
    const double part = fraction[l], least = opening_->density * part - mass[l];
    const bool is_thin = part > 0 && part < 1 && least > 0;
    thin[l] = is_thin ? 1.0 : 0.0;
  }
}

/// Sets the order to zero round bad cells; returns their number.
template <std::size_t N>
std::size_t LineSweep<N>::distrust(const std::array<LineEnd<N>, 2>& ends, LineResult<N>& result) {
  std::size_t count = 0;
  for (std::size_t s = 0; s < cells_; ++s) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      if (bad_[s][l] == 0) continue;
      if (count == 0) {
        result.bad_cell = s;
        result.bad_lane = l;
      }
      ++count;
      for (std::size_t near = s + 1; near <= s + 3; ++near) order_[near][l] = 0;
    }
  }
  for (const std::size_t ghost : {std::size_t{0}, std::size_t{1}, cells_ + 2, cells_ + 3}) {
    order_[ghost] = order_[origin_of(ghost, cells_, ends[ghost < kGhosts ? 0 : 1].boundary)];
  }
  return count;
}

template <std::size_t N>
void LineSweep<N>::store(const FlowLines<N>& lines) const {
  for (std::size_t s = 0; s < cells_; ++s) {
    for (std::size_t v = 0; v < Variables<N>::kCount; ++v) {
      double* to = lines.variables[v] + s * lines.stride;
      for (std::size_t l = 0; l < lines.lanes; ++l) to[l * lines.lane_stride] = after_[s][v][l];
    }
  }
}

template <std::size_t N>
LineResult<N> LineSweep<N>::advance(const FlowLines<N>& lines, double ratio,
                                    const std::array<LineEnd<N>, 2>& ends) {
  LineResult<N> result;
  load(lines, ends);
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    find_fluxes(ratio);
    update(ratio);
    settle();
    result.bad_cell.reset();
    const std::size_t bad = distrust(ends, result);
    if (bad == 0) break;
    result.first_order += bad;
  }
  if (result.bad_cell) return result;
  store(lines);
  for (std::size_t v = 0; v < Variables<N>::kCount; ++v) {
    for (std::size_t l = 0; l < lines.lanes; ++l) {
      result.entered[0][v] += faces_.front().flow[v][l];
      result.entered[1][v] -= faces_.back().flow[v][l];
    }
  }
  return result;
}

template class LineSweep<1>;
template class LineSweep<2>;
template class LineSweep<3>;

}  // namespace adamas::datasets
