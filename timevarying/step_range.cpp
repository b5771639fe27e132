#include "timevarying/step_range.h"

#include "core/base/error.h"

namespace adamas::timevarying {

void check_steps(const std::array<std::uint32_t, 2>& steps, std::size_t count, const std::string& series) {
  if (steps[0] <= steps[1] && steps[1] < count) return;
  wrong_usage("--steps: expected two of the {} steps of {}, from 0 on, A,B with A up to B, found '{},{}'",
              count, series, steps[0], steps[1]);
}

}  // namespace adamas::timevarying
