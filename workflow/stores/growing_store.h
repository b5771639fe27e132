#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "isosurface/storage/store_file.h"
#include "timevarying/store_lock.h"
#include "workflow/stores/stored_steps.h"

namespace adamas::workflow {

/// A store that steps are added to. No other process can add steps while this object exists.
class GrowingStore {
 public:
  /// Opens and locks the store. Throws Error as StoreLock and StoreFile do.
  explicit GrowingStore(const std::string& path);

  [[nodiscard]] const VolumeGrid& grid() const { return grid_; }
  [[nodiscard]] std::uint32_t steps() const { return static_cast<std::uint32_t>(times_.size()); }
  /// Returns the number of bytes up to the end of the last step.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

  /// Throws Error (kUsage) where the options differ from those of the store.
  void check(const BuildOptions& options) const;
  /// Returns the steps that are to be added: if they have times of their own, the later ones; otherwise all
  /// of them, behind the last one. Notes say which times are taken, and which steps are left out. `name`: the
  /// name of the input in notes.
  [[nodiscard]] std::vector<VolumeInputStep> later_steps(VolumeInputSteps input, const std::string& name,
                                                         Progress& progress) const;
  /// Adds steps. `added`: StoreRequest::added.
  isosurface::StoreFigures add(StoredSteps& steps, const isosurface::StoreOptions& options,
                               const std::function<void(std::uint32_t, std::size_t)>& added,
                               Progress& progress);

 private:
  [[nodiscard]] std::vector<VolumeInputStep> behind(VolumeInputSteps input, const std::string& name,
                                                    Progress& progress) const;

  std::string path_;
  timevarying::StoreLock lock_;
  VolumeGrid grid_;
  std::vector<double> times_;
  std::uint64_t bytes_ = 0;
  isosurface::StoreHeader header_;
};

}  // namespace adamas::workflow
