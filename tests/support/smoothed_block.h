#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "core/base/assert.h"
#include "isosurface/gradients/gradient_smoothing.h"

namespace adamas::test {

/// Smooths dimensions[0] x dimensions[1] x dimensions[2] finite gradients, i running fastest, in place by a
/// GradientSmoother. Returns the number of gradients that are still degenerate.
inline std::size_t smooth_gradients(std::span<isosurface::Gradient> gradients,
                                    const std::array<std::size_t, 3>& dimensions,
                                    const isosurface::GradientSmoothingOptions& options = {}) {
  using namespace isosurface;
  const auto [ni, nj, nk] = dimensions;
  ADAMAS_ASSERT(gradients.size() == ni * nj * nk);
  if (gradients.empty()) return 0;
  GradientScale scale;
  scale.add(gradients);
  auto next = gradients.begin();
  std::size_t degenerate = 0;
  // A plane is handed over after it has been read. Without rounds it is the same plane.
  GradientSmoother smoother(scale, ni, nj, options, [&](std::span<const Gradient> plane) {
    if (plane.data() != &*next) std::copy(plane.begin(), plane.end(), next);
    next += static_cast<std::ptrdiff_t>(plane.size());
    for (const Gradient& g : plane) degenerate += squared_length(g) > scale.least_square() ? 0 : 1;
  });
  for (std::size_t k = 0; k < nk; ++k) {
    smoother.add(gradients.subspan(k * ni * nj, ni * nj));
  }
  smoother.finish();
  return degenerate;
}

}  // namespace adamas::test
