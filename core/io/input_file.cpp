#include "core/io/input_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "core/base/error.h"

namespace adamas::io {

std::size_t check_input_file(const std::filesystem::path& path) {
  std::error_code code;
  const auto status = std::filesystem::status(path, code);
  if (status.type() == std::filesystem::file_type::not_found) {
    fail("{}: expected a file, found none", path.string());
  }
  if (code) fail("{}: expected a readable file: {}", path.string(), code.message());
  if (status.type() == std::filesystem::file_type::directory) {
    fail("{}: expected a file, found a folder", path.string());
  }
  if (status.type() != std::filesystem::file_type::regular) {
    fail("{}: expected a file, found something else", path.string());
  }
  if (::access(path.c_str(), R_OK) != 0)
    fail("{}: expected a readable file: {}", path.string(), std::strerror(errno));
  const auto size = std::filesystem::file_size(path, code);
  if (code) fail("{}: expected a readable file: {}", path.string(), code.message());
  if (size == 0) fail("{}: expected data, found an empty file", path.string());
  return static_cast<std::size_t>(size);
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
  return read_bytes(path, std::min(check_input_file(path), kLongestHeader));
}

}  // namespace adamas::io
