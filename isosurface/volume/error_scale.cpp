#include "isosurface/volume/error_scale.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "core/lattice/diamond_type.h"

namespace adamas::isosurface {

ErrorScale::ErrorScale(double greatest) {
  ADAMAS_ASSERT(greatest >= 0 && std::isfinite(greatest));
  constexpr int kLast = kCodes - 1;
  // Powers of two are exact: the scale is the same wherever it is computed from the same number.
  constexpr std::array<double, 4> kParts{1, 0.8408964152537145, 0.7071067811865476, 0.5946035575013605};
  for (int code = 1; code < kCodes; ++code) {
    const int steps = kLast - code;
    errors_[static_cast<std::size_t>(code)] =
        std::ldexp(greatest * kParts[static_cast<std::size_t>(steps % 4)], -(steps / 4));
  }
}

std::uint8_t ErrorScale::encode(double error) const {
  if (!(error <= errors_.back())) return kCodes - 1;
  return static_cast<std::uint8_t>(std::lower_bound(errors_.begin(), errors_.end(), error) - errors_.begin());
}

double world_diameter(const std::array<LatticePoint, 4>& corners, const Vec3& spacing) {
  double greatest = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const LatticePoint edge = corners[a] - corners[b];
      // Squares of very small or large spacings may underflow or overflow.
      greatest = std::max(greatest, std::hypot(edge.i * spacing.x, edge.j * spacing.y, edge.k * spacing.z));
    }
  }
  return greatest;
}

ErrorScale lod_error_scale(const Vec3& spacing, int lod) {
  double greatest = 0;
  for (const DiamondType& type : kDiamondTypes) {
    for (std::size_t slot = 0; slot < static_cast<std::size_t>(type.tetrahedron_count); ++slot) {
      const std::size_t next = (slot + 1) % static_cast<std::size_t>(type.tetrahedron_count);
      greatest = std::max(
          greatest,
          world_diameter({-type.direction, type.direction, type.ring[slot], type.ring[next]}, spacing));
    }
  }
  // The factor is a power of two: see error_class().
  return ErrorScale(std::ldexp(greatest, lod));
}

}  // namespace adamas::isosurface
