#include "core/base/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <system_error>

#include "core/base/error.h"

namespace adamas::inline core {

namespace {

/// A short name for the temporary file: the file's own may be as long as names can be, and outputs of outputs
/// nest.
std::filesystem::path temporary_name(const PartialNames& names, const std::filesystem::path& path) {
  constexpr std::size_t kLongestExtension = 32;
  std::string extension = path.extension().string();
  // The extension before the last one is that of the compressed format.
  if (extension == ".gz") extension = path.stem().extension().string() + extension;
  return names.next(extension.size() <= kLongestExtension ? extension : "");
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
  const std::filesystem::path folder = path_.has_parent_path() ? path_.parent_path() : ".";
  std::error_code code;
  if (!std::filesystem::is_directory(folder, code)) {
    fail("{}: expected an existing output folder, found none at {}", path_.string(), folder.string());
  }
  const long most = ::pathconf(folder.c_str(), _PC_NAME_MAX);
  const std::size_t length = path_.filename().string().size();
  if (most > 0 && length > static_cast<std::size_t>(most))
    fail("{}: expected a file name of at most {} bytes, found one of {}", path_.string(), most, length);
  if (std::filesystem::is_directory(path_, code))
    fail("{}: expected an output file, found a folder", path_.string());
  if (::access(folder.c_str(), W_OK) != 0) {
    fail("{}: expected a writable output folder, found {} read-only", path_.string(), folder.string());
  }
  try {
    names_ = PartialNames::in(folder);
  } catch (const std::system_error& error) {
    fail("{}: expected a writable output folder, found that files cannot be made in {}: {}", path_.string(),
         folder.string(), error.code().message());
  }
  temporary_ = temporary_name(*names_, path_);
}

OutputFile::~OutputFile() {
  std::error_code code;
  if (!committed_ || replaced_) std::filesystem::remove(temporary_, code);
}

void OutputFile::publish() {
  std::error_code code;
  if (!std::filesystem::exists(temporary_, code)) fail("{}: nothing was written", path_.string());
  std::filesystem::rename(temporary_, path_, code);
  if (code) fail("{}: could not be given its final name: {}", path_.string(), code.message());
}

void OutputFile::commit() {
  if (committed_) return;
  if (exchange()) {
    replaced_ = true;
  } else {
    publish();
    names_.reset();
  }
  committed_ = true;
}

void OutputFile::undo() {
  std::error_code code;
  if (!replaced_ || !exchange()) std::filesystem::remove(path_, code);
}

bool OutputFile::exchange() const {
  std::error_code code;
  return std::filesystem::is_regular_file(std::filesystem::symlink_status(path_, code)) &&
         ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, path_.c_str(), RENAME_EXCHANGE) == 0;
}

}  // namespace adamas::inline core
