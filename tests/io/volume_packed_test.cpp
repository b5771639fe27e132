// Tests NRRD and MetaImage whose samples are compressed or text, and where they are unpacked to.

#include <sys/resource.h>
#include <sys/wait.h>

#include <csignal>

#include "tests/io/volume_files.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of_values;
using test::bzipped;
using test::deflated;
using test::message_of_volume;
using test::put_bytes;
using test::read_numbers;
using test::says;
using test::Wrapping;

TEST(PackedVolume, EveryTypeOfNrrd) {
  const test::Scratch scratch;
  for (const StoredType type : test::kStoredTypes) {
    visit_stored_type(type, [&]<class T>(T) {
      for (const bool big : {false, true}) {
        const auto values = test::typical_values<T>();
        const std::string bytes = bytes_of_values(values, big);
        const char* name = type == StoredType::kFloat32   ? "float"
                           : type == StoredType::kFloat64 ? "double"
                                                          : stored_name(type);
        const std::string head =
            fmt::format("NRRD0004\ntype: {}\nendian: {}\nsizes: 3 2 2\nspacings: 1 2 3\nencoding: ", name,
                        big ? "big" : "little");
        put_bytes(scratch / "a.nrrd", head + "gzip\n\n" + deflated(bytes, Wrapping::kGzip));
        put_bytes(scratch / "b.nrrd", head + "gzip\nbyte skip: 3\nline skip: 1\n\nxyz\n" +
                                          deflated("123" + bytes, Wrapping::kGzip));
        put_bytes(scratch / "c.raw.gz", deflated(bytes, Wrapping::kGzip));
        put_bytes(scratch / "c.nhdr", head + "gz\ndata file: c.raw.gz\n");
        // bgzip and pigz write several gzip streams one after the other.
        put_bytes(scratch / "d.nrrd", head + "gzip\n\n" + deflated(bytes.substr(0, 5), Wrapping::kGzip) +
                                          deflated(bytes.substr(5), Wrapping::kGzip));
        put_bytes(scratch / "f.nrrd", head + "bzip2\n\n" + bzipped(bytes));
        put_bytes(scratch / "g.nrrd",
                  head + "bz2\nbyte skip: 3\nline skip: 1\n\nxyz\n" + bzipped("123" + bytes));
        // pbzip2 writes several streams, too.
        put_bytes(scratch / "h.raw", bzipped(bytes.substr(0, 5)) + bzipped(bytes.substr(5)) + "and more");
        put_bytes(scratch / "h.nhdr", head + "bzip2\ndata file: h.raw\n");
        std::string text;
        for (const T v : values) text += fmt::format("{}{}", +v, v == 3 ? ",\n" : " ");
        put_bytes(scratch / "e.nrrd", head + "ascii\n\n" + text);
        for (const char* file :
             {"a.nrrd", "b.nrrd", "c.nhdr", "d.nrrd", "e.nrrd", "f.nrrd", "g.nrrd", "h.nhdr"}) {
          VolumeReader reader = open_volume(scratch / file);
          EXPECT_EQ(reader.grid().type, sample_type_for(type));
          EXPECT_EQ(reader.grid().spacing, (Vec3{1, 2, 3}));
          EXPECT_EQ(read_numbers(reader), test::as_doubles(values)) << file << " " << name << big;
        }
      }
    });
  }
}

TEST(PackedVolume, CompressedMetaImages) {
  const test::Scratch scratch;
  const auto values = test::typical_values<std::int16_t>();
  const std::string packed = deflated(bytes_of_values(values, true), Wrapping::kZlib);
  const std::string head =
      "NDims = 3\nDimSize = 3 2 2\nElementType = MET_SHORT\nBinaryDataByteOrderMSB = True\n"
      "TransformMatrix = -1 0 0 0 1 0 0 0 1\nElementSpacing = 2 1 1\n";
  const std::string compressed =
      fmt::format("CompressedData = True\nCompressedDataSize = {}\n", packed.size());
  put_bytes(scratch / "a.mha", head + compressed + "ElementDataFile = LOCAL\n" + packed);
  put_bytes(scratch / "b.zraw", "1234" + packed);
  put_bytes(scratch / "b.mhd", head + compressed + "HeaderSize = 4\nElementDataFile = b.zraw\n");
  std::string text;
  for (const std::int16_t v : values) text += std::to_string(v) + "\n";
  put_bytes(scratch / "c.mha", head + "BinaryData = False\nElementDataFile = LOCAL\n" + text);
  for (const char* file : {"a.mha", "b.mhd", "c.mha"}) {
    VolumeReader reader = open_volume(scratch / file);
    EXPECT_EQ(reader.grid().origin, (Vec3{0, 0, 0}));
    EXPECT_EQ(reader.grid().box().min, (Vec3{-4, 0, 0}));
    EXPECT_EQ(read_numbers(reader), test::as_doubles(values)) << file;
  }
  for (const char* file : {"a.mha", "c.mha"}) {
    test::expect_every_truncation_is_an_error(scratch / file, scratch / file,
                                              std::filesystem::file_size(scratch / file));
  }
}

