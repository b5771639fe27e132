// Tests labels that are read as runs, piece by piece, against the numbers that were written.

#include <random>
#include <set>

#include "core/io/multi_material_reader.h"
#include "tests/io/volume_files.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of_values;
using test::error_of;
using test::put_bytes;
using test::says;

constexpr std::array<std::size_t, 3> kSize{61, 43, 37};

/// Makes numbers that change at a site with this probability.
template <class T>
std::vector<T> numbers_of(double change, std::mt19937& random) {
  std::bernoulli_distribution changes(change);
  std::vector<T> numbers;
  T number = 7;
  for (std::size_t site = 0; site < kSize[0] * kSize[1] * kSize[2]; ++site) {
    if (changes(random)) number = static_cast<T>(3 * (random() % 40));
    numbers.push_back(number);
  }
  return numbers;
}

std::string nrrd_header(const std::string& type, const std::string& encoding, const std::string& more = "") {
  return "NRRD0004\ntype: " + type + "\ndimension: 3\nsizes: 61 43 37\nendian: big\nencoding: " + encoding +
         "\n" + more + "\n";
}

template <class T>
std::string big_endian(const std::vector<T>& numbers) {
  std::string bytes = bytes_of_values(numbers);
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(T))
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(at + sizeof(T)));
  return bytes;
}

std::string gzip(const std::string& bytes) { return test::deflated(bytes, test::Wrapping::kGzip); }

MultiMaterialData read(const std::filesystem::path& path) {
  MaterialDataOptions options;
  options.labels = path.string();
  options.centering = Centering::kCells;
  return read_multi_material_data(path, options);
}

/// Compares labels with numbers; `site_of`: the place of a number in the labels.
template <class T, class SiteOf>
void expect_numbers(const MultiMaterialData& data, const std::vector<T>& numbers, const SiteOf& site_of) {
  const std::set<T> distinct(numbers.begin(), numbers.end());
  ASSERT_EQ(data.materials.size(), distinct.size());
  std::size_t m = 0;
  for (const T number : distinct) EXPECT_EQ(data.materials[MaterialId(m++)], std::to_string(number));
  const SiteArray<std::uint16_t> labels = data.labels.dense();
  ASSERT_EQ(labels.size(), numbers.size());
  std::size_t n = 0;
  for (std::size_t k = 0; k < kSize[2]; ++k) {
    for (std::size_t j = 0; j < kSize[1]; ++j) {
      for (std::size_t i = 0; i < kSize[0]; ++i, ++n) {
        const std::string& name = data.materials[MaterialId(std::as_const(labels)[site_of(i, j, k)])];
        ASSERT_EQ(name, std::to_string(numbers[n])) << n;
      }
    }
  }
}

std::size_t site(std::size_t i, std::size_t j, std::size_t k) { return i + kSize[0] * (j + kSize[1] * k); }

TEST(LabelRunsOfFiles, AreTheNumbersOfTheFile) {
  std::mt19937 random(11);
  const test::Scratch scratch;
  const auto check = [&]<class T>(const std::string& type, T) {
    for (const double change : {0.01, 1.0}) {
      const std::vector<T> numbers = numbers_of<T>(change, random);
      put_bytes(scratch / "a.nrrd", nrrd_header(type, "raw") + big_endian(numbers));
      put_bytes(scratch / "b.nrrd", nrrd_header(type, "gzip") + gzip(big_endian(numbers)));
      for (const char* name : {"a.nrrd", "b.nrrd"}) {
        const MultiMaterialData data = read(scratch / name);
        EXPECT_EQ(data.labels.is_dense(), change == 1.0);
        expect_numbers(data, numbers, site);
      }
    }
  };
  check("uint8", std::uint8_t{});
  check("int16", std::int16_t{});
  check("uint32", std::uint32_t{});
}

/// Axes that point down are turned round, and others are exchanged.
TEST(LabelRunsOfFiles, FollowTheAxes) {
  std::mt19937 random(12);
  const test::Scratch scratch;
  const std::vector<std::uint8_t> numbers = numbers_of<std::uint8_t>(0.02, random);
  const auto read_with = [&](const std::string& directions) {
    put_bytes(scratch / "a.nrrd",
              nrrd_header("uint8", "raw", "space dimension: 3\nspace directions: " + directions) +
                  bytes_of_values(numbers));
    return read(scratch / "a.nrrd");
  };
  const std::size_t nx = kSize[0], ny = kSize[1], nz = kSize[2];
  expect_numbers(
      read_with("(-1,0,0) (0,-1,0) (0,0,1)\n"), numbers,
      [&](std::size_t i, std::size_t j, std::size_t k) { return site(nx - 1 - i, ny - 1 - j, k); });
  expect_numbers(read_with("(1,0,0) (0,1,0) (0,0,-1)\n"), numbers,
                 [&](std::size_t i, std::size_t j, std::size_t k) { return site(i, j, nz - 1 - k); });
  expect_numbers(read_with("(0,1,0) (-1,0,0) (0,0,1)\n"), numbers,
                 [&](std::size_t i, std::size_t j, std::size_t k) { return ny - 1 - j + ny * (i + nx * k); });
}

