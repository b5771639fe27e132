#include "timevarying/play_order.h"

#include <algorithm>
#include <random>

#include "core/base/assert.h"

namespace adamas::timevarying {

std::vector<std::uint32_t> steps_in_order(PlayOrder order, std::uint32_t first, std::uint32_t last,
                                          std::uint32_t times, std::uint64_t seed) {
  ADAMAS_ASSERT(first <= last);
  const std::uint32_t count = last - first + 1;
  std::vector<std::uint32_t> steps;
  std::mt19937_64 random(seed);
  for (std::uint32_t time = 0; time < times; ++time) {
    for (std::uint32_t n = 0; n < count; ++n) {
      switch (order) {
        case PlayOrder::kForward:
        case PlayOrder::kThereAndBack:
          steps.push_back(first + n);
          break;
        case PlayOrder::kBackward:
          steps.push_back(last - n);
          break;
        case PlayOrder::kRandom:
          steps.push_back(first + static_cast<std::uint32_t>(random() % count));
          break;
      }
    }
    if (order != PlayOrder::kThereAndBack) continue;
    for (std::uint32_t n = 1; n + 1 < count; ++n) steps.push_back(last - n);
  }
  return steps;
}

}  // namespace adamas::timevarying