TEST(PackedVolume, EveryTruncationAndEveryChangedByte) {
  const test::Scratch scratch;
  const auto values = test::typical_values<std::uint16_t>();
  const std::string bytes = bytes_of_values(values);
  for (const bool bzip : {false, true}) {
    const std::string head = fmt::format(
        "NRRD0004\ntype: ushort\nendian: little\nsizes: 3 2 2\nencoding: {}\n\n", bzip ? "bzip2" : "gzip");
    const std::string whole = head + (bzip ? bzipped(bytes) : deflated(bytes, Wrapping::kGzip));
    put_bytes(scratch / "a.nrrd", whole);
    test::expect_every_truncation_is_an_error(scratch / "a.nrrd", scratch / "a.nrrd", whole.size());
    for (std::size_t at = head.size() + (bzip ? 0 : 10); at < whole.size(); ++at) {
      std::string changed = whole;
      changed[at] = static_cast<char>(changed[at] ^ 0x40);
      put_bytes(scratch / "a.nrrd", changed);
      // A few bits have no meaning, so the samples may still be right.
      try {
        VolumeReader reader = open_volume(scratch / "a.nrrd");
        EXPECT_EQ(test::read_as<std::uint16_t>(reader), values) << at;
      } catch (const Error& error) {
        EXPECT_TRUE(says(error.what(), "a.nrrd: expected")) << at;
      }
    }
  }
}

TEST(PackedVolume, BzipMayPackFarMoreThanGzip) {
  const test::Scratch scratch;
  const std::string packed = bzipped(std::string(40'000'000, '\0'));
  EXPECT_LT(packed.size(), 60u);
  const std::string head = "NRRD0004\ntype: uchar\nencoding: bzip2\nsizes: 1000 1000 ";
  put_bytes(scratch / "a.nrrd", head + "40\n\n" + packed);
  VolumeReader reader = open_volume(scratch / "a.nrrd");
  std::vector<std::byte> plane(1'000'000);
  reader.read_plane(39, plane);
  EXPECT_EQ(plane, std::vector<std::byte>(1'000'000));
  put_bytes(scratch / "b.nrrd", head + "1000\n\n" + packed);
  EXPECT_TRUE(says(message_of_volume(scratch / "b.nrrd"), "b.nrrd: expected 1000000000 bytes"));
}

TEST(PackedVolume, SizesThatCannotBe) {
  const test::Scratch scratch;
  const std::string packed = deflated("0123456789ab", Wrapping::kGzip);
  const auto message = [&](const std::string& sizes, const std::string& data) {
    put_bytes(scratch / "a.nrrd", "NRRD0004\ntype: uchar\nsizes: " + sizes + "\nencoding: gzip\n\n" + data);
    return message_of_volume(scratch / "a.nrrd");
  };
  EXPECT_TRUE(
      says(message("100000 100000 100", packed),
           fmt::format("a.nrrd: expected 1000000000000 bytes for 100000 x 100000 x 100 samples of uint8, "
                       "found {} packed ones",
                       packed.size())));
  EXPECT_TRUE(
      says(message("3 2 3", packed), "expected 18 bytes for 3 x 2 x 3 samples of uint8, found 12 unpacked"));
}

class Recorder final : public Progress {
 public:
  explicit Recorder(int most) : most_(most) {}
  void report(std::string_view stage, double fraction) override {
    ++reports_;
    EXPECT_EQ(stage, "unpacking");
    EXPECT_TRUE(fraction >= last_ && fraction <= 1);
    last_ = fraction;
  }
  [[nodiscard]] bool cancelled() const override { return reports_ >= most_; }
  [[nodiscard]] double last() const { return last_; }

 private:
  int most_, reports_ = 0;
  double last_ = 0;
};

TEST(PackedVolume, IsUnpackedIntoAFileWithoutAName) {
  const test::Scratch scratch, unpacked;
  put_bytes(scratch / "a.nrrd", "NRRD0004\ntype: uchar\nsizes: 1000 1000 10\nencoding: gzip\n\n" +
                                    deflated(std::string(10'000'000, 'x'), Wrapping::kGzip));
  Recorder progress(1000);
  {
    VolumeReader reader = open_volume(scratch / "a.nrrd", {{}, unpacked.folder()}, progress);
    EXPECT_EQ(unpacked.entries(), 0);
    EXPECT_EQ(reader.source().scratch->name(), unpacked.folder());
    EXPECT_EQ(test::read_as<std::uint8_t>(reader), std::vector<std::uint8_t>(10'000'000, 'x'));
  }
  EXPECT_EQ(progress.last(), 1);
  Recorder impatient(2);
  EXPECT_THROW(open_volume(scratch / "a.nrrd", {{}, unpacked.folder()}, impatient), Cancelled);
  EXPECT_TRUE(says(message_of_volume(scratch / "a.nrrd", {{}, scratch / "none"}),
                   "none: expected a folder for temporary files that can be written (--scratch or TMPDIR "
                   "names another): No such file"));
}

TEST(PackedVolume, AFullDiskIsAnErrorThatNamesTheFolder) {
  const test::Scratch scratch, unpacked;
  put_bytes(scratch / "a.nrrd", "NRRD0004\ntype: uchar\nsizes: 1000 1000 10\nencoding: gzip\n\n" +
                                    deflated(std::string(10'000'000, 'x'), Wrapping::kGzip));
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  auto* const handler = ::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{5'000'000, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  const std::string message = message_of_volume(scratch / "a.nrrd", {{}, unpacked.folder()});
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, handler);
  EXPECT_TRUE(
      says(message, unpacked.folder().string() +
                        ": expected room for unpacked samples, found a full disk after 5000000 bytes"));
}

}  // namespace
}  // namespace adamas
