#pragma once

#include <cstdint>
#include <string>

#include "cli/command.h"
#include "cli/figures.h"
#include "isosurface/storage/store_format.h"

namespace adamas {

/// A table of what the bytes of a store are.
void print_store_bytes(std::uint64_t uncompressed, const StoreBytes& bytes, std::uint64_t file_bytes,
                       Console& console);

/// What a store is, as `info` tells it.
Figures print_store(const std::string& path, Session& session);

}  // namespace adamas
