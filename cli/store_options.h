#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "cli/command.h"
#include "cli/figures.h"
#include "isosurface/storage/stored_pages.h"

namespace adamas {

/// The options that all commands on stores have.
struct StoreInput {
  std::string path, memory = "256M", paging = "read";
};

void add_store_input(const Command& command, StoreInput& input);

/// Bytes that decoded pages may take.
std::size_t store_memory(const StoreInput& input);
std::unique_ptr<StoreFile> open_store(const StoreInput& input, Session& session);

/// Whether a file is a store, by its name.
bool is_store(const std::string& path);

/// Adds how many pages and bytes were read to the figures of a run.
void add_page_counts(const PageCounts& counts, Figures& figures);

}  // namespace adamas
