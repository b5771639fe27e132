#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "adamas/export.h"

namespace adamas {
inline namespace core {
class PartialNames;
}
}  // namespace adamas

namespace adamas ADAMAS_API {

/// A folder of outputs that gets its final name only when all of it is whole: the caller writes into
/// `temporary()` and calls `commit()`. Without a commit nothing is left, at the latest after the next run
/// (PartialNames). The folder contains a list of its files and their sizes, `.adamas-files`, by which a later
/// run knows what it may replace.
class OutputFolder {
 public:
  /// Makes the temporary folder. `kind`: what it holds, "an experiment". `overwrite`: an existing folder of
  /// the same kind is replaced if it holds nothing but the files of its list. A link to a folder stays one.
  /// Throws Error where the parent folder is missing or read-only, where a file is in the way, and where the
  /// folder exists and is neither empty nor to be replaced.
  OutputFolder(std::string kind, std::filesystem::path path, bool overwrite);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
  /// Returns the temporary path of a file in the folder.
  [[nodiscard]] std::string file(const std::string& name) const { return (temporary_ / name).string(); }
  /// Calls `work`; Errors that it throws name the folder by its final name.
  void fill(const std::function<void()>& work) const;
  /// Gives the folder its final name. Throws Error when it cannot be renamed, or the existing folder has got
  /// other files meanwhile.
  void commit();

 private:
  void check_replaceable() const;

  std::string kind_;
  std::filesystem::path path_;
  std::filesystem::path place_;  ///< `path_`, or its target if it is a link
  std::filesystem::path temporary_;
  bool overwrite_;
  std::shared_ptr<PartialNames> names_;
};

}  // namespace adamas
