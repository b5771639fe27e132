#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/checksum.h"
#include "core/base/error.h"
#include "isosurface/volume/samples.h"
#include "tests/support/volume_store.h"
#include "timevarying/verify_store.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

using test::MemoryVolume;

/// A store of a noisy volume and its bytes, to be damaged.
template <class Sample>
class DamagedStore {
 public:
  explicit DamagedStore(const test::Dimensions& dimensions)
      : volume_(dimensions, [random = std::mt19937(2)](LatticePoint p) mutable {
          return static_cast<Sample>(100 + 80 * std::sin(0.3 * p.i + 0.2 * p.j) * std::cos(0.25 * p.k) +
                                     static_cast<double>(random() % 4));
        }) {
    test::build(path(), volume_);
    whole_ = test::bytes_of(path());
    wanted_ = test::bits_of(volume_.samples);
  }

  [[nodiscard]] std::filesystem::path path() const { return folder_ / "store.adm"; }
  [[nodiscard]] const std::string& whole() const { return whole_; }
  [[nodiscard]] const auto& wanted() const { return wanted_; }
  void flip(std::size_t at, int mask) const {
    std::string bytes = whole_;
    bytes[at] = static_cast<char>(bytes[at] ^ mask);
    test::put_bytes(path(), bytes);
  }
  /// Returns whether the samples can be restored. Fails the test where wrong samples are given.
  [[nodiscard]] bool restores() const {
    try {
      StoreFile file(path());
      EXPECT_EQ(test::restored<Sample>(file), wanted_);
      return true;
    } catch (const Error&) {
      return false;
    }
  }
  /// Returns whether verification finds no problem.
  [[nodiscard]] bool verifies() const {
    try {
      StoreFile file(path());
      const VerifiedStore found = verify_store(file, 1 << 22, SilentProgress::instance());
      EXPECT_EQ(found.problems.empty(), found.bad_pages + found.bad_copies == 0);
      return found.problems.empty();
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("store.adm"), std::string::npos) << error.what();
      return false;
    }
  }

 private:
  test::Scratch folder_;
  MemoryVolume<Sample> volume_;
  std::string whole_;
  std::vector<OrderedWord<Sample>> wanted_;
};

template <class Sample>
void expect_every_flip_found(const DamagedStore<Sample>& store, std::size_t step) {
  ASSERT_TRUE(store.restores());
  ASSERT_TRUE(store.verifies());
  std::mt19937 random(8);
  std::size_t given = 0, refused = 0;
  for (std::size_t at = 0; at < store.whole().size(); at += 1 + random() % (2 * step)) {
    store.flip(at, 1 << random() % 8);
    ASSERT_FALSE(store.verifies()) << "byte " << at;
    ++(store.restores() ? given : refused);
    ASSERT_FALSE(testing::Test::HasFailure()) << "byte " << at;
  }
  EXPECT_GT(given, 0u) << "of pages that are there twice";
  EXPECT_GT(refused, 0u);
}

TEST(LongStoreDamage, EveryFlippedBitIsFoundAndNeverGivesOtherSamples) {
  const DamagedStore<std::uint8_t> bytes({40, 34, 37});
  expect_every_flip_found(bytes, bytes.whole().size() / 100);
  const DamagedStore<float> floats({35, 34, 20});
  expect_every_flip_found(floats, floats.whole().size() / 100);
  const DamagedStore<std::int16_t> one_page({9, 8, 7});
  test::put_bytes(one_page.path(), one_page.whole());
  for (std::size_t at = 0; at < one_page.whole().size(); at += 3) {
    one_page.flip(at, 1 << at % 8);
    ASSERT_FALSE(one_page.verifies()) << "byte " << at;
    static_cast<void>(one_page.restores());
  }
}

