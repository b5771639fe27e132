#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "core/base/error.h"

namespace adamas::test {

/// A folder that is removed at the end of its test.
class Scratch {
 public:
  Scratch() {
    // The name is unique, since a test that was killed leaves its folder behind.
    std::string name = (std::filesystem::temp_directory_path() / "adamas-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw std::filesystem::filesystem_error("mkdtemp", name,
                                              std::error_code(errno, std::generic_category()));
    folder_ = name;
  }
  ~Scratch() {
    std::error_code code;
    std::filesystem::remove_all(folder_, code);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// Returns the number of entries in the folder.
  [[nodiscard]] std::ptrdiff_t entries() const {
    return std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator());
  }

 private:
  std::filesystem::path folder_;
};

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

inline void put_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// Returns the message of the Error that `body` throws. Fails the test where it throws none, or where the
/// message is not a single line.
template <class Body>
std::string error_of(Body&& body) {
  try {
    body();
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_FALSE(message.empty());
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  ADD_FAILURE() << "expected an Error, found none";
  return {};
}

inline ::testing::AssertionResult says(const std::string& message, const std::string& part) {
  if (message.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "expected '" << part << "' in: " << message;
}

/// Returns the path of a file of the published data, which not every machine has: in the folder that the
/// variable ADAMAS_DATA names, or else beside the checkout.
inline std::filesystem::path shared_data(const std::string& name) {
  const char* folder = std::getenv("ADAMAS_DATA");
  if (folder != nullptr && *folder != '\0') return std::filesystem::path(folder) / name;
  return std::filesystem::path(ADAMAS_SOURCE_DIR) / ".." / "shared" / "data" / name;
}

}  // namespace adamas::test

#define ADAMAS_SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << (path).string()
