#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "adamas/error_target.h"
#include "adamas/volume_store.h"
#include "cli/command.h"
#include "cli/figures.h"

namespace adamas::cli {

/// The common options of commands on stores.
struct StoreInput {
  std::string path;
  std::optional<std::uint64_t> step{};  ///< --step
  OpenOptions open{};
};

void add_store_input(const Command& command, StoreInput& input);
/// Adds --memory, which says how many bytes decoded pages may take.
CommandOption add_memory_option(const Command& command, std::size_t& bytes, const std::string& description);
/// Adds --step, for commands that read one step of a series.
void add_step_option(const Command& command, StoreInput& input);
/// "0.7", "0.7voxels" or "0.1%": an error in units of length, in the least spacing, or of the data's
/// diagonal; at least 0.
ErrorTarget parse_surface_error(const std::string& option, const std::string& text);

/// Adds the numbers of pages and bytes that were read to the figures of a run.
void add_page_counts(const PageReads& reads, Figures& figures);

/// "float32", or "float64 (shown as float32)" where samples are of another type than the numbers that they
/// are read from.
std::string type_text(SampleType samples, StoredType numbers);

/// Prints a table of the parts of a store by bytes, or of the steps that were added to it. `all`: the name of
/// the last row, which has `all_bytes`.
void print_store_bytes(std::uint64_t uncompressed, const StoredBytes& bytes, std::uint64_t all_bytes,
                       Console& console, const std::string& all = "file");

}  // namespace adamas::cli