TEST(StoreDamage, PagesThatAreThereTwiceAreRepaired) {
  const DamagedStore<std::uint16_t> store({70, 33, 40});
  std::size_t repaired = 0;
  StoreFile file(store.path());
  const PageGrid grid = file.grid();
  for (std::uint64_t number = 1; number < std::uint64_t{2} << (3 * grid.top()); ++number) {
    if ((std::bit_width(number) - 1) % 3 != 0 || !grid.contains(grid.page(number))) continue;
    const PageId id = grid.page(number);
    const PageEntry entry = file.entry(0, id).value();
    ASSERT_EQ(entry.copy != 0, id.lod >= kCopiedLod);
    if (entry.size == 0) continue;
    if (id.lod < kCopiedLod && number % 7 != 0) continue;
    for (const std::uint64_t offset : {entry.offset, entry.copy}) {
      if (offset == 0) continue;
      store.flip(offset + entry.size / 2, 0x10);
      EXPECT_EQ(store.restores(), entry.copy != 0);
      StoreFile damaged(store.path());
      const VerifiedStore found = verify_store(damaged, 1 << 22, SilentProgress::instance());
      EXPECT_EQ(found.bad_copies, entry.copy != 0 ? 1u : 0u);
      EXPECT_EQ(found.bad_pages > 0, entry.copy == 0);
      EXPECT_NE(found.problems.front().what.find(
                    fmt::format("LOD {} at {}, {}, {}", id.lod, id.block.i, id.block.j, id.block.k)),
                std::string::npos);
      repaired += entry.copy != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(repaired, 3u);
}

TEST(StoreDamage, BothCopiesDamagedAreAnError) {
  const DamagedStore<std::uint8_t> store({70, 33, 40});
  StoreFile file(store.path());
  const PageEntry entry = file.entry(0, {file.grid().top(), {}}).value();
  std::string bytes = store.whole();
  bytes[entry.offset] = static_cast<char>(bytes[entry.offset] ^ 1);
  bytes[entry.copy] = static_cast<char>(bytes[entry.copy] ^ 1);
  test::put_bytes(store.path(), bytes);
  EXPECT_FALSE(store.restores());
  StoreFile damaged(store.path());
  const VerifiedStore found = verify_store(damaged, 1 << 22, SilentProgress::instance());
  EXPECT_EQ(found.bad_pages, found.pages) << "all are predicted from it";
}

TEST(StoreDamage, EveryTruncationIsTold) {
  const DamagedStore<std::uint8_t> store({20, 18, 5});
  for (std::size_t size = store.whole().size(); size-- > 0;) {
    std::filesystem::resize_file(store.path(), size);
    ASSERT_THROW(StoreFile(store.path(), Paging::kRead), Error) << size;
    ASSERT_THROW(StoreFile(store.path(), Paging::kMap), Error) << size;
  }
}

/// Damaged bytes of a page get a checksum that agrees, as if they had been written wrong. Any answer is
/// allowed, but nothing breaks.
TEST(StoreDamage, PagesWithTheChecksumOfOtherBytesBreakNothing) {
  const DamagedStore<std::uint8_t> store({20, 18, 5});
  std::mt19937 random(4);
  StoreFile file(store.path());
  const PageEntry entry = file.entry(0, {file.grid().top(), {}}).value();
  std::uint32_t checksum = 0;
  for (int turn = 0; turn < 300; ++turn) {
    std::string bytes = store.whole();
    const std::size_t at = entry.offset + random() % entry.size;
    bytes[at] = static_cast<char>(random());
    const std::string page = bytes.substr(entry.offset, entry.size);
    checksum = crc32c(std::as_bytes(std::span(page)));
    std::string from(4, '\0'), to(4, '\0');
    std::memcpy(from.data(), &entry.checksum, 4);
    std::memcpy(to.data(), &checksum, 4);
    const std::size_t place = bytes.find(from, entry.offset + entry.size);
    ASSERT_NE(place, std::string::npos);
    bytes.replace(place, 4, to);
    test::put_bytes(store.path(), bytes);
    try {
      StoreFile damaged(store.path());
      test::restored<std::uint8_t>(damaged);
      verify_store(damaged, 1 << 22, SilentProgress::instance());
    } catch (const Error&) {
    }
  }
}

}  // namespace
}  // namespace adamas
