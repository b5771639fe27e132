#include "isosurface/storage/store_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/base/checksum.h"
#include "core/base/error.h"
#include "isosurface/compression/byte_stream.h"
#include "isosurface/storage/page_payload.h"
#include "isosurface/storage/store_file_writer.h"
#include "isosurface/storage/store_format.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace isosurface;

namespace {

std::vector<std::byte> random_bytes(std::mt19937& random, std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (std::byte& b : bytes) b = static_cast<std::byte>(random());
  return bytes;
}

TEST(Checksum, IsCastagnolis) {
  const std::string text = "123456789";
  const auto bytes = std::as_bytes(std::span(text));
  EXPECT_EQ(crc32c(bytes), 0xe3069283u);  // the check value of RFC 3720's polynomial
  EXPECT_EQ(crc32c(bytes.subspan(4), crc32c(bytes.first(4))), crc32c(bytes));
  EXPECT_EQ(crc32c({}), 0u);
}

TEST(Checksum, IsThatOfItsBytesOneByOne) {
  std::mt19937 random(2);
  for (std::size_t size = 0; size < 70; ++size) {
    const std::vector<std::byte> bytes = random_bytes(random, size);
    std::uint32_t one_by_one = 0;
    for (const std::byte& b : bytes) one_by_one = crc32c({&b, 1}, one_by_one);
    ASSERT_EQ(crc32c(bytes), one_by_one);
  }
}

TEST(ByteStream, VarintsAreTheShortest) {
  for (const std::uint64_t value : {0ull, 1ull, 127ull, 128ull, 300ull, 1ull << 35, ~0ull}) {
    std::vector<std::byte> bytes;
    ByteWriter(bytes).varint(value);
    ByteReader in(bytes);
    EXPECT_EQ(in.varint(), value);
    EXPECT_TRUE(in.good() && in.rest().empty());
    const std::span<const std::byte> all(bytes);
    ByteReader cut(all.first(all.size() - 1));
    cut.varint();
    EXPECT_FALSE(cut.good());
  }
  const std::vector<std::byte> longer{std::byte{0x81}, std::byte{0}};
  ByteReader in(longer);
  in.varint();
  EXPECT_FALSE(in.good());
}

/// A store of two steps with random bytes as pages, in groups of several sizes.
class StoreOfRandomPages : public testing::TestWithParam<std::uint32_t> {
 protected:
  StoreOfRandomPages() {
    header_.grid.dimensions = {70, 33, 40};
    header_.grid.type = SampleType::kUint16;
    header_.grid.spacing = {1, 2, 0.5};
    header_.grid.origin = {-3, 0, 7};
    header_.grid.directions = {{{0, 1, 0}, {-0.6, 0, 0.8}, {0.8, 0, 0.6}}};
    header_.grid.space = "LAS";
    header_.numbers = {StoredType::kUint16, "CT"};
    header_.coding = SampleCoding::kSplitEdge;
    header_.times = {0, 0.5};
    header_.sample_tables = random_bytes(random_, 100);
    header_.bounds_tables = random_bytes(random_, 3);
    header_.bytes = {10, 20, 30};
    write();
  }

  void write() {
    const PageGrid grid(header_.grid.dimensions);
    StoreFileWriter writer(path_, "store.adm", header_.grid, GetParam());
    for (std::uint64_t number = 0; number < std::uint64_t{2} << (3 * grid.top()); ++number) {
      if (number == 0 || (std::bit_width(number) - 1) % 3 != 0 || !grid.contains(grid.page(number))) continue;
      for (std::uint32_t step = 0; step < header_.steps(); ++step) {
        Written page{step, grid.page(number), random_bytes(random_, 1 + random_() % 200), {}};
        page.summary.low = static_cast<std::uint32_t>(random_() & 0xffffu);
        page.summary.high = static_cast<std::uint32_t>(random_() & 0xffffu);
        page.summary.error = static_cast<std::uint8_t>(random_() & 63u);
        for (std::size_t n = 0; n < page.summary.part_count(); ++n) {
          const int error = page.summary.error - static_cast<int>(random_() % (PageSummary::kSpan + 1));
          if (random_() % 4 != 0) page.summary.part_errors[n] = static_cast<std::uint8_t>(std::max(1, error));
        }
        if (random_() % 3 != 0 && page.id.lod < kCopiedLod) {
          // Runs of such pages have the same range; pages with another one lie between them.
          const auto word = static_cast<std::uint32_t>(random_() % 8 == 0 ? 1 : 0);
          page.bytes.assign(plain_payload().begin(), plain_payload().end());
          page.summary = {word, word + 7, 0, {}};
          ++plain_;
        }
        writer.add_page(number, page.bytes, page.summary);
        pages_.push_back(std::move(page));
      }
    }
    size_ = writer.finish_block(header_);
  }

