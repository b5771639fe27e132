#include "adamas/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <set>
#include <string_view>
#include <system_error>
#include <vector>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/base/partial_names.h"
#include "core/io/output_stream.h"

namespace adamas {

using namespace io;

namespace {

namespace fs = std::filesystem;

constexpr const char* kList = ".adamas-files";
/// The first line of a list; the kind of folder follows it. Further lines are "SIZE NAME", with names
/// relative to the folder.
constexpr std::string_view kListTitle = "Files that adamas wrote here, with their sizes in bytes, of ";

std::string list_line(const fs::path& folder, const fs::path& file) {
  return fmt::format("{} {}", fs::file_size(file), file.lexically_relative(folder).generic_string());
}

void write_list(const fs::path& folder, const std::string& kind) {
  std::vector<std::string> lines;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) lines.push_back(list_line(folder, entry.path()));
  }
  std::sort(lines.begin(), lines.end());
  OutputStream stream(folder / kList);
  stream.write(fmt::format("{}{}\n{}\n", kListTitle, kind, fmt::join(lines, "\n")));
  stream.finish();
}

/// The list of the files in a folder.
struct FolderList {
  std::string kind;  ///< the kind of the folder; empty if it has no list
  std::set<std::string> lines;
};

FolderList read_list(const fs::path& folder) {
  FolderList list;
  std::ifstream stream(folder / kList);
  std::string line;
  if (!std::getline(stream, line) || !line.starts_with(kListTitle)) return list;
  list.kind = line.substr(kListTitle.size());
  while (std::getline(stream, line)) list.lines.insert(line);
  return list;
}

/// A file of a folder that its list does not contain, or a folder in it without such files; empty if there is
/// none.
fs::path unlisted(const fs::path& folder, const std::set<std::string>& lines) {
  std::set<fs::path> folders, above;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_directory() && !entry.is_symlink()) {
      folders.insert(entry.path());
      continue;
    }
    const bool is_plain = entry.is_regular_file() && !entry.is_symlink();
    if (!is_plain || !(entry.path() == folder / kList || lines.contains(list_line(folder, entry.path()))))
      return entry.path();
    for (fs::path at = entry.path().parent_path(); above.insert(at).second && at != folder;)
      at = at.parent_path();
  }
  const auto without_files = std::find_if(folders.begin(), folders.end(),
                                          [&](const fs::path& each) { return !above.contains(each); });
  return without_files == folders.end() ? fs::path() : *without_files;
}

/// Returns the target of a path that is a link to a folder, else the path.
fs::path followed(const fs::path& path) {
  std::error_code code;
  if (!fs::is_symlink(path, code)) return fs::absolute(path);
  if (!fs::is_directory(path, code))
    fail("{}: expected a folder or the name of a new one, found a link that leads to none", path.string());
  return fs::canonical(path);
}

fs::path without_slash(fs::path path) {
  path = path.lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

OutputFolder::OutputFolder(std::string kind, fs::path path, bool overwrite)
    : kind_(std::move(kind)),
      path_(without_slash(std::move(path))),
      place_(without_slash(followed(path_))),
      overwrite_(overwrite) {
  check_replaceable();
  const fs::path above = place_.parent_path();
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

void OutputFolder::check_replaceable() const {
  std::error_code code;
  if (!fs::exists(place_, code)) return;
  if (!fs::is_directory(place_, code)) fail("{}: expected an output folder, found a file", path_.string());
  if (fs::is_empty(place_, code)) return;
  if (!overwrite_) {
    fail("{}: expected a new or an empty folder, found one with files (--overwrite replaces an earlier run)",
         path_.string());
  }
  const FolderList list = read_list(place_);
  if (list.kind.empty())
    fail("{}: expected the folder of an earlier run to replace, found one without its list {}",
         path_.string(), kList);
  if (list.kind != kind_)
    fail("{}: expected the folder of {} to replace, found that of {}", path_.string(), kind_, list.kind);
  fs::path other;
  try {
    other = unlisted(place_, list.lines);
  } catch (const fs::filesystem_error& error) {
    fail("{}: expected a folder that can be read: {}", path_.string(), error.code().message());
  }
  if (!other.empty())
    fail("{}: expected an earlier run's folder as it was written, found '{}', which is new or has changed",
         path_.string(), other.lexically_relative(place_).string());
}

void OutputFolder::fill(const std::function<void()>& work) const {
  try {
    work();
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& e) {
    throw Error(replaced(e.what(), temporary_.string(), path_.string()), e.kind());
  } catch (const fs::filesystem_error& e) {
    fail("{}: {}", path_.string(), e.code().message());
  }
}

void OutputFolder::commit() {
  fill([this] { write_list(temporary_, kind_); });
  check_replaceable();
  std::error_code code;
  const bool replace = fs::exists(place_, code);
  fs::path old;
  // If the file system can exchange two names, either the old or the new folder exists at any time.
  if (replace && ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, place_.c_str(), RENAME_EXCHANGE) == 0) {
    old = temporary_;
  } else {
    // The old folder must not get a temporary name here: the next run would remove it, although the new one
    // might not have its final name yet.
    if (replace) old = place_.string() + "-replaced-by" + temporary_.filename().string();
    if (replace) fs::rename(place_, old, code);
    if (!code) fs::rename(temporary_, place_, code);
  }
  if (code) fail("{}: could not be given its final name: {}", path_.string(), code.message());
  temporary_.clear();
  if (replace) fs::remove_all(old, code);
  names_.reset();
}

}  // namespace adamas
