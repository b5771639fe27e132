#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "adamas/play.h"

namespace adamas::timevarying {

/// The steps from `first` to `last` in an order, repeated `times` times. A random order has as many steps,
/// each chosen at random from these, and is the same for the same seed.
std::vector<std::uint32_t> steps_in_order(PlayOrder order, std::uint32_t first, std::uint32_t last,
                                          std::uint32_t times = 1, std::uint64_t seed = 0);

/// Throws Error (kUsage), which names the option --steps, unless the first and the last step are among the
/// `count` steps of a series, in this order. The message calls the series `series`.
void check_steps(const std::array<std::uint32_t, 2>& steps, std::size_t count, const std::string& series);

}  // namespace adamas::timevarying