  struct Written {
    std::uint32_t step;
    PageId id;
    std::vector<std::byte> bytes;
    PageSummary summary;
  };

  std::mt19937 random_{7};
  test::Scratch folder_;
  std::filesystem::path path_ = folder_ / "store.adm";
  StoreHeader header_;
  std::vector<Written> pages_;
  std::size_t plain_ = 0;
  std::uint64_t size_ = 0;
};

TEST_P(StoreOfRandomPages, GivesThemBack) {
  for (const Paging paging : {Paging::kRead, Paging::kMap}) {
    StoreFile file(path_, paging);
    EXPECT_EQ(file.size(), size_);
    EXPECT_EQ(file.size(), std::filesystem::file_size(path_));
    EXPECT_EQ(file.header().grid.dimensions, header_.grid.dimensions);
    EXPECT_EQ(file.header().grid.type, header_.grid.type);
    EXPECT_EQ(file.header().grid.spacing.y, 2);
    EXPECT_EQ(file.header().grid.origin.z, 7);
    EXPECT_EQ(file.header().grid.directions, header_.grid.directions);
    EXPECT_EQ(file.header().grid.space, "LAS");
    EXPECT_EQ(file.header().numbers, header_.numbers);
    EXPECT_EQ(file.header().coding, header_.coding);
    EXPECT_EQ(file.steps(), 2u);
    EXPECT_EQ(file.times(), header_.times);
    EXPECT_EQ(file.header().sample_tables, header_.sample_tables);
    EXPECT_EQ(file.header().bounds_tables, header_.bounds_tables);
    EXPECT_EQ(file.header().bytes.gradients, 30u);
    file.check_directory();
    std::size_t without_bytes = 0;
    for (const Written& page : pages_) {
      const auto entry = file.entry(page.step, page.id);
      ASSERT_TRUE(entry);
      EXPECT_EQ(static_cast<const PageSummary&>(*entry), page.summary);
      EXPECT_EQ(entry->copy != 0, page.id.lod >= kCopiedLod);
      EXPECT_TRUE(file.copy_is_whole(*entry));
      const StoreFile::Payload payload = file.read(page.step, page.id);
      EXPECT_EQ(payload.state, PageState::kWhole);
      EXPECT_TRUE(
          std::equal(payload.bytes.begin(), payload.bytes.end(), page.bytes.begin(), page.bytes.end()));
      without_bytes += entry->size == 0 ? 1 : 0;
    }
    EXPECT_EQ(without_bytes, plain_);
    EXPECT_GT(plain_, 9u);
  }
}

TEST(Directory, OfPagesInAnyOrderIsReadAsItWasWritten) {
  const PageGrid grid({700, 300, 200});
  std::mt19937 random(21);
  for (int trial = 0; trial < 50; ++trial) {
    const DirectoryChunk chunk{512, 0, 0, 0, 1000, 5000};
    const auto numbers = chunk_pages(grid, chunk.first);
    StoreHeader header;
    header.grid.type = SampleType::kUint16;
    header.times.resize(1 + static_cast<std::size_t>(trial % 3));
    header.group_pages = 1u << trial % 10;
    std::vector<PageEntry> entries(header.steps() * numbers.size());
    for (PageEntry& entry : entries) {
      entry.low = static_cast<std::uint32_t>(random() % 2);
      entry.high = static_cast<std::uint32_t>(random() % 3);
      if (static_cast<int>(random() % 50) < trial) continue;
      entry.size = static_cast<std::uint32_t>(1 + random() % 300);
      entry.checksum = static_cast<std::uint32_t>(random());
    }
    const auto bytes = serialise_entries(entries, 2);
    const auto found = parse_entries(grid, chunk, header, bytes);
    ASSERT_TRUE(found && found->size() == entries.size());
    for (std::size_t n = 0; n < entries.size(); ++n) {
      EXPECT_EQ(static_cast<const PageSummary&>((*found)[n]), entries[n]);
      EXPECT_EQ((*found)[n].size, entries[n].size);
      EXPECT_EQ((*found)[n].checksum, entries[n].checksum);
    }
    // Pages follow each other without gaps, in the order of groups, then of steps, then of pages.
    std::vector<std::array<std::uint64_t, 4>> order;
    for (std::size_t n = 0; n < entries.size(); ++n) {
      const std::uint64_t number = numbers[n / header.steps()];
      order.push_back({number / header.group_pages, n % header.steps(), number, n});
    }
    std::ranges::sort(order);
    std::uint64_t offset = chunk.pages;
    for (const auto& [group, step, number, n] : order) {
      EXPECT_EQ((*found)[n].offset, offset) << "page " << number << " step " << step << " of group " << group;
      offset += entries[n].size;
    }
    for (std::size_t length = 0; length < bytes.size(); ++length)
      EXPECT_FALSE(parse_entries(grid, chunk, header, std::span(bytes).first(length))) << length;
  }
}

TEST_P(StoreOfRandomPages, EveryFlippedBitIsFound) {
  const std::string whole = test::bytes_of(path_);
  std::size_t fatal = 0, repaired = 0, lost = 0;
  for (std::size_t at = 0; at < whole.size(); at += 11 + at % 5) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 1 << at % 8);
    test::put_bytes(path_, bytes);
    std::size_t found = 0;
    try {
      StoreFile file(path_);
      for (const Written& page : pages_) {
        const StoreFile::Payload payload = file.read(page.step, page.id);
        repaired += payload.state == PageState::kCopied ? 1 : 0;
        lost += payload.state == PageState::kDamaged ? 1 : 0;
        found += payload.state != PageState::kWhole ? 1 : 0;
        // Bytes that are given are right, whatever was damaged.
        if (payload.state != PageState::kDamaged) {
          ASSERT_TRUE(
              std::equal(payload.bytes.begin(), payload.bytes.end(), page.bytes.begin(), page.bytes.end()));
        }
        const auto entry = file.entry(page.step, page.id);
        found += entry && !file.copy_is_whole(*entry) ? 1 : 0;
      }
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("store.adm"), std::string::npos) << e.what();
      ++fatal;
      ++found;
    }
    EXPECT_GT(found, 0u) << "byte " << at;
  }
  EXPECT_GT(fatal, 0u);
  EXPECT_GT(repaired, 0u);
  EXPECT_GT(lost, 0u);
}

