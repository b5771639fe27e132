#include "core/io/array_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/base/error.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using ::testing::HasSubstr;

const std::vector<std::string> kNames{"a/numbers", "a/whole", "bytes", "empty", "float", "texts"};

class ArrayFileTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file() const { return folder_ / "a.h5"; }
  [[nodiscard]] std::string bytes() const {
    std::ifstream stream(file(), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void set_bytes(const std::string& bytes) const { std::ofstream(file(), std::ios::binary) << bytes; }
  [[nodiscard]] std::string refusal(int version = 3) const {
    try {
      static_cast<void>(read_array_file(file(), "thing", kNames, version, version));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  static ArrayFile example() {
    ArrayFile example{"thing", 3, {}};
    std::vector<double> numbers(300'000);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = 0.5 * static_cast<double>(i);
    example.arrays.push_back({"a/numbers", 3, std::move(numbers)});
    example.arrays.push_back({"a/whole", 1, std::vector<std::int32_t>{-1, 5}});
    example.arrays.push_back({"bytes", 1, std::vector<std::uint8_t>{0, 255, 3}});
    example.arrays.push_back({"empty", 1, std::vector<double>{}});
    example.arrays.push_back({"float", 1, std::vector<float>{1.5f}});
    example.arrays.push_back({"texts", 1, std::vector<std::string>{"", "größer", "x"}});
    return example;
  }

  test::Scratch folder_;
};

TEST_F(ArrayFileTest, ComesBack) {
  const ArrayFile written = example();
  write_array_file(file(), written);
  EXPECT_TRUE(is_array_file(file(), "thing"));
  EXPECT_FALSE(is_array_file(file(), "other"));
  const ArrayFile read = read_array_file(file(), "thing", kNames, 3, 3);
  ASSERT_EQ(read.arrays.size(), written.arrays.size());
  for (std::size_t i = 0; i < read.arrays.size(); ++i) {
    EXPECT_EQ(read.arrays[i].name, written.arrays[i].name);
    EXPECT_EQ(read.arrays[i].components, written.arrays[i].components);
    EXPECT_EQ(read.arrays[i].values, written.arrays[i].values) << read.arrays[i].name;
  }
  const std::string first = bytes();
  write_array_file(file(), written);
  EXPECT_EQ(bytes(), first);
}

TEST_F(ArrayFileTest, DamageIsFound) {
  ArrayFile small = example();
  small.arrays.erase(small.arrays.begin());
  write_array_file(file(), small);
  const std::string whole = bytes();
  for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 300) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ (1 << at % 8));
    set_bytes(changed);
    EXPECT_THAT(refusal(), HasSubstr("a.h5: ")) << at;
    set_bytes(whole.substr(0, at));
    EXPECT_THAT(refusal(), HasSubstr("a.h5: ")) << at;
  }
  set_bytes(whole + "x");
  EXPECT_THAT(refusal(), HasSubstr("bytes, found"));
  set_bytes(whole);
  EXPECT_THAT(refusal(4), HasSubstr("expected version 4 of 'adamas thing', found 3"));
  EXPECT_EQ(refusal(), "");
}

TEST_F(ArrayFileTest, OtherFilesAreRefused) {
  EXPECT_FALSE(is_array_file(file(), "thing"));
  EXPECT_THAT(refusal(), HasSubstr("a.h5: "));
  set_bytes("\x89HDF\r\n\x1a\n and so on");
  EXPECT_THAT(refusal(), HasSubstr("expected a file that begins with 'adamas thing'"));
}

}  // namespace
}  // namespace adamas
