#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/base/abrupt_end.h"

namespace adamas::inline core {

/// Names for what a run is writing in a folder: `.partial-XXXXXX-N` with six letters or digits that no other
/// run has there. An empty file `.partial-XXXXXX` goes with them and is locked as long as the run lives. So
/// the next run that writes there knows what a killed run has left: such a file that it can lock, and all
/// files whose names begin with its name. Process numbers would not do: they are reused, and computers that
/// share a folder have the same ones.
class PartialNames {
 public:
  /// The names for a folder, which all writers of this process share. The first call removes what earlier
  /// runs have left in the folder. Throws std::system_error where nothing can be written there.
  static std::shared_ptr<PartialNames> in(const std::filesystem::path& folder);
  ~PartialNames();
  PartialNames(const PartialNames&) = delete;
  PartialNames& operator=(const PartialNames&) = delete;

  /// Returns a new name, which ends with `extension`.
  [[nodiscard]] std::filesystem::path next(const std::string& extension) const;

 private:
  explicit PartialNames(std::filesystem::path folder);
  bool make_locked_file();

  std::filesystem::path folder_, mark_;
  int file_ = -1;
  std::optional<RemovedAtAbruptEnd> at_abrupt_end_;
};

}  // namespace adamas::inline core
