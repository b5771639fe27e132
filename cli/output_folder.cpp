#include "cli/output_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <system_error>

#include "core/base/error.h"
#include "core/base/text.h"

namespace adamas {

namespace {

namespace fs = std::filesystem;

void check_replaceable(const fs::path& path, bool overwrite, std::initializer_list<const char*> signs) {
  std::error_code code;
  if (!fs::exists(path, code)) return;
  if (!fs::is_directory(path, code)) fail("{}: expected an output folder, found a file", path.string());
  if (fs::is_empty(path, code)) return;
  if (!overwrite) {
    fail("{}: expected a new or an empty folder, found one with files (--overwrite replaces an earlier run)",
         path.string());
  }
  for (const char* sign : signs) {
    if (!fs::exists(path / sign, code))
      fail("{}: expected the folder of an earlier run to replace, found one without {}", path.string(), sign);
  }
}

fs::path without_slash(fs::path path) {
  path = path.lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

OutputFolder::OutputFolder(fs::path path, bool overwrite, std::initializer_list<const char*> signs)
    : path_(without_slash(std::move(path))) {
  check_replaceable(path_, overwrite, signs);
  const fs::path above = path_.has_parent_path() ? path_.parent_path() : ".";
  std::error_code code;
  if (!fs::is_directory(above, code))
    fail("{}: expected an existing folder above, found none at {}", path_.string(), above.string());
  if (::access(above.c_str(), W_OK) != 0)
    fail("{}: expected a writable folder above, found {} read-only", path_.string(), above.string());
  try {
    names_ = PartialNames::in(above);
    const fs::path temporary = names_->next("");
    fs::create_directory(temporary);
    temporary_ = temporary;
  } catch (const std::system_error& error) {
    fail("{}: expected a writable folder above, found that nothing can be made in {}: {}", path_.string(),
         above.string(), error.code().message());
  }
}

OutputFolder::~OutputFolder() {
  std::error_code code;
  if (!temporary_.empty()) fs::remove_all(temporary_, code);
}

void OutputFolder::fill(const std::function<void()>& work) const {
  try {
    work();
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& e) {
    fail("{}", replaced(e.what(), temporary_.string(), path_.string()));
  }
}

void OutputFolder::commit() {
  std::error_code code;
  const bool replace = fs::exists(path_, code);
  fs::path old;
  // Where the file system can exchange two names, the old or the new folder is there at any time.
  if (replace && ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, path_.c_str(), RENAME_EXCHANGE) == 0) {
    old = temporary_;
  } else {
    // The old folder must not get a temporary name here: the next run would remove it, although the new one
    // may not have its final name yet.
    if (replace) old = path_.string() + "-replaced-by" + temporary_.filename().string();
    if (replace) fs::rename(path_, old, code);
    if (!code) fs::rename(temporary_, path_, code);
  }
  if (code) fail("{}: could not be given its final name: {}", path_.string(), code.message());
  temporary_.clear();
  if (replace) fs::remove_all(old, code);
  names_.reset();
}

}  // namespace adamas
