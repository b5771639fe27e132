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

/// The outputs of one run: they get their names together, when all of them are whole.
class OutputSet {
 public:
  OutputSet();
  ~OutputSet();
  OutputSet(const OutputSet&) = delete;
  OutputSet& operator=(const OutputSet&) = delete;

  /// An input that no output may overwrite, nor any file that it refers to (referred_files), whether declared
  /// before or after; one that is no file is ignored. Throws Error (kUsage).
  void protect(const std::filesystem::path& input);
  /// The same of what is no data: a file of options, a folder for what is only kept meanwhile.
  void protect_other(const std::filesystem::path& path);
  /// Throws Error (kUsage) where an input lies in a folder that is to be replaced as a whole.
  void check_outside(const std::string& option, const std::filesystem::path& folder) const;
  /// A message of what went wrong, with the first input before it where it names none of all these files.
  [[nodiscard]] std::string naming_input(const std::string& message) const;
  /// An output that will be written, to be declared before long work; an empty path is none. Throws
  /// Error (kUsage) for an extension that is not among those given, for a path declared before and for an
  /// input, and Error where its folder cannot be used.
  void declare(const std::string& option, const std::string& path,
               const std::vector<const char*>& extensions = {});
  /// Calls `writer` with the name to write to, if the path was declared. Its Errors name the final path.
  void write(const std::string& path, const std::function<void(const std::filesystem::path&)>& writer);
  /// The same for an output that is whole at several moments: it gets its name at once, and may be written
  /// again.
  void publish(const std::string& path, const std::function<void(const std::filesystem::path&)>& writer);
  /// An output that will not be written after all.
  void leave_out(const std::string& path);
  /// Bytes written for a path.
  [[nodiscard]] std::size_t bytes(const std::string& path) const;
  /// Gives all outputs their names, the last that was declared first. Throws Error where one cannot have it;
  /// then each name is as it was.
  void commit();
  /// The same for one output alone, which is done then.
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
