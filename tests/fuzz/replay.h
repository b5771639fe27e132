#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "tests/support/scratch.h"

namespace adamas::fuzz {

/// Runs a fuzz target on every seed and on every truncation of it; returns how many seeds are good input.
inline std::size_t replay(const std::string& name, void (*target)(std::string_view)) {
  const auto folder = std::filesystem::path(ADAMAS_SOURCE_DIR) / "tests" / "fuzz" / "corpus" / name;
  std::size_t good = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string bytes = test::bytes_of(entry.path());
    for (std::size_t length = 0; length <= bytes.size(); ++length) {
      try {
        target(std::string_view(bytes).substr(0, length));
        good += length == bytes.size();
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  }
  return good;
}

}  // namespace adamas::fuzz
