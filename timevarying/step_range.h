#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace adamas::timevarying {

/// Throws Error (kUsage), which names the option --steps, unless the first and the last step are among the
/// `count` steps of a series, in this order. The message calls the series `series`.
void check_steps(const std::array<std::uint32_t, 2>& steps, std::size_t count, const std::string& series);

}  // namespace adamas::timevarying
