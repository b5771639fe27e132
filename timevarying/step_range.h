#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace adamas::timevarying {

/// Throws Error (kUsage), which names the option --steps, unless the first and the last of some steps are two
/// of the `count` steps of a series, in this order. `series`: what the message calls it.
void check_steps(const std::array<std::uint32_t, 2>& steps, std::size_t count, const std::string& series);

}  // namespace adamas::timevarying
