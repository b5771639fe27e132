#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "adamas/export.h"

namespace adamas {
inline namespace core {
class OutputFile;
}
}  // namespace adamas

namespace adamas ADAMAS_API {

/// The outputs of one run, which get their names together when all of them are whole.
class OutputSet {
 public:
  OutputSet();
  ~OutputSet();
  OutputSet(const OutputSet&) = delete;
  OutputSet& operator=(const OutputSet&) = delete;

  /// Declares an input: no output may overwrite it or a file that it refers to (referred_files), whether
  /// declared before or after. A path that is no file is ignored. Throws Error (kUsage) where an output
  /// would.
  void protect(const std::filesystem::path& input);
  /// Protects, in the way of protect(), a path without data: a file of options, or a folder for intermediate
  /// files.
  void protect_other(const std::filesystem::path& path);
  /// Throws Error (kUsage) where an input lies in a folder that is to be replaced as a whole.
  void check_outside(const std::string& option, const std::filesystem::path& folder) const;
  /// Returns an error message that begins with the first input, unless it names one of all these files
  /// already.
  [[nodiscard]] std::string naming_input(const std::string& message) const;
  /// Declares an output, before long work; an empty path is ignored. Throws Error (kUsage) for an extension
  /// that is not among those given, for a path declared before and for an input, and Error where its folder
  /// cannot be used.
  void declare(const std::string& option, const std::string& path,
               const std::vector<const char*>& extensions = {});
  /// Calls `writer` with the name to write to, if the path was declared. Its Errors name the final path.
  void write(const std::string& path, const std::function<void(const std::filesystem::path&)>& writer);
  /// Writes an output, as write() does, and gives it its name at once. It may be written again later.
  void publish(const std::string& path, const std::function<void(const std::filesystem::path&)>& writer);
  /// Removes an output from those that are written.
  void leave_out(const std::string& path);
  /// Returns the number of bytes written for a path.
  [[nodiscard]] std::size_t bytes(const std::string& path) const;
  /// Gives all outputs their names, the last that was declared first. Throws Error where one cannot have it;
  /// then each name is as it was.
  void commit();
  /// Gives one output its name, which completes it. Throws Error as commit() does.
  void commit(const std::string& path);

 private:
  struct Declared {
    std::string option;
    std::unique_ptr<OutputFile> file;
  };
  [[nodiscard]] OutputFile* find(const std::string& path) const;
  void check_outputs_apart_from(const std::filesystem::path& input) const;

  std::vector<Declared> files_;
  std::vector<std::filesystem::path> inputs_, others_;
};

}  // namespace adamas
