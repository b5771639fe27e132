#include "viewer/window/free_name.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "core/base/error.h"

namespace adamas::viewer {

namespace fs = std::filesystem;

fs::path free_name(const fs::path& folder, const std::string& stem, const std::string& ending) {
  for (int n = 1;; ++n) {
    fs::path path = folder / fmt::format("{}-{:03}{}", stem, n, ending);
    std::error_code code;
    if (!fs::exists(fs::symlink_status(path, code))) return path;
  }
}

fs::path rename_to_free_name(const fs::path& from, const std::string& stem, const std::string& ending) {
  for (;;) {
    const fs::path path = free_name(from.parent_path(), stem, ending);
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE) == 0) return path;
    if (errno == EEXIST) continue;
    // Some file systems cannot check and rename in one operation.
    if (errno == EINVAL && ::rename(from.c_str(), path.c_str()) == 0) return path;
    fail("{}: could not be given its final name: {}", path.string(), std::strerror(errno));
  }
}

}  // namespace adamas::viewer
