#include "datasets/flow/impact.h"

#include "core/base/error.h"

namespace adamas {

bool holds_impact(const Box3& box) {
  return box.min.x <= 0 && box.max.x > 0 && box.min.y <= 0 && box.max.y > 0 && box.min.z < 0 && box.max.z > 0;
}

namespace datasets {

namespace {

constexpr std::size_t kProjectile = 0, kBlock = 1, kEmpty = 2;
// Densities are in g/cm3, speeds of sound in cm/us, then slopes of the Hugoniot: S. P. Marsh, LASL Shock
// Hugoniot Data, University of California Press 1980.
constexpr double kTungsten = 19.22, kTungstenSound = 0.403, kTungstenSlope = 1.237;
constexpr double kTantalum = 16.654, kTantalumSound = 0.3414, kTantalumSlope = 1.201;
// Density and pressure of air at one bar.
constexpr double kAir = 1e-3, kAmbient = 1e-6;
// Sizes of the projectile and of the block, in cm.
constexpr double kRadius = 1, kHeight = 1.6, kHalfWidth = 9;
/// The number of strips over which the projectile's part of a cell is summed.
constexpr int kStrips = 64;

double overlap(double low, double high, double from, double to) {
  return std::max(0.0, std::min(high, to) - std::max(low, from));
}

/// The area of the part of a disc round the origin within a rectangle.
double disc_area(double radius, double x0, double x1, double y0, double y1) {
  double area = 0;
  const double width = (x1 - x0) / kStrips;
  for (int strip = 0; strip < kStrips; ++strip) {
    const double x = x0 + (strip + 0.5) * width;
    const double half = std::sqrt(std::max(0.0, radius * radius - x * x));
    area += width * overlap(y0, y1, -half, half);
  }
  return area;
}

FlowProblem<3> impact_problem(const ImpactOptions& options) {
  FlowProblem<3> problem;
  problem.box = options.box;
  problem.cells = options.cells;
  problem.materials[kProjectile] = {"projectile", gas_of_hugoniot(kTungsten, kTungstenSound, kTungstenSlope)};
  problem.materials[kBlock] = {"block", gas_of_hugoniot(kTantalum, kTantalumSound, kTantalumSlope)};
  problem.materials[kEmpty] = {"empty", {1.4, 0}};
  const auto low = [](double from) { return from == 0 ? FlowBoundary::kMirror : FlowBoundary::kOutflow; };
  problem.boundaries = {{{low(options.box.min.x), FlowBoundary::kOutflow},
                         {low(options.box.min.y), FlowBoundary::kOutflow},
                         {FlowBoundary::kOutflow, FlowBoundary::kOutflow}}};
  problem.opening = VoidOpening{kEmpty, kAmbient, 100 * kAir};
  return problem;
}

}  // namespace

FlowSolver<3> make_impact(const ImpactOptions& options) {
  const Box3& box = options.box;
  if (!holds_impact(box)) {
    fail(
        "impact: expected a box that holds the place of the impact, (0, 0, 0), found [{}, {}] x [{}, {}] x "
        "[{}, {}]",
        box.min.x, box.max.x, box.min.y, box.max.y, box.min.z, box.max.z);
  }
  if (!(options.speed > 0 && options.speed <= kGreatestImpactSpeed)) {
    fail("impact: expected a speed above 0 and up to {} cm/us, found {}", kGreatestImpactSpeed,
         options.speed);
  }
  const Vec3 size{box.size().x / static_cast<double>(options.cells[0]),
                  box.size().y / static_cast<double>(options.cells[1]),
                  box.size().z / static_cast<double>(options.cells[2])};
  return {"impact", impact_problem(options), [&](std::size_t i, std::size_t j, std::size_t k) {
            const double x = box.min.x + static_cast<double>(i) * size.x,
                         y = box.min.y + static_cast<double>(j) * size.y,
                         z = box.min.z + static_cast<double>(k) * size.z;
            const double volume = size.x * size.y * size.z;
            FlowCell<3> cell;
            cell.fractions[kProjectile] = disc_area(kRadius, x, x + size.x, y, y + size.y) *
                                          overlap(z, z + size.z, 0, kHeight) / volume;
            cell.fractions[kBlock] = overlap(x, x + size.x, -kHalfWidth, kHalfWidth) *
                                     overlap(y, y + size.y, -kHalfWidth, kHalfWidth) *
                                     overlap(z, z + size.z, box.min.z, 0) / volume;
            cell.fractions[kEmpty] = std::max(0.0, 1 - cell.fractions[kProjectile] - cell.fractions[kBlock]);
            cell.densities = {kTungsten, kTantalum, kAir};
            cell.pressure = kAmbient;
            // Materials that share a cell share the projectile's momentum.
            const double moving = cell.fractions[kProjectile] * kTungsten;
            const double resting = cell.fractions[kBlock] * kTantalum + cell.fractions[kEmpty] * kAir;
            cell.velocity.z = -options.speed * moving / (moving + resting);
            return cell;
          }};
}

}  // namespace datasets

}  // namespace adamas
