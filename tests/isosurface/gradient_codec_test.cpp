#include "isosurface/compression/gradients/gradient_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/error.h"
#include "isosurface/gradients/octahedral_codes.h"
#include "tests/support/volume_pages.h"

namespace adamas {

using namespace isosurface;

namespace {

using Bytes = std::vector<std::byte>;
using Dimensions = std::array<std::uint64_t, 3>;
using Codes = std::vector<std::uint16_t>;
using Volume = test::VolumePages<std::uint16_t>;
using Content = test::PageContent<std::uint16_t>;

constexpr SampleCoding kCodings[] = {SampleCoding::kSplitEdge, SampleCoding::kInterpolation};

Codes equal_codes(const Dimensions& n, std::uint16_t code) { return Codes(n[0] * n[1] * n[2], code); }

Codes random_codes(const Dimensions& n) {
  std::mt19937 random(static_cast<unsigned>(n[0] + 50 * n[1] + 2500 * n[2]));
  Codes codes(n[0] * n[1] * n[2]);
  for (std::uint16_t& code : codes) code = static_cast<std::uint16_t>(random() >> 9);
  return codes;
}

/// Returns codes of directions away from a point; near that point there are none.
Codes smooth_codes(const Dimensions& n) {
  std::vector<Gradient> gradients;
  for (std::uint64_t k = 0; k < n[2]; ++k)
    for (std::uint64_t j = 0; j < n[1]; ++j)
      for (std::uint64_t i = 0; i < n[0]; ++i) {
        const auto x = static_cast<float>(i) - 7, y = static_cast<float>(j) - 9,
                   z = static_cast<float>(k) - 11;
        gradients.push_back(x * x + y * y + z * z < 9 ? Gradient{} : Gradient{x, y, z});
      }
  std::vector<OctahedralCode> pairs(gradients.size());
  encode_octahedral(gradients, pairs);
  Codes codes;
  for (const auto& [first, second] : pairs) codes.push_back(static_cast<std::uint16_t>(first | second << 8));
  return codes;
}

Content content_of(const Volume& volume, const PageId& page, std::uint16_t unused = 0) {
  Content content;
  volume.content(page, content, unused);
  return content;
}

GradientCodec codec_of(SampleCoding coding, const Volume& volume) {
  GradientSurvey survey(coding);
  for (const PageId& page : volume.pages()) {
    const Content content = content_of(volume, page);
    survey.add(content.shape, content.around, content.samples);
  }
  return survey.codec();
}

Bytes encoded(const GradientCodec& codec, const Content& content) {
  Bytes bytes;
  codec.encode(content.shape, content.around, content.samples, bytes);
  return bytes;
}

/// Expects that every page comes back, whatever lies where it has no points. Returns the bytes of all pages.
std::size_t expect_there_and_back(const GradientCodec& codec, const Volume& volume) {
  std::size_t total = 0;
  GradientCodes found;
  for (const PageId& page : volume.pages()) {
    const Content content = content_of(volume, page);
    const Bytes bytes = encoded(codec, content);
    EXPECT_EQ(encoded(codec, content_of(volume, page, 0xa5a5)), bytes);
    found.fill(77);
    EXPECT_TRUE(codec.decode(bytes, content.shape, content.around, found));
    const LatticePoint n = content.shape.count;
    std::size_t wrong = 0;
    for (std::int32_t k = 0; k < n.k; ++k)
      for (std::int32_t j = 0; j < n.j; ++j)
        for (std::int32_t i = 0; i < n.i; ++i) {
          const std::size_t place = PageGrid::place({i, j, k}, 0);
          wrong += content.samples[place] != found[place] ? 1 : 0;
        }
    EXPECT_EQ(wrong, 0u) << "level " << page.lod;
    // At worst the codes are raw, with a byte for the kind of each component and the size of the first one.
    EXPECT_LE(bytes.size(), 4 + 2 * PageGrid::kPoints);
    total += bytes.size();
  }
  return total;
}

std::size_t expect_there_and_back(SampleCoding coding, const Dimensions& dimensions, Codes codes) {
  const Volume volume(dimensions, std::move(codes));
  const GradientCodec codec = codec_of(coding, volume);
  const std::size_t total = expect_there_and_back(codec, volume);
  const GradientCodec parsed = GradientCodec::parse(coding, codec.tables(), "here");
  EXPECT_EQ(parsed.tables(), codec.tables());
  EXPECT_EQ(expect_there_and_back(parsed, volume), total);
  return total;
}

TEST(GradientCodec, TakesPagesOfAllCounts) {
  for (const SampleCoding coding : kCodings) {
    for (std::uint64_t n = 1; n <= 16; ++n) {
      // The last pages of an LOD have n points along one axis, those in the corner along all axes.
      for (const Dimensions& dimensions :
           {Dimensions{16 + n, 17, 18}, {17, 16 + n, 1}, {16 + n, 16 + n, 16 + n}}) {
        expect_there_and_back(coding, dimensions,
                              n % 2 == 0 ? random_codes(dimensions) : smooth_codes(dimensions));
      }
    }
  }
}

TEST(GradientCodec, TakesCompletePages) {
  for (const SampleCoding coding : kCodings) {
    for (const Dimensions& dimensions : {Dimensions{1, 1, 1}, {9, 9, 9}, {9, 4, 1}, {5, 6, 7}, {2, 1, 3}}) {
      expect_there_and_back(coding, dimensions, random_codes(dimensions));
      expect_there_and_back(coding, dimensions, smooth_codes(dimensions));
      expect_there_and_back(coding, dimensions, equal_codes(dimensions, 0));
    }
  }
}

TEST(GradientCodec, SpendsLessOnWhatIsSmooth) {
  const Dimensions dimensions{49, 40, 33};
  const std::size_t all = 2 * dimensions[0] * dimensions[1] * dimensions[2];
  for (const SampleCoding coding : kCodings) {
    // A page takes four bytes: the kinds, and the size of the first component.
    EXPECT_LE(expect_there_and_back(coding, dimensions, equal_codes(dimensions, 0x8040)),
              4 * Volume(dimensions, equal_codes(dimensions, 0)).pages().size() + 200);
    EXPECT_LT(expect_there_and_back(coding, dimensions, smooth_codes(dimensions)), all / 2);
    EXPECT_LT(expect_there_and_back(coding, dimensions, random_codes(dimensions)), all * 11 / 10);
  }
}

TEST(GradientCodec, CodesPagesThatItDidNotCount) {
  const Dimensions dimensions{35, 33, 20};
  const Volume flat(dimensions, equal_codes(dimensions, 3)), smooth(dimensions, smooth_codes(dimensions)),
      noise(dimensions, random_codes(dimensions));
  for (const SampleCoding coding : kCodings) {
    for (const Volume* counted : {&flat, &smooth, &noise}) {
      const GradientCodec codec = codec_of(coding, *counted);
      for (const Volume* coded : {&flat, &smooth, &noise}) expect_there_and_back(codec, *coded);
    }
    const GradientCodec none = GradientSurvey(coding).codec();
    for (const Volume* coded : {&flat, &smooth, &noise}) expect_there_and_back(none, *coded);
  }
}

TEST(GradientCodec, IsTheSameForPagesInAnyOrder) {
  const Dimensions dimensions{40, 36, 33};
  const Volume volume(dimensions, smooth_codes(dimensions));
  for (const SampleCoding coding : kCodings) {
    const Bytes tables = codec_of(coding, volume).tables();
    GradientSurvey back(coding), first(coding), second(coding);
    for (std::size_t n = volume.pages().size(); n-- > 0;) {
      const Content content = content_of(volume, volume.pages()[n]);
      back.add(content.shape, content.around, content.samples);
      (n % 3 == 0 ? first : second).add(content.shape, content.around, content.samples);
    }
    second.merge(first);
    EXPECT_EQ(back.codec().tables(), tables);
    EXPECT_EQ(second.codec().tables(), tables);
  }
}

TEST(GradientCodec, RefusesPagesThatAreCutOrTooLong) {
  const Dimensions dimensions{12, 9, 7};
  for (const SampleCoding coding : kCodings) {
    for (const Codes& codes :
         {smooth_codes(dimensions), random_codes(dimensions), equal_codes(dimensions, 9)}) {
      const Volume volume(dimensions, codes);
      const GradientCodec codec = codec_of(coding, volume);
      GradientCodes found;
      for (std::size_t n = 0; n < 2; ++n) {
        const Content content = content_of(volume, volume.pages()[n]);
        Bytes bytes = encoded(codec, content);
        for (std::size_t length = 0; length < bytes.size(); ++length) {
          ASSERT_FALSE(codec.decode(std::span(bytes).first(length), content.shape, content.around, found))
              << length;
        }
        bytes.push_back(std::byte{0});
        ASSERT_FALSE(codec.decode(bytes, content.shape, content.around, found));
      }
    }
  }
}

TEST(GradientCodec, AnswersToFlippedBytes) {
  const Dimensions dimensions{18, 12, 10};
  std::mt19937 random(12);
  const Volume volume(dimensions, smooth_codes(dimensions));
  for (const SampleCoding coding : kCodings) {
    const GradientCodec codec = codec_of(coding, volume);
    GradientCodes found;
    std::size_t taken = 0, told = 0;
    for (const PageId& page : volume.pages()) {
      const Content content = content_of(volume, page);
      const Bytes bytes = encoded(codec, content);
      for (std::size_t at = 0; at < bytes.size(); ++at) {
        Bytes corrupt = bytes;
        corrupt[at] ^= static_cast<std::byte>(1 + random() % 255);
        ++(codec.decode(corrupt, content.shape, content.around, found) ? taken : told);
      }
    }
    EXPECT_GT(told, 0u);
    EXPECT_GT(taken, 0u);
  }
}

TEST(GradientCodec, RefusesTablesThatAreNone) {
  const Dimensions dimensions{33, 20, 18};
  const Volume volume(dimensions, smooth_codes(dimensions));
  std::mt19937 random(13);
  for (const SampleCoding coding : kCodings) {
    const Bytes tables = codec_of(coding, volume).tables();
    for (std::size_t length = 0; length < tables.size(); ++length) {
      EXPECT_THROW(static_cast<void>(GradientCodec::parse(coding, std::span(tables).first(length), "here")),
                   Error)
          << length;
    }
    Bytes longer = tables;
    longer.push_back(std::byte{0});
    EXPECT_THROW(static_cast<void>(GradientCodec::parse(coding, longer, "here")), Error);
    for (int trial = 0; trial < 200; ++trial) {
      Bytes corrupt = tables;
      corrupt[random() % corrupt.size()] ^= static_cast<std::byte>(1u << random() % 8);
      try {
        ASSERT_EQ(GradientCodec::parse(coding, corrupt, "here").tables(), corrupt);
      } catch (const Error& error) {
        ASSERT_EQ(std::string(error.what()).rfind("here: ", 0), 0u) << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace adamas
