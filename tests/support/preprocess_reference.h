#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/volume.h"
#include "core/lattice/lattice_point.h"
#include "isosurface/volume/error_scale.h"

namespace adamas::test {

using namespace isosurface;

/// A small volume: samples as numbers and as ordered words, i running fastest.
struct ReferenceVolume {
  VolumeGrid grid;
  std::vector<double> values;
  std::vector<std::uint32_t> words;

  [[nodiscard]] LatticePoint last() const {
    const auto at = [this](std::size_t axis) { return static_cast<std::int32_t>(grid.dimensions[axis] - 1); };
    return {at(0), at(1), at(2)};
  }
  [[nodiscard]] std::size_t index(LatticePoint p) const {
    const LatticePoint n = last() + LatticePoint{1, 1, 1};
    return static_cast<std::size_t>(p.i) +
           static_cast<std::size_t>(n.i) * (static_cast<std::size_t>(p.j) +
                                            static_cast<std::size_t>(n.j) * static_cast<std::size_t>(p.k));
  }
  [[nodiscard]] bool contains(LatticePoint p) const;
  /// Returns the value of the nearest sample.
  [[nodiscard]] double value(LatticePoint p) const;
};

/// What is stored of a diamond: bounds of its error's code, which differ where the error is near that of a
/// code, and its range as words.
struct ReferenceValues {
  double own = 0;
  std::uint8_t least_code = 0, greatest_code = 0;
  std::uint32_t low = ~0u, high = 0;
};

/// Errors and ranges of all diamonds of a volume by their definition: every sample of a tetrahedron's
/// bounding box is tried with integer barycentric coordinates, and every diamond looks at its children.
class PreprocessReference {
 public:
  explicit PreprocessReference(const ReferenceVolume& volume);

  [[nodiscard]] int depth() const { return depth_; }
  /// Returns the diamonds whose intersection with the data is more than a side.
  [[nodiscard]] const std::map<LatticePoint, ReferenceValues>& diamonds() const { return diamonds_; }
  /// Returns the child diamonds in the lattice.
  [[nodiscard]] std::vector<LatticePoint> children(LatticePoint p) const;
  /// Returns the volume's scale of errors at an LOD.
  [[nodiscard]] const ErrorScale& scale(int lod) const;

 private:
  using Corners = std::array<LatticePoint, 4>;

  [[nodiscard]] bool in_lattice(LatticePoint p) const;
  [[nodiscard]] bool exists(LatticePoint p) const;
  [[nodiscard]] std::vector<Corners> tetrahedra(LatticePoint p) const;
  /// Returns the tetrahedron's own error, and extends the range by its samples.
  double measure(const Corners& corners, ReferenceValues& values) const;
  void add(LatticePoint p);

  const ReferenceVolume& volume_;
  int depth_ = 0;
  std::map<LatticePoint, ReferenceValues> diamonds_;
  mutable std::map<int, ErrorScale> scales_;  ///< the scales that were asked for so far
};

}  // namespace adamas::test
