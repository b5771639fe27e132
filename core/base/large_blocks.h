#pragma once

#include <cstddef>

#include "core/base/large_pages.h"

namespace adamas {

/// A block of kLargePage bytes, aligned to as many, with anything in it: one that was given back where there
/// is one, since memory that the system has to provide takes longer to get than to fill. May be called by
/// several threads at once.
std::byte* take_large_block();
void give_large_block(std::byte* block);

}  // namespace adamas
