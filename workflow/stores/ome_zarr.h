#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "adamas/output_folder.h"
#include "adamas/progress.h"
#include "timevarying/restore_steps.h"
#include "workflow/stores/restored_steps.h"

namespace adamas::workflow {

/// Describes what is written as OME-Zarr.
struct ZarrContent {
  std::vector<isosurface::RestoredPart> levels;  ///< the first is the finest
  StepRange steps;
  bool is_series = false;  ///< whether there is an axis of time
  /// Bytes for decoded pages, and again for the slabs of steps that are made together.
  std::size_t memory = 0;
};

/// Writes samples of a store as OME-Zarr 0.4: a folder F.zarr whose arrays are levels. Throws Error as
/// restore() does and where a file cannot be written.
class OmeZarr {
 public:
  /// Makes the folder. Throws Error where that fails (OutputFolder).
  OmeZarr(const std::filesystem::path& path, bool overwrite);

  /// Writes the levels and returns the steps that were written (restore_what_can_be).
  RestoredSteps write(isosurface::StoreFile& file, const ZarrContent& content, PageReads& counts,
                      Progress& progress);
  [[nodiscard]] std::size_t bytes() const { return bytes_; }  ///< the number of bytes written
  /// Returns the folder, which the caller commits.
  [[nodiscard]] const std::shared_ptr<OutputFolder>& folder() const { return folder_; }

 private:
  std::size_t write_level(isosurface::StoreFile& file, const ZarrContent& content, const StepNumbers& steps,
                          std::size_t level, PageReads& counts, Progress& progress) const;
  void write_attributes(const isosurface::StoreFile& file, const ZarrContent& content,
                        const StepNumbers& steps, Progress& progress) const;

  std::shared_ptr<OutputFolder> folder_;
  std::size_t bytes_ = 0;
};

}  // namespace adamas::workflow
