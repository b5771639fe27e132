#pragma once

#include <filesystem>
#include <memory>

#include "core/base/partial_names.h"

namespace adamas::inline core {

/// A file that gets its final name only when it is whole: write to `temporary()`, then `commit()`. Without a
/// commit the temporary file is removed, if need be by the next run (PartialNames). The temporary name keeps
/// the extension, since libraries choose formats by it.
class OutputFile {
 public:
  /// Throws Error when the folder is missing or cannot be written.
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Gives the file its final name. Throws Error when the temporary file is missing or cannot be renamed. A
  /// file that had the name is kept until this object goes, where the file system can exchange names.
  void commit();
  /// Takes a commit back: the file that had the name before has it again, if there was one.
  void undo();
  /// Gives what was written so far the final name; a later version may be written and take its place.
  void publish();

 private:
  /// Whether the temporary and the final name, both of files, were exchanged.
  [[nodiscard]] bool exchange() const;

  std::filesystem::path path_;
  std::shared_ptr<PartialNames> names_;
  std::filesystem::path temporary_;
  /// The temporary file has got its name; what has its name now is the replaced file.
  bool committed_ = false;
  bool replaced_ = false;  ///< there is a replaced file
};

}  // namespace adamas::inline core
