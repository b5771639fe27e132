#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "adamas/progress.h"
#include "adamas/volume_store.h"
#include "isosurface/storage/restore.h"

namespace adamas::timevarying {

/// Divides steps into groups that are best restored together: no page of a group is coded with a page of
/// another one, unless the group would take more than `memory` at `bytes_each` bytes per step.
std::vector<StepRange> restored_together(const StepRange& steps, std::uint64_t bytes_each,
                                         std::size_t memory);

/// Passes the planes of equal k of a part of one step, in ascending order, to `sink`, as samples of the
/// volume's type. Only pages that the part needs are read. Throws DamagedPage.
PageReads restore_step(isosurface::StoreFile& file, std::uint32_t step, const isosurface::RestoredPart& part,
                       std::size_t memory, const std::function<void(std::span<const std::byte>)>& sink,
                       Progress& progress);

/// Restores a part of several steps. The steps of each group of restored_together() are restored together,
/// one row of pages after another, since the pages that a page is coded with in time have just been decoded.
/// `sink` takes a step and its next plane. Throws DamagedPage.
PageReads restore_steps(isosurface::StoreFile& file, const StepRange& steps,
                        const isosurface::RestoredPart& part, std::size_t memory,
                        const std::function<void(std::uint32_t, std::span<const std::byte>)>& sink,
                        Progress& progress);

/// Restores the numbers that samples were read from in place of samples, as restore_steps() does. Throws
/// DamagedPage also where remainders are damaged.
PageReads restore_numbers(isosurface::StoreFile& file, const StepRange& steps,
                          const isosurface::RestoredPart& part, std::size_t memory,
                          const std::function<void(std::uint32_t, std::span<const std::byte>)>& sink,
                          Progress& progress);

/// Reads the remainders of numbers in a record of a step, least byte first. Returns false where they are
/// damaged.
bool read_remainders(isosurface::StoreFile& file, std::uint32_t step, std::uint64_t record,
                     std::vector<std::byte>& remainders);

/// Finds which of some steps cannot be restored, in ascending order, by decoding all of them
/// and their remainders.
std::vector<std::uint32_t> damaged_steps(isosurface::StoreFile& file, const StepRange& steps,
                                         const isosurface::RestoredPart& part, std::size_t memory,
                                         Progress& progress);

}  // namespace adamas::timevarying
