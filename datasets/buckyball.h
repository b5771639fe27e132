#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/volume.h"

namespace adamas::datasets {

/// The vertices of a truncated icosahedron in the cube [-1, 1]^3, rotated so that none of its planes of
/// symmetry is parallel to a side.
std::array<Vec3, 60> buckyball_atoms();

/// A sum of Gaussians at the atoms, scaled to at most 1, at a point of that cube.
double buckyball_value(const Vec3& point);

/// buckyball_value sampled on a grid that spans the cube. The side of the cube has as many steps as the axis
/// with the most samples (so the spacing is 1); along an axis with one sample, that lies in the middle. For
/// types of whole numbers, values from 0 to 1 become 0 to the greatest of the type, rounded; float32 has the
/// values.
class Buckyball {
 public:
  static constexpr std::uint64_t kMostSamples = 65536;  ///< the limit along each axis

  /// Throws Error if an axis has none or more than kMostSamples.
  Buckyball(const std::array<std::uint64_t, 3>& dimensions, SampleType type);

  [[nodiscard]] const VolumeGrid& grid() const { return grid_; }
  /// Computes the samples of plane k, grid().plane_bytes() bytes in the machine's byte order, in parallel;
  /// they are the same on any number of threads.
  void plane(std::uint64_t k, std::span<std::byte> samples) const;

 private:
  [[nodiscard]] double coordinate(std::size_t axis, std::uint64_t i) const;
  /// Adds the Gaussians along a row through (y, z).
  void add_row(double y, double z, std::span<double> row) const;

  VolumeGrid grid_;
  std::array<Vec3, 60> atoms_;
  double scale_ = 1;               ///< it makes the greatest value 1
  std::vector<double> gaussians_;  ///< factors along x: a row per atom
};

}  // namespace adamas::datasets
