#pragma once

#include <filesystem>
#include <string>

namespace adamas::cli {

/// The program adamas-reference. Throws Error, which begins with `what` needs it, where it is not there, and
/// where this build is without it.
std::filesystem::path find_reference_program(const std::string& what);

}  // namespace adamas::cli