TEST(LabelRunsOfFiles, MayBeCropped) {
  std::mt19937 random(14);
  const test::Scratch scratch;
  const std::vector<std::uint8_t> numbers = numbers_of<std::uint8_t>(0.02, random);
  put_bytes(scratch / "a.nrrd", nrrd_header("uint8", "raw", "spacings: 1 1 1\n") + bytes_of_values(numbers));
  MaterialDataOptions options;
  options.labels = (scratch / "a.nrrd").string();
  options.centering = Centering::kPoints;
  options.region = {{10, 30, 5, 9, 0, 36}};
  const MultiMaterialData data = read_multi_material_data(scratch / "a.nrrd", options);
  ASSERT_EQ(data.labels.size(), 21u * 5 * 37);
  for (std::size_t k = 0; k < 37; ++k) {
    for (std::size_t j = 0; j < 5; ++j) {
      for (std::size_t i = 0; i < 21; ++i) {
        const auto label = std::as_const(data).labels[i + 21 * (j + 5 * k)];
        ASSERT_EQ(data.materials[MaterialId(label)], std::to_string(numbers[site(i + 10, j + 5, k)]));
      }
    }
  }
}

/// An array of whole numbers that is no label in the end has its numbers.
TEST(LabelRunsOfFiles, AreExpandedForFields) {
  std::mt19937 random(13);
  const test::Scratch scratch;
  const std::vector<std::int16_t> numbers = numbers_of<std::int16_t>(0.01, random);
  const std::vector<std::uint8_t> labels = numbers_of<std::uint8_t>(0.01, random);
  put_bytes(scratch / "a.nrrd", nrrd_header("int16", "raw") + big_endian(numbers));
  put_bytes(scratch / "b.nrrd", nrrd_header("uint8", "raw") + bytes_of_values(labels));
  MaterialDataOptions options;
  options.labels = (scratch / "b.nrrd").string();
  options.centering = Centering::kCells;
  const MultiMaterialData data = read_multi_material_data(scratch / "a.nrrd", options);
  expect_numbers(data, labels, site);
  ASSERT_EQ(data.fields.size(), 1u);
  for (std::size_t n = 0; n < numbers.size(); ++n) ASSERT_EQ(data.fields[0].values[n], numbers[n]);
}

TEST(LabelRunsOfFiles, OfCutFilesAreRefusedInOneLine) {
  std::mt19937 random(15);
  const test::Scratch scratch;
  const std::vector<std::uint8_t> numbers = numbers_of<std::uint8_t>(0.02, random);
  const std::string bytes = bytes_of_values(numbers);
  put_bytes(scratch / "a.nrrd", nrrd_header("uint8", "raw") + bytes.substr(0, bytes.size() - 1));
  put_bytes(scratch / "b.nrrd", nrrd_header("uint8", "gzip") + gzip(bytes).substr(0, 3000));
  put_bytes(scratch / "c.nrrd", nrrd_header("uint8", "gzip") + gzip(bytes.substr(0, 5000)));
  EXPECT_TRUE(says(error_of([&] { read(scratch / "a.nrrd"); }),
                   "a.nrrd: expected 97051 bytes for 61 x 43 x 37 samples of uint8"));
  for (const char* name : {"b.nrrd", "c.nrrd"}) {
    const std::string message = error_of([&] { read(scratch / name); });
    EXPECT_TRUE(says(message, name)) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(LabelRunsOfFiles, AreAtMost65535) {
  const test::Scratch scratch;
  std::vector<std::int32_t> numbers(kSize[0] * kSize[1] * kSize[2]);
  for (std::size_t n = 0; n < numbers.size(); ++n) numbers[n] = static_cast<std::int32_t>(n % 65535);
  put_bytes(scratch / "a.nrrd", nrrd_header("int32", "raw") + big_endian(numbers));
  EXPECT_EQ(read(scratch / "a.nrrd").materials.size(), 65535u);
  numbers.back() = 70000;
  put_bytes(scratch / "a.nrrd", nrrd_header("int32", "raw") + big_endian(numbers));
  EXPECT_TRUE(
      says(error_of([&] { read(scratch / "a.nrrd"); }), "expected at most 65535 materials, found 65536"));
}

}  // namespace
}  // namespace adamas
