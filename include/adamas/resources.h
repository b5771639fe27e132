#pragma once

#include <cstddef>

#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// Returns the processor seconds, user and system, of all threads of this process so far, and of the programs
/// that it started and that have ended.
double processor_seconds();
/// Returns the greatest resident memory of this process so far, in bytes.
std::size_t peak_memory_bytes();
/// Returns the memory, in bytes, that the system says can be had without swapping: what is free, and what it
/// would give up; no more than the limit of the control group leaves. 0 where the system does not say.
std::size_t available_memory_bytes();
/// Limits what this process, and programs that it starts, may allocate from now on; 0: no limit. What exceeds
/// it throws std::bad_alloc. Does nothing in a library that is built with an address or thread sanitizer.
void limit_memory(std::size_t bytes);

}  // namespace adamas
