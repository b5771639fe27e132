#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/lattice/lattice_point.h"

namespace adamas::isosurface {

/// The 24 tetrahedra of phase 2 and scale 8 that a cube of 16^3 cells consists of. Every larger one consists
/// of such. Coordinates are relative to the cube's first corner, for a cube whose own first split runs from
/// there; in other cubes they are mirrored.
class LeafPoints {
 public:
  static constexpr std::size_t kLeaves = 24;
  static constexpr std::size_t kPadding = 8;

  struct Leaf {
    std::array<LatticePoint, 4> corners;
    LatticePoint split_vertex;
    std::uint32_t first, last;  ///< points: a multiple of kPadding, filled up by repeating one
  };

  LeafPoints();

  [[nodiscard]] const std::vector<Leaf>& leaves() const { return leaves_; }
  /// Coordinates of the points: one list per axis.
  template <class Real>
  [[nodiscard]] const Real* coordinates(int axis) const {
    if constexpr (sizeof(Real) == sizeof(float)) {
      return floats_[static_cast<std::size_t>(axis)].data();
    } else {
      return doubles_[static_cast<std::size_t>(axis)].data();
    }
  }
  /// Places of the points among the cube's 17^3, with the axes mirrored whose bit is set in `mirrored`.
  [[nodiscard]] const std::uint16_t* places(int mirrored) const {
    return places_[static_cast<std::size_t>(mirrored)].data();
  }

 private:
  void add(LatticePoint p);

  std::vector<Leaf> leaves_;
  std::array<std::vector<float>, 3> floats_;
  std::array<std::vector<double>, 3> doubles_;
  std::array<std::vector<std::uint16_t>, 8> places_;
};

}  // namespace adamas::isosurface
