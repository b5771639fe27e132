#include "tests/benchmarks/support/turbulence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "adamas/geometry.h"
#include "core/base/parallel.h"
#include "datasets/random_numbers.h"

namespace adamas::bench {

using namespace datasets;

namespace {

/// The number of cells of the coarsest lattice along a side of the box.
constexpr double kCoarsestCells = 4;
/// The factor from one octave to the next. The energy of an octave is that of wave numbers from k to 2k, so
/// it is proportional to k^(-2/3).
constexpr double kAmplitudeFactor = 0.7937005259840998;  // 2^(-1/3)

/// Rotates by a quaternion of whole numbers, after which no plane of lattice points is parallel to a side.
/// Otherwise the prediction of a sample from its neighbours would coincide with the interpolation in the
/// lattice.
Vec3 turned(const Vec3& p) {
  const double w = 5;
  const Vec3 v{2, -3, 1};
  const Vec3 t = (2 / (w * w + squared_norm(v))) * cross(v, p);
  return p + w * t + cross(v, t);
}

/// Returns a random number, uniform in [-1, 1).
double lattice_value(std::uint64_t octave, std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto bits = [](std::int64_t n) { return static_cast<std::uint64_t>(n) & 0xffffu; };
  return RandomNumbers(octave << 48 | bits(x) << 32 | bits(y) << 16 | bits(z)).uniform(-1, 1);
}

/// Returns a smooth step from 0 to 1 whose first two derivatives vanish at either end.
double smooth(double t) { return t * t * t * (t * (6 * t - 15) + 10); }

double between(double a, double b, double weight) { return a + weight * (b - a); }

double octave_value(std::uint64_t octave, const Vec3& p) {
  std::array<std::int64_t, 3> cell{};
  Vec3 weight;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = std::floor(p[static_cast<int>(axis)]);
    cell[axis] = static_cast<std::int64_t>(low);
    weight[static_cast<int>(axis)] = smooth(p[static_cast<int>(axis)] - low);
  }
  const auto along_x = [&](std::int64_t y, std::int64_t z) {
    return between(lattice_value(octave, cell[0], y, z), lattice_value(octave, cell[0] + 1, y, z), weight.x);
  };
  const auto along_y = [&](std::int64_t z) {
    return between(along_x(cell[1], z), along_x(cell[1] + 1, z), weight.y);
  };
  return between(along_y(cell[2]), along_y(cell[2] + 1), weight.z);
}

double value(Vec3 p, double finest_cells) {
  double sum = 0, amplitude = 1;
  std::uint64_t octave = 0;
  for (double cells = kCoarsestCells; cells <= finest_cells; cells *= 2) {
    p = turned(p);
    sum += amplitude * octave_value(octave++, p);
    p = 2 * p;
    amplitude *= kAmplitudeFactor;
  }
  return sum;
}

}  // namespace

std::vector<float> turbulence(std::uint64_t side) {
  std::vector<float> values(side * side * side);
  const double cell = kCoarsestCells / static_cast<double>(side);
  parallel_for(side * side, side, [&](std::size_t row) {
    const double y = cell * static_cast<double>(row % side), z = cell * static_cast<double>(row / side);
    for (std::uint64_t i = 0; i < side; ++i)
      values[row * side + i] =
          static_cast<float>(value({cell * static_cast<double>(i), y, z}, static_cast<double>(side)));
  });
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  const float low = *least, range = *greatest - *least;
  if (range > 0)
    for (float& v : values) v = (v - low) / range;
  return values;
}

}  // namespace adamas::bench
