#include "datasets/buckyball.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/parallel.h"

namespace adamas::datasets {

namespace {

/// The distance of the atoms from the centre, and the width of the Gaussians: at 512^3 samples the
/// isovalues 20.5, 80.5 and 160.5 of 255 have about 3.0, 2.05 and 0.79 million triangles (merged tubes,
/// touching balls, balls).
constexpr double kRadius = 0.722, kDeviation = 0.0754;
/// A Gaussian is less than the round-off of 1 beyond this many deviations.
constexpr double kReach = 8.5;

double gaussian(double squared_distance) {
  return std::exp(squared_distance / (-2 * kDeviation * kDeviation));
}

/// Rotates a point by a quaternion with an arbitrary axis and angle.
Vec3 turned(const Vec3& p) {
  const double w = 0.9;
  const Vec3 v{0.23, -0.31, 0.17};
  const Vec3 t = 2 * cross(v, p);
  return p + (1 / (w * w + squared_norm(v))) * (w * t + cross(v, t));
}

/// The greatest value of the sum, which is near an atom, slightly inwards because of its neighbours.
double greatest_sum(const std::array<Vec3, 60>& atoms) {
  Vec3 top = atoms[0];
  double sum = 0;
  // Each round moves to the mean of the atoms with their weights there, which increases the sum (mean shift).
  for (int round = 0; round < 30; ++round) {
    Vec3 mean;
    sum = 0;
    for (const Vec3& atom : atoms) {
      const double weight = gaussian(squared_norm(atom - top));
      sum += weight;
      mean += weight * atom;
    }
    top = (1 / sum) * mean;
  }
  return sum;
}

template <class T>
void store(std::span<const double> values, std::byte* samples) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    T sample{};
    if constexpr (std::is_floating_point_v<T>) {
      sample = static_cast<T>(values[i]);
    } else {
      constexpr double kMost = std::numeric_limits<T>::max();
      sample = static_cast<T>(std::min(kMost, std::floor(kMost * values[i] + 0.5)));
    }
    std::memcpy(samples + i * sizeof(T), &sample, sizeof(T));
  }
}

void store(std::span<const double> values, SampleType type, std::byte* samples) {
  switch (type) {
    case SampleType::kUint8:
      return store<std::uint8_t>(values, samples);
    case SampleType::kUint16:
      return store<std::uint16_t>(values, samples);
    case SampleType::kInt16:
      return store<std::int16_t>(values, samples);
    case SampleType::kFloat32:
      return store<float>(values, samples);
  }
}

}  // namespace

std::array<Vec3, 60> buckyball_atoms() {
  // The vertices, at which edges have length 2, are the even permutations of these with any signs (Coxeter).
  constexpr double kPhi = std::numbers::phi;
  constexpr Vec3 kCorners[] = {{0, 1, 3 * kPhi}, {1, 2 + kPhi, 2 * kPhi}, {kPhi, 2, 2 * kPhi + 1}};
  const double scale = kRadius / std::sqrt(9 * kPhi + 10);
  std::array<Vec3, 60> atoms;
  std::size_t count = 0;
  for (const Vec3& corner : kCorners) {
    for (unsigned signs = 0; signs < 8; ++signs) {
      if (corner.x == 0 && (signs & 1u) != 0) continue;
      Vec3 p;
      for (int axis = 0; axis < 3; ++axis) {
        p[axis] = (signs >> static_cast<unsigned>(axis) & 1u) != 0 ? -corner[axis] : corner[axis];
      }
      for (int shift = 0; shift < 3; ++shift) {
        atoms[count++] = scale * turned({p[shift], p[(shift + 1) % 3], p[(shift + 2) % 3]});
      }
    }
  }
  ADAMAS_ASSERT(count == atoms.size());
  return atoms;
}

double buckyball_value(const Vec3& point) {
  const auto atoms = buckyball_atoms();
  double sum = 0;
  for (const Vec3& atom : atoms) sum += gaussian(squared_norm(point - atom));
  return sum / greatest_sum(atoms);
}

Buckyball::Buckyball(const std::array<std::uint64_t, 3>& dimensions, SampleType type)
    : atoms_(buckyball_atoms()), scale_(1 / greatest_sum(atoms_)) {
  for (const std::uint64_t n : dimensions) {
    if (n >= 1 && n <= kMostSamples) continue;
    fail("buckyball: expected from 1 to {} samples along each axis, found {} x {} x {}", kMostSamples,
         dimensions[0], dimensions[1], dimensions[2]);
  }
  grid_.dimensions = dimensions;
  grid_.type = type;
  const auto most = *std::max_element(dimensions.begin(), dimensions.end());
  const double side = most > 1 ? static_cast<double>(most - 1) : 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint64_t n = dimensions[static_cast<std::size_t>(axis)];
    grid_.spacing[axis] = n > 1 ? side / static_cast<double>(n - 1) : side;
    grid_.origin[axis] = n > 1 ? 0 : side / 2;
  }
  gaussians_.resize(atoms_.size() * dimensions[0]);
  for (std::size_t a = 0; a < atoms_.size(); ++a) {
    for (std::uint64_t i = 0; i < dimensions[0]; ++i) {
      const double x = coordinate(0, i) - atoms_[a].x;
      gaussians_[a * dimensions[0] + i] = gaussian(x * x);
    }
  }
}

double Buckyball::coordinate(std::size_t axis, std::uint64_t i) const {
  const std::uint64_t n = grid_.dimensions[axis];
  return n > 1 ? 2 * static_cast<double>(i) / static_cast<double>(n - 1) - 1 : 0;
}

void Buckyball::add_row(double y, double z, std::span<double> row) const {
  const double last = static_cast<double>(row.size() - 1);
  for (std::size_t a = 0; a < atoms_.size(); ++a) {
    const Vec3& atom = atoms_[a];
    const double across = (y - atom.y) * (y - atom.y) + (z - atom.z) * (z - atom.z);
    const double left = kReach * kReach * kDeviation * kDeviation - across;
    if (left <= 0) continue;
    const double reach = std::sqrt(left);
    const double first = std::ceil((atom.x - reach + 1) / 2 * last);
    const double end = std::floor((atom.x + reach + 1) / 2 * last) + 1;
    const auto begin = static_cast<std::size_t>(std::clamp(first, 0.0, last));
    const auto stop = static_cast<std::size_t>(std::clamp(end, 0.0, last + 1));
    const double weight = scale_ * gaussian(across);
    const double* along = gaussians_.data() + a * row.size();
    for (std::size_t i = begin; i < stop; ++i) row[i] += weight * along[i];
  }
}

void Buckyball::plane(std::uint64_t k, std::span<std::byte> samples) const {
  ADAMAS_ASSERT(k < grid_.dimensions[2] && samples.size() == grid_.plane_bytes());
  constexpr std::size_t kRows = 8;
  const double z = coordinate(2, k);
  parallel_chunks(grid_.dimensions[1], kRows, [&](std::size_t begin, std::size_t end) {
    std::vector<double> row(grid_.dimensions[0]);
    for (std::size_t j = begin; j < end; ++j) {
      std::fill(row.begin(), row.end(), 0.0);
      add_row(coordinate(1, j), z, row);
      store(row, grid_.type, samples.data() + j * row.size() * sample_bytes(grid_.type));
    }
  });
}

}  // namespace adamas::datasets
