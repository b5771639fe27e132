#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "adamas/error_target.h"
#include "adamas/series.h"
#include "adamas/volume_store.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "isosurface/storage/stored_pages.h"
#include "timevarying/restore_steps.h"

namespace adamas::cli {

/// The options that all commands on stores have.
struct StoreInput {
  std::string path, step, memory = "256M", paging = "read";
};

void add_store_input(const Command& command, StoreInput& input);
/// --step, of commands that look at one step of a series.
void add_step_option(const Command& command, StoreInput& input);
/// The step that was asked for by --step; the first one where none was, with a note that it is that.
/// Throws Error (kUsage) where the store has no such.
std::uint32_t wanted_step(const StoreInput& input, const isosurface::StoreFile& file, Session& session);

/// The steps of --steps A,B, both included; all where that is empty. Throws Error (kUsage) where the store
/// has no such.
timevarying::StepRange wanted_steps(const std::string& steps, const StoreInput& input,
                                    const isosurface::StoreFile& file);

/// What pictures of a step of a series have in their titles: "time 0.25, step 3".
std::string step_title(double time, std::size_t step);

/// The options of --memory and --paging. Throws Error (kUsage).
OpenOptions open_options(const StoreInput& input);
/// Bytes that decoded pages may take.
std::size_t store_memory(const StoreInput& input);
std::unique_ptr<isosurface::StoreFile> open_store(const StoreInput& input, Session& session);

/// Whether a file is a store, by its name.
bool is_store(const std::string& path);

/// "0.7", "0.7voxels" or "0.1%": an error in units of length, in the least spacing, or of the data's
/// diagonal.
/// Throws Error (kUsage).
double parse_surface_error(const std::string& text, const VolumeGrid& grid);
/// Reads such an error as it is written. Throws Error (kUsage).
ErrorTarget parse_surface_error(const std::string& option, const std::string& text);

/// Adds how many pages and bytes were read to the figures of a run.
void add_page_counts(const isosurface::PageCounts& counts, Figures& figures);

}  // namespace adamas::cli
