#include "datasets/flow/flow_solver.h"

#include <unistd.h>

#include <numeric>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace adamas::datasets {

namespace {

/// The orders in which the directions are swept, used in turn: each pair is symmetric in time, and over the
/// four no axis is preferred.
constexpr std::array<std::array<std::size_t, 3>, 4> kOrders{{{0, 1, 2}, {2, 1, 0}, {1, 0, 2}, {2, 0, 1}}};
/// The number of batches of lines that one thread takes at a time.
constexpr std::size_t kGrain = 4;
/// The number of first steps that are shorter: an impulsive start makes waves that the first cells do not
/// show yet.
constexpr std::size_t kCarefulSteps = 5;
constexpr double kCarefulPart = 0.2;
constexpr double kGibibyte = 1024.0 * 1024 * 1024;

std::array<double, 3> cell_size(const Box3& box, const std::array<std::size_t, 3>& cells) {
  const Vec3 size = box.size();
  return {size.x / static_cast<double>(cells[0]), size.y / static_cast<double>(cells[1]),
          size.z / static_cast<double>(cells[2])};
}

}  // namespace

template <std::size_t N>
FlowSolver<N>::FlowSolver(std::string name, FlowProblem<N> problem,
                          const std::function<FlowCell<N>(std::size_t, std::size_t, std::size_t)>& cell)
    : name_(std::move(name)), problem_(std::move(problem)), law_([this] {
        std::array<StiffenedGas, N> gases;
        for (std::size_t k = 0; k < N; ++k) gases[k] = problem_.materials[k].gas;
        return MixtureLaw<N>(gases);
      }()) {
  check_cells(name_, problem_.cells);
  size_ = cell_size(problem_.box, problem_.cells);
  const std::size_t nx = problem_.cells[0], ny = problem_.cells[1], nz = problem_.cells[2];
  for (auto& values : state_) values.resize(nx * ny * nz);
  parallel_for(nz, 1, [&](std::size_t k) {
    for (std::size_t j = 0; j < ny; ++j) {
      for (std::size_t i = 0; i < nx; ++i) {
        const Conserved q = conserved(cell(i, j, k));
        for (std::size_t v = 0; v < V::kCount; ++v) state_[v][index(i, j, k)] = q[v];
        if (!(std::accumulate(&q[V::kMass], &q[V::kMass] + N, 0.0) > 0))
          fail("{}: expected matter in every cell, found none in ({}, {}, {})", name_, i, j, k);
      }
    }
  });
}

template <std::size_t N>
void FlowSolver<N>::check_cells(const std::string& name, const std::array<std::size_t, 3>& cells) {
  double count = 1;
  for (const std::size_t n : cells) count *= static_cast<double>(n);
  if (!(count > 0)) fail("{}: expected at least one cell along each axis, found none", name);
  // The estimate includes the arrays that are written.
  const double needed = count * (V::kCount * sizeof(double) + (2 * N + 4) * sizeof(float));
  const double memory =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (needed > memory) {
    fail("{}: expected dimensions that fit in memory ({:.0f} GiB), found {}x{}x{}, which need {:.0f} GiB",
         name, memory / kGibibyte, cells[0], cells[1], cells[2], needed / kGibibyte);
  }
}

template <std::size_t N>
auto FlowSolver<N>::conserved(const FlowCell<N>& cell) const -> Conserved {
  Conserved q{};
  double density = 0, internal = 0;
  for (std::size_t m = 0; m < N; ++m) {
    q[V::kFraction + m] = cell.fractions[m];
    q[V::kMass + m] = cell.fractions[m] * cell.densities[m];
    density += q[V::kMass + m];
    internal += cell.fractions[m] * (law_.inverse[m] * cell.pressure + law_.offset[m]);
  }
  q[V::kNormal] = density * cell.velocity.x;
  q[V::kNormal + 1] = density * cell.velocity.y;
  q[V::kNormal + 2] = density * cell.velocity.z;
  q[V::kEnergy] = internal + 0.5 * density * dot(cell.velocity, cell.velocity);
  return q;
}

template <std::size_t N>
void FlowSolver<N>::set_beyond(std::size_t axis, std::size_t end, const FlowCell<N>& state) {
  problem_.boundaries[axis][end] = FlowBoundary::kGiven;
  beyond_[axis][end] = conserved(state);
}

template <std::size_t N>
FlowCell<N> FlowSolver<N>::cell(std::size_t i, std::size_t j, std::size_t k) const {
  const std::size_t at = index(i, j, k);
  FlowCell<N> c;
  MixtureMeans mean;
  for (std::size_t m = 0; m < N; ++m) {
    const double fraction = state_[V::kFraction + m][at], mass = state_[V::kMass + m][at];
    c.fractions[m] = fraction;
    c.densities[m] = fraction > 0 ? mass / fraction : 0;
    mean.density += mass;
    mean.inverse += fraction * law_.inverse[m];
    mean.offset += fraction * law_.offset[m];
  }
  const Vec3 momentum{state_[V::kNormal][at], state_[V::kNormal + 1][at], state_[V::kNormal + 2][at]};
  c.velocity = (1 / mean.density) * momentum;
  c.pressure =
      (state_[V::kEnergy][at] - 0.5 * dot(momentum, momentum) / mean.density - mean.offset) / mean.inverse;
  return c;
}

