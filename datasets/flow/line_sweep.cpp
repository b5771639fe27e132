#include "datasets/flow/line_sweep.h"

#include "datasets/flow/line_reconstruction.h"

namespace adamas::datasets {

namespace {

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
  ADAMAS_INDEPENDENT_LANES
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
  ADAMAS_INDEPENDENT_LANES
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
  ADAMAS_INDEPENDENT_LANES
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
