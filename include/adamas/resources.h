#pragma once

#include <cstddef>

#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// Returns the processor seconds, user and system, of all threads of this process so far, and of the programs
/// that it started and that have ended.
double processor_seconds();
/// Returns the greatest resident memory of this process so far, in bytes.
std::size_t peak_memory_bytes();

}  // namespace adamas
