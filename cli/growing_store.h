#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/stored_steps.h"
#include "isosurface/storage/store_file.h"
#include "timevarying/store_lock.h"

namespace adamas::cli {

/// What the options of `store --append` ask for that a store has once for all; none where they leave it to
/// the store.
struct AskedOfStore {
  std::optional<isosurface::SampleCoding> coding;
  std::optional<std::uint32_t> group_pages;
  bool gradients = false;
};

/// A store that steps are added to, by this run alone as long as this is there.
class GrowingStore {
 public:
  /// Throws Error as StoreLock and StoreFile do.
  explicit GrowingStore(const std::string& path);

  [[nodiscard]] const VolumeGrid& grid() const { return grid_; }
  [[nodiscard]] std::uint32_t steps() const { return static_cast<std::uint32_t>(times_.size()); }
  /// Up to the end of its last step.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

  /// Throws Error (kUsage) where the store is not what is asked for.
  void check(const AskedOfStore& asked) const;
  /// The steps that are to be added: of those that have times the later ones, others behind the last one.
  /// Notes say which times are taken, and which steps are left out. `name`: what the notes call the input.
  [[nodiscard]] std::vector<InputStep> later_steps(InputSteps input, const std::string& name,
                                                   Session& session) const;
  /// Where adding ends early, the session says how many steps were added all the same.
  isosurface::StoreFigures add(StoredSteps& steps, const isosurface::StoreOptions& options, Session& session);

 private:
  [[nodiscard]] std::vector<InputStep> behind(InputSteps input, const std::string& name,
                                              Session& session) const;

  std::string path_;
  timevarying::StoreLock lock_;
  VolumeGrid grid_;
  std::vector<double> times_;
  std::uint64_t bytes_ = 0;
  AskedOfStore has_;
};

}  // namespace adamas::cli
