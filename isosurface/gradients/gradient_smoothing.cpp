#include "isosurface/gradients/gradient_smoothing.h"

#include <algorithm>

#include "core/base/assert.h"

namespace adamas::isosurface {

void GradientSmoother::add(std::span<const Gradient> plane) {
  empty_ = false;
  rounds_.note(plane);
  run(0, plane);
}

void GradientSmoother::finish() {
  if (empty_) return;
  for (std::size_t n = 0; n < rounds_.count(); ++n) run(n + 1, rounds_.finish(n));
}

std::size_t smooth_gradients(std::span<Gradient> gradients, const std::array<std::size_t, 3>& dimensions,
                             const GradientSmoothingOptions& options, Progress& progress) {
  const auto [ni, nj, nk] = dimensions;
  ADAMAS_ASSERT(gradients.size() == ni * nj * nk);
  if (gradients.empty()) return 0;
  GradientScale scale;
  scale.add(gradients);
  auto next = gradients.begin();
  std::size_t degenerate = 0;
  // A plane is handed over after it has been read; without rounds it is the same one.
  GradientSmoother smoother(scale, ni, nj, options, [&](std::span<const Gradient> plane) {
    if (plane.data() != &*next) std::copy(plane.begin(), plane.end(), next);
    next += static_cast<std::ptrdiff_t>(plane.size());
    for (const Gradient& g : plane) degenerate += squared_length(g) > scale.least_square() ? 0 : 1;
  });
  for (std::size_t k = 0; k < nk; ++k) {
    progress.step("smoothing gradients", static_cast<double>(k) / static_cast<double>(nk));
    smoother.add(gradients.subspan(k * ni * nj, ni * nj));
  }
  smoother.finish();
  return degenerate;
}

}  // namespace adamas::isosurface
