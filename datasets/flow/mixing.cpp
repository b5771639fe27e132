#include "datasets/flow/mixing.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/base/error.h"
#include "datasets/flow/ripples.h"

namespace adamas::datasets {

namespace {

// The state of air at 20 degrees Celsius and one atmosphere.
constexpr double kPressure = 101325, kTemperature = 293.15;
const std::array<RestingGas, 2> kGases{{{{1.4, 0}, 1.204}, {{1.094, 0}, 6.07}}};
// Fractions of the tube's length: where the interface comes to rest, and how far before it the shock starts.
constexpr double kPlace = 0.5, kApproach = 0.15;

FlowProblem<2> mixing_problem(const MixingOptions& options) {
  FlowProblem<2> problem;
  const auto& n = options.cells;
  const double size = kMixingLength / static_cast<double>(n[2]);
  problem.box = {{0, 0, 0},
                 {static_cast<double>(n[0]) * size, static_cast<double>(n[1]) * size, kMixingLength}};
  problem.cells = n;
  problem.materials = {{{"air", kGases[kAir].gas}, {"sulphur hexafluoride", kGases[kHexafluoride].gas}}};
  const std::array<FlowBoundary, 2> across{FlowBoundary::kPeriodic, FlowBoundary::kPeriodic};
  problem.boundaries = {{across, across, {FlowBoundary::kOutflow, FlowBoundary::kOutflow}}};
  return problem;
}

void check(const MixingOptions& options) {
  const auto& n = options.cells;
  if (n[2] < kFewestMixingCells || n[0] == 0 || n[1] == 0) {
    fail("mixing: expected at least 1 x 1 x {} samples, found {} x {} x {}", kFewestMixingCells, n[0], n[1],
         n[2]);
  }
  if (!(options.mach > 1 && options.mach <= kGreatestMixingMach)) {
    fail("mixing: expected a Mach number above 1 and up to {}, found {}", kGreatestMixingMach, options.mach);
  }
  FlowSolver<2>::check_cells("mixing", n);
}

/// The initial state: shocked air, air and sulphur hexafluoride, in the frame in which the interface will be
/// at rest.
class Start {
 public:
  Start(const MixingOptions& options, const Box3& box)
      : shock_(mixing_shock(options.mach)),
        size_(box.size().z / static_cast<double>(options.cells[2])),
        ripples_(options.cells, size_, options.seed,
                 options.ripples * std::min(std::max(box.size().x, box.size().y), box.size().z)) {
    const double interface = mixing_place() + shock_.velocity * mixing_strike_time(options.mach);
    shock_place_ = interface - kApproach * kMixingLength;
    place_ = interface;
  }

  [[nodiscard]] FlowCell<2> cell(std::size_t i, std::size_t j, std::size_t k) const {
    const double low = static_cast<double>(k) * size_;
    const bool is_shocked = low + 0.5 * size_ < shock_place_;
    FlowCell<2> cell;
    cell.densities = {is_shocked ? shock_.shock_density : kGases[kAir].density,
                      kGases[kHexafluoride].density};
    cell.pressure = is_shocked ? shock_.shock_pressure : kPressure;
    cell.velocity.z = (is_shocked ? shock_.shock_velocity : 0) - shock_.velocity;
    // Ripples that would reach through the shock are cut off.
    const double above = is_shocked ? 0 : ripples_.part_above(i, j, (low - place_) / size_);
    cell.fractions = {1 - above, above};
    return cell;
  }

 private:
  ShockedInterface shock_;
  double size_;  ///< size of a cell
  Ripples ripples_;
  double shock_place_ = 0, place_ = 0;
};

FlowSolver<2> make_solver(const MixingOptions& options) {
  check(options);
  FlowProblem<2> problem = mixing_problem(options);
  const Start start(options, problem.box);
  return {"mixing", std::move(problem),
          [&start](std::size_t i, std::size_t j, std::size_t k) { return start.cell(i, j, k); }};
}

double heat_at_constant_volume(std::size_t gas) {
  const RestingGas& g = kGases[gas];
  return kPressure / (g.density * kTemperature) * g.gas.inverse();
}

double entropy(std::size_t gas, double pressure, double density) {
  return heat_at_constant_volume(gas) *
         (std::log(pressure / kPressure) - kGases[gas].gas.gamma * std::log(density / kGases[kAir].density));
}

}  // namespace

ShockedInterface mixing_shock(double mach) {
  return strike_interface(kGases[kAir], kGases[kHexafluoride], kPressure, mach);
}

double mixing_place() { return kPlace * kMixingLength; }

double mixing_strike_time(double mach) { return kApproach * kMixingLength / mixing_shock(mach).shock_speed; }

MixingFlow::MixingFlow(const MixingOptions& options)
    : solver_(make_solver(options)), passings_(find_passings(options.mach)) {}

/// A shock passes its end when it comes to the last cell. If the state outside were set later, it would be
/// that of the last cell while the shock, which is some cells wide, leaves, and a wave would be reflected.
std::vector<MixingFlow::Passing> MixingFlow::find_passings(double mach) const {
  const double cell = kMixingLength / static_cast<double>(solver_.problem().cells[2]);
  const ShockedInterface shock = mixing_shock(mach);
  FlowCell<2> back, through;
  back.fractions[kAir] = through.fractions[kHexafluoride] = 1;
  back.densities = through.densities = {shock.reflected_density, shock.through_density};
  back.pressure = through.pressure = shock.pressure;
  const double struck = mixing_strike_time(mach);
  std::vector<Passing> passings{
      {struck + (mixing_place() - cell) / (shock.velocity - shock.reflected_speed), 0, back},
      {struck + (kMixingLength - mixing_place() - cell) / (shock.through_speed - shock.velocity), 1,
       through}};
  std::sort(passings.begin(), passings.end(),
            [](const Passing& a, const Passing& b) { return a.time > b.time; });
  return passings;
}

void MixingFlow::advance_to(double time, Progress& progress) {
  while (!passings_.empty() && passings_.back().time <= time) {
    const Passing next = passings_.back();
    passings_.pop_back();
    solver_.advance_to(next.time, progress);
    solver_.set_beyond(2, next.end, next.behind);
  }
  solver_.advance_to(time, progress);
}

double mixing_density(const FlowCell<2>& cell) {
  double density = 0;
  for (std::size_t gas = 0; gas < 2; ++gas) density += cell.fractions[gas] * cell.densities[gas];
  return density;
}

double mixing_entropy(const FlowCell<2>& cell) {
  double total = 0;
  for (std::size_t gas = 0; gas < 2; ++gas) {
    const double mass = cell.fractions[gas] * cell.densities[gas];
    if (mass > 0) total += mass * entropy(gas, cell.pressure, cell.densities[gas]);
  }
  return total / mixing_density(cell);
}

MixingRange mixing_density_range(double mach) { return {0, 1.4 * mixing_shock(mach).through_density}; }

MixingRange mixing_entropy_range(double mach) {
  const ShockedInterface shock = mixing_shock(mach);
  const double least = entropy(kHexafluoride, kPressure, kGases[kHexafluoride].density),
               most = entropy(kAir, shock.pressure, shock.reflected_density);
  const double room = 0.1 * (most - least);
  return {least - room, most + room};
}

}  // namespace adamas::datasets
