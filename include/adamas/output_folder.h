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

/// A folder of outputs that gets its final name only when all of it is whole: write into `temporary()`, then
/// `commit()`. Without a commit nothing is left, if need be after the next run (PartialNames). A list of its
/// files and their sizes goes with it, `.adamas-files`, by which a later run knows what it may replace.
class OutputFolder {
 public:
  /// `kind`: what it holds, "an experiment". `overwrite`: a folder of the same kind that is there is
  /// replaced, if it holds nothing but the files of its list. A link to a folder stays one. Throws Error
  /// where the folder above is missing or read-only, where a file is in the way, and where the folder is
  /// there and neither empty nor to be replaced.
  OutputFolder(std::string kind, std::filesystem::path path, bool overwrite);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
  /// A file in the folder, where it is while it is written.
  [[nodiscard]] std::string file(const std::string& name) const { return (temporary_ / name).string(); }
  /// Calls `work`; Errors that it throws name the folder as it will be called.
  void fill(const std::function<void()>& work) const;
  /// Throws Error when the folder cannot be renamed, or the one there has got other files meanwhile.
  void commit();

 private:
  void check_replaceable() const;

  std::string kind_;
  std::filesystem::path path_;
  std::filesystem::path place_;  ///< that path, or where it leads if it is a link
  std::filesystem::path temporary_;
  bool overwrite_;
  std::shared_ptr<PartialNames> names_;
};

}  // namespace adamas
