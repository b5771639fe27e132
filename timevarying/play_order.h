#pragma once

#include <cstdint>
#include <vector>

#include "adamas/play.h"

namespace adamas::timevarying {

/// The steps from `first` to `last` in an order, repeated `times` times. A random order has as many steps,
/// each chosen at random from these, and is the same for the same seed.
std::vector<std::uint32_t> steps_in_order(PlayOrder order, std::uint32_t first, std::uint32_t last,
                                          std::uint32_t times = 1, std::uint64_t seed = 0);

}  // namespace adamas::timevarying
