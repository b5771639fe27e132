#pragma once

#include <array>
#include <optional>
#include <span>

#include "interfaces/mesh_reconstruction/mesh_subdivision.h"

namespace adamas::interfaces {

/// A layer of even thickness, bent a little, seen from the centre of a cell.
struct MeshLayer {
  Vec3 normal;        ///< of unit length
  double middle = 0;  ///< the height of the layer's middle above the centre, along the normal
  double thickness = 0;
  /// The second derivatives of that height across the normal: xx, yy, zz, xy, xz, yz.
  std::array<double, 6> bend{};

  /// The height above the layer's middle of the point at d from the centre.
  [[nodiscard]] double height(const Vec3& d) const {
    const double bent = 0.5 * (bend[0] * d.x * d.x + bend[1] * d.y * d.y + bend[2] * d.z * d.z) +
                        bend[3] * d.x * d.y + bend[4] * d.x * d.z + bend[5] * d.y * d.z;
    return dot(normal, d) - middle - bent;
  }
};

/// The parts of a cell that lie in a layer, and beyond it on the side to which its normal points. `center`:
/// the place from which the layer is seen.
struct LayerParts {
  double inside = 0, above = 0;
};
LayerParts parts_of_cell(const MeshSubdivision& subdivision, std::uint32_t cell, const MeshLayer& layer,
                         const Vec3& center);

/// Returns the least distance of a cell's centre from the planes of its faces.
double inner_radius(const PolyhedralMesh& mesh, std::uint32_t cell);

/// Fits a layer to the fractions in cells round a cell, by least squares; `cells`: that cell among them.
/// `fractions`: by cell of the list. Returns none if no layer fits well, or if it is so thick or so far away
/// that these cells do not show both its sides.
std::optional<MeshLayer> fit_layer(const MeshSubdivision& subdivision, std::uint32_t cell,
                                   std::span<const std::uint32_t> cells, std::span<const double> fractions);

}  // namespace adamas::interfaces
