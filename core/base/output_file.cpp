#include "core/base/output_file.h"

#include <unistd.h>

#include <atomic>
#include <system_error>

#include "core/base/error.h"

namespace adamas {

namespace {

/// A short name: the file's own may be as long as names can be, and outputs of outputs nest. The number tells
/// those of one process apart.
std::string temporary_name(const std::filesystem::path& path) {
  static std::atomic<unsigned> count = 0;
  constexpr std::size_t kLongestExtension = 32;
  const std::string extension = path.extension().string();
  return ".partial-" + std::to_string(::getpid()) + "-" + std::to_string(count++) +
         (extension.size() <= kLongestExtension ? extension : "");
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
  const std::filesystem::path folder = path_.has_parent_path() ? path_.parent_path() : ".";
  std::error_code code;
  if (!std::filesystem::is_directory(folder, code)) {
    fail("{}: expected an existing output folder, found none at {}", path_.string(), folder.string());
  }
  if (std::filesystem::is_directory(path_, code))
    fail("{}: expected an output file, found a folder", path_.string());
  if (::access(folder.c_str(), W_OK) != 0) {
    fail("{}: expected a writable output folder, found {} read-only", path_.string(), folder.string());
  }
  temporary_ = folder / temporary_name(path_);
}

OutputFile::~OutputFile() {
  std::error_code code;
  if (!committed_) std::filesystem::remove(temporary_, code);
}

void OutputFile::publish() {
  std::error_code code;
  if (!std::filesystem::exists(temporary_, code)) fail("{}: nothing was written", path_.string());
  std::filesystem::rename(temporary_, path_, code);
  if (code) fail("{}: could not be given its final name: {}", path_.string(), code.message());
}

void OutputFile::commit() {
  publish();
  committed_ = true;
}

}  // namespace adamas
