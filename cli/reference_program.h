#pragma once

#include <filesystem>

namespace adamas {

/// The program that runs other mesh generators: where the variable ADAMAS_REFERENCE_PROGRAM says, or beside
/// the running program, or where it is installed. Throws Error where there is none.
std::filesystem::path find_reference_program();

}  // namespace adamas
