#pragma once

#include <memory>
#include <string>
#include <vector>

#include "adamas/output_folder.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/restored_steps.h"
#include "timevarying/restore_steps.h"

namespace adamas::cli {

/// Whether a name is that of a folder F.zarr, also with a slash behind it.
bool is_zarr(const std::string& path);

/// What is written as OME-Zarr.
struct ZarrContent {
  std::vector<isosurface::RestoredPart> levels;  ///< the first is the finest
  timevarying::StepRange steps;
  bool is_series = false;  ///< whether there is an axis of time
  std::size_t memory = 0;  ///< for decoded pages, and again for the slabs of steps that are made together
};

/// Samples of a store as OME-Zarr 0.4: a folder F.zarr whose arrays are levels. Throws Error as restore()
/// does and where something cannot be written.
class OmeZarr {
 public:
  /// Throws Error where the folder cannot be made (OutputFolder).
  OmeZarr(const std::string& path, bool overwrite);

  /// Returns the steps that were written (restore_what_can_be).
  RestoredSteps write(isosurface::StoreFile& file, const ZarrContent& content, isosurface::PageCounts& counts,
                      Session& session);
  [[nodiscard]] std::size_t bytes() const { return bytes_; }  ///< that were written
  void commit() { folder_.commit(); }

 private:
  std::size_t write_level(isosurface::StoreFile& file, const ZarrContent& content, const StepNumbers& steps,
                          std::size_t level, isosurface::PageCounts& counts, Session& session) const;
  void write_attributes(const isosurface::StoreFile& file, const ZarrContent& content,
                        const StepNumbers& steps, Session& session) const;

  OutputFolder folder_;
  std::size_t bytes_ = 0;
};

}  // namespace adamas::cli
