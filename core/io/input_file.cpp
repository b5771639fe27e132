#include "core/io/input_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "core/base/error.h"
#include "core/io/input_formats.h"
#include "core/io/volume_stack.h"

namespace adamas::io {

std::size_t check_input_file(const std::filesystem::path& path) {
  std::error_code code;
  const auto status = std::filesystem::status(path, code);
  if (is_file_pattern(path)) {
    std::size_t sum = 0;
    for (const auto& file : match_stack(path)) sum += check_input_file(file);
    return sum;
  }
  if (status.type() == std::filesystem::file_type::not_found) {
    fail("{}: expected a file, found none", path.string());
  }
  if (code) fail("{}: expected a readable file: {}", path.string(), code.message());
  if (status.type() == std::filesystem::file_type::directory) {
    if (find_format_by_name(path) != nullptr) return static_cast<std::size_t>(size_of_folder(path));
    fail("{}: expected a file, found a folder", path.string());
  }
  if (status.type() != std::filesystem::file_type::regular) {
    fail("{}: expected a file, found something else", path.string());
  }
  if (::access(path.c_str(), R_OK) != 0)
    fail("{}: expected a readable file: {}", path.string(), std::strerror(errno));
  const auto size = std::filesystem::file_size(path, code);
  if (code) fail("{}: expected a readable file: {}", path.string(), code.message());
  // A .foam is an empty file that stands for the folder that it lies in.
  if (file_extension(path) == ".foam") return static_cast<std::size_t>(size_of_folder(path.parent_path()));
  if (size == 0) fail("{}: expected data, found an empty file", path.string());
  return static_cast<std::size_t>(size);
}

bool is_file_pattern(const std::filesystem::path& path) {
  std::error_code unknown;
  return path.string().find_first_of("*?#%") != std::string::npos && !std::filesystem::exists(path, unknown);
}

std::uintmax_t size_of_folder(const std::filesystem::path& folder) {
  std::error_code code;
  std::uintmax_t sum = 0;
  const std::filesystem::recursive_directory_iterator end;
  for (std::filesystem::recursive_directory_iterator at(folder.empty() ? "." : folder, code);
       !code && at != end; at.increment(code)) {
    std::error_code of_file;
    const std::uintmax_t size = at->is_regular_file(of_file) ? at->file_size(of_file) : 0;
    if (!of_file) sum += size;
  }
  return sum;
}

namespace {

std::string read_bytes(const std::filesystem::path& path, std::size_t size) {
  std::ifstream stream(path, std::ios::binary);
  std::string content(size, '\0');
  stream.read(content.data(), static_cast<std::streamsize>(size));
  if (!stream) fail("{}: expected {} bytes, found {}", path.string(), size, stream.gcount());
  return content;
}

}  // namespace

std::string read_file(const std::filesystem::path& path) { return read_bytes(path, check_input_file(path)); }

std::string read_beginning(const std::filesystem::path& path) {
  check_input_file(path);
  // A .foam has no bytes of its own.
  return read_bytes(path, std::min<std::size_t>(std::filesystem::file_size(path), kLongestHeader));
}

}  // namespace adamas::io