template <std::size_t N>
FlowLedger<N> FlowSolver<N>::inside() const {
  FlowLedger<N> ledger;
  const double volume = size_[0] * size_[1] * size_[2];
  const auto sum = [volume](const std::vector<double>& values) {
    // The rounding error of each sum is collected and added in the end (Kahan 1965), so that the ledger shows
    // only errors of the flow.
    double total = 0, lost = 0;
    for (const double v : values) {
      const double more = v - lost, next = total + more;
      lost = (next - total) - more;
      total = next;
    }
    return total * volume;
  };
  for (std::size_t m = 0; m < N; ++m) ledger.mass[m] = sum(state_[V::kMass + m]);
  ledger.energy = sum(state_[V::kEnergy]);
  return ledger;
}

/// The greatest number of cells that a wave crosses per unit of time, along any axis that is swept.
template <std::size_t N>
double FlowSolver<N>::fastest() const {
  const std::size_t nx = problem_.cells[0], ny = problem_.cells[1], nz = problem_.cells[2];
  std::vector<double> rows(ny * nz, 0.0);
  parallel_for(ny * nz, 16, [&](std::size_t row) {
    double most = 0;
    for (std::size_t at = row * nx; at < (row + 1) * nx; ++at) {
      MixtureMeans mean;
      for_each_material<N>([&](std::size_t m) {
        mean.density += state_[V::kMass + m][at];
        mean.inverse += state_[V::kFraction + m][at] * law_.inverse[m];
        mean.offset += state_[V::kFraction + m][at] * law_.offset[m];
      });
      const double volume = 1 / mean.density;
      const std::array<double, 3> u{state_[V::kNormal][at] * volume, state_[V::kNormal + 1][at] * volume,
                                    state_[V::kNormal + 2][at] * volume};
      const double internal =
          state_[V::kEnergy][at] - 0.5 * mean.density * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
      const double p = (internal - mean.offset) / mean.inverse;
      const double sound = std::sqrt(std::max(mean.stiffness_at(p), 0.0) * volume);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double crossed = problem_.cells[axis] > 1 ? (std::abs(u[axis]) + sound) / size_[axis] : 0.0;
        most = std::max(most, crossed);
      }
    }
    rows[row] = most;
  });
  return *std::max_element(rows.begin(), rows.end());
}

template <std::size_t N>
void FlowSolver<N>::fail_in(std::size_t axis, std::size_t cell, std::size_t line, std::size_t layer) const {
  std::array<std::size_t, 3> at{};
  at[axis] = cell;
  at[axis == 0 ? 1 : 0] = line;
  at[axis == 2 ? 1 : 2] = layer;
  fail(
      "{}: expected a flow that the materials' laws describe, found none in cell ({}, {}, {}) at time {:.6g}",
      name_, at[0], at[1], at[2], time_);
}

template <std::size_t N>
std::size_t FlowSolver<N>::variable_along(std::size_t axis, std::size_t v) {
  const std::size_t across = axis == 0 ? 1 : 0, beyond = axis == 2 ? 1 : 2;
  if (v == V::kNormal) return V::kNormal + axis;
  if (v == V::kTransverse) return V::kNormal + across;
  if (v == V::kTransverse + 1) return V::kNormal + beyond;
  return v;
}

template <std::size_t N>
LineEnd<N> FlowSolver<N>::line_end(std::size_t axis, std::size_t end) const {
  LineEnd<N> result{problem_.boundaries[axis][end]};
  for (std::size_t v = 0; v < V::kCount; ++v) result.given[v] = beyond_[axis][end][variable_along(axis, v)];
  return result;
}