TEST_P(StoreOfRandomPages, EveryTruncationIsTold) {
  const std::string whole = test::bytes_of(path_);
  for (std::size_t size = 0; size < whole.size(); size += size < 100 ? 1 : 97) {
    test::put_bytes(path_, whole.substr(0, size));
    EXPECT_THROW(StoreFile(path_, Paging::kRead), Error) << size;
    EXPECT_THROW(StoreFile(path_, Paging::kMap), Error) << size;
  }
  test::put_bytes(path_, whole + '\0');
  EXPECT_THROW(StoreFile(path_, Paging::kRead), Error);
}

TEST(StoreFile, RefusesOtherFiles) {
  const test::Scratch folder;
  EXPECT_THROW(StoreFile(folder / "missing.adm"), Error);
  EXPECT_THROW(StoreFile(folder.folder()), Error);
  std::ofstream(folder / "text.adm") << "not a store, but long enough to be one, at least at its head";
  EXPECT_THROW(StoreFile(folder / "text.adm"), Error);
}

/// The root states as many samples as there may be, and there is no directory. No memory is allocated for it.
TEST(StoreFile, RefusesMorePagesThanItsDirectoryHas) {
  const test::Scratch folder;
  StoreRoot root;
  root.header.grid.dimensions = {262145, 262145, 262145};
  for (std::size_t parts = 0; parts < 3; ++parts) {
    const std::vector<std::byte> last = root.serialise();
    const StorePrologue prologue{{StorePrologue::kBytes, last.size()}};
    std::string bytes;
    for (const auto& part : {prologue.serialise(), last})
      bytes.append(reinterpret_cast<const char*>(part.data()), part.size());
    test::put_bytes(folder / "huge.adm", bytes);
    try {
      StoreFile(folder / "huge.adm");
      FAIL();
    } catch (const Error& e) {
      const std::string wanted =
          fmt::format("huge.adm: expected 9819165450 parts or more of a directory, found {}", parts);
      EXPECT_NE(std::string(e.what()).find(wanted), std::string::npos) << e.what();
    }
    root.chunks.push_back({DirectoryChunk::kPages * parts});
  }
}

INSTANTIATE_TEST_SUITE_P(Groups, StoreOfRandomPages, testing::Values(1u, 8u, 512u));

TEST(StoreFileWriter, TellsOfAFullDisk) {
  StoreHeader header;
  header.grid.dimensions = {1, 1, 1};
  StoreFileWriter writer("/dev/full", "out.adm", header.grid);
  try {
    writer.add_page(1, std::vector<std::byte>(100000), {});
    writer.finish_block(header);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()).rfind("out.adm: ", 0), 0u) << e.what();
  }
}

}  // namespace
}  // namespace adamas
