#pragma once

#include <cstddef>
#include <optional>

#include "cli/command.h"

namespace adamas::cli {

/// Adds --memory, which says how much memory a command may take.
void add_memory_limit(const Command& command, std::optional<std::size_t>& bytes);
/// Returns the memory that a command may take: what is wanted, else half of what is free; 0 where there is no
/// limit since the system does not say. From now on, allocations beyond it throw std::bad_alloc.
std::size_t begin_memory_limit(const std::optional<std::size_t>& wanted, Session& session);

}  // namespace adamas::cli