template <std::size_t N>
void FlowSolver<N>::sweep(std::size_t axis, double step) {
  const auto& n = problem_.cells;
  const std::array<std::size_t, 3> strides{1, n[0], n[0] * n[1]};
  const std::size_t across = axis == 0 ? 1 : 0, beyond = axis == 2 ? 1 : 2;
  const std::size_t batches = (n[across] + kLanes - 1) / kLanes, count = batches * n[beyond];
  const std::array<LineEnd<N>, 2> ends{line_end(axis, 0), line_end(axis, 1)};
  std::vector<LineResult<N>> results(count);
  parallel_chunks(count, kGrain, [&](std::size_t begin, std::size_t end) {
    LineSweep<N> line(law_, problem_.opening);
    for (std::size_t b = begin; b < end; ++b) {
      const std::size_t first = b % batches * kLanes, layer = b / batches;
      FlowLines<N> lines;
      for (std::size_t v = 0; v < V::kCount; ++v) {
        lines.variables[v] =
            state_[variable_along(axis, v)].data() + first * strides[across] + layer * strides[beyond];
      }
      lines.cells = n[axis];
      lines.stride = strides[axis];
      lines.lanes = std::min(kLanes, n[across] - first);
      lines.lane_stride = strides[across];
      results[b] = line.advance(lines, step / size_[axis], ends);
    }
  });
  const double amount = step * size_[across] * size_[beyond];
  for (std::size_t b = 0; b < count; ++b) {
    const LineResult<N>& result = results[b];
    if (result.bad_cell) fail_in(axis, *result.bad_cell, b % batches * kLanes + result.bad_lane, b / batches);
    first_order_ += result.first_order;
    for (const auto& end : result.entered) {
      for (std::size_t m = 0; m < N; ++m) entered_.mass[m] += amount * end[V::kMass + m];
      entered_.energy += amount * end[V::kEnergy];
    }
  }
}

template <std::size_t N>
void FlowSolver<N>::advance_to(double time, Progress& progress) {
  const double start = time_;
  while (time_ < time) {
    progress.step("computing the flow", (time_ - start) / (time - start));
    double step = problem_.courant / fastest();
    if (steps_ < kCarefulSteps) step *= kCarefulPart;
    const bool last = time_ + step >= time;
    if (last) step = time - time_;
    if (!(time_ + step > time_)) {
      fail("{}: expected waves that a step can follow, found steps of {} at time {:.6g}", name_, step, time_);
    }
    for (const std::size_t axis : kOrders[steps_ % kOrders.size()]) {
      if (problem_.cells[axis] > 1) sweep(axis, step);
    }
    time_ = last ? time : time_ + step;
    ++steps_;
  }
}

namespace {

RectilinearGrid flow_grid(const Box3& box, const std::array<std::size_t, 3>& cells) {
  RectilinearGrid grid;
  const std::array<double, 3> low{box.min.x, box.min.y, box.min.z}, high{box.max.x, box.max.y, box.max.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double n = static_cast<double>(cells[axis]);
    for (std::size_t i = 0; i <= cells[axis]; ++i) {
      const double part = static_cast<double>(i) / n;
      grid.nodes[axis].push_back(low[axis] * (1 - part) + high[axis] * part);
    }
  }
  return grid;
}

/// Writes one cell into the arrays.
template <std::size_t N>
void put(const FlowCell<N>& cell, std::size_t site, MultiMaterialData& data) {
  double kept = 0;
  for (const double f : cell.fractions) kept += f < kLeastFraction ? 0 : f;
  for (std::size_t m = 0; m < N; ++m) {
    if (cell.fractions[m] < kLeastFraction) continue;
    data.fractions[MaterialId(m)][site] = static_cast<float>(cell.fractions[m] / kept);
    data.fields[0].material_values[MaterialId(m)].set(site, cell.densities[m]);
  }
  data.fields[1].values.set(site, cell.pressure);
  data.fields[2].values.set(3 * site, cell.velocity.x);
  data.fields[2].values.set(3 * site + 1, cell.velocity.y);
  data.fields[2].values.set(3 * site + 2, cell.velocity.z);
}

}  // namespace

template <std::size_t N>
MultiMaterialData flow_data(const FlowSolver<N>& flow, const std::string& source, const FlowUnits& units) {
  const auto& cells = flow.problem().cells;
  const std::size_t count = cells[0] * cells[1] * cells[2];
  MultiMaterialData data;
  data.source = source;
  data.grid = flow_grid(flow.problem().box, cells);
  for (const FlowMaterial& material : flow.problem().materials) data.materials.push_back(material.name);
  data.fractions.assign(N, SiteArray<float>(count));
  data.fields.resize(3);
  data.fields[0] = {"density", units.density, 1, {}, {}};
  data.fields[0].material_values.assign(N, std::vector<float>(count));
  data.fields[1] = {"pressure", units.pressure, 1, std::vector<float>(count), {}};
  data.fields[2] = {"velocity", units.velocity, 3, std::vector<float>(3 * count), {}};
  parallel_for(cells[2], 1, [&](std::size_t k) {
    for (std::size_t j = 0; j < cells[1]; ++j) {
      for (std::size_t i = 0; i < cells[0]; ++i) {
        put(flow.cell(i, j, k), i + cells[0] * (j + cells[1] * k), data);
      }
    }
  });
  return data;
}

template class FlowSolver<1>;
template class FlowSolver<2>;
template class FlowSolver<3>;
template MultiMaterialData flow_data(const FlowSolver<3>&, const std::string&, const FlowUnits&);

}  // namespace adamas::datasets
