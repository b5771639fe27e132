#include "isosurface/compression/sample_codec.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "isosurface/compression/byte_stream.h"
#include "isosurface/compression/interpolation/interpolation_codec.h"
#include "isosurface/compression/page_order.h"
#include "isosurface/compression/ranks/ranked_codec.h"
#include "isosurface/compression/split_edge/split_edge_codec.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {
namespace {

/// The codec of SampleCoding::kPlain: every page is raw, so that all pages of one shape have the same size.
/// It is the baseline of compression.
template <class Word>
class PlainCodec final : public SplitEdgeCodec<Word> {
 public:
  using typename SampleCodec<Word>::Samples;
  using typename SampleCodec<Word>::Around;

  PlainCodec() : SplitEdgeCodec<Word>(ResidualCode(ResidualStatistics(8 * static_cast<int>(sizeof(Word))))) {}

  void encode_with(const PageShape& shape, const Around&, const Samples& samples, std::vector<std::byte>& out,
                   std::span<const std::byte>) const override {
    write_raw<Word>(shape, samples, out);
  }
};

/// A survey that counts nothing, as raw pages need no tables.
template <class Word>
class PlainSurvey final : public SampleSurvey<Word> {
 public:
  using typename SampleSurvey<Word>::Samples;
  using typename SampleSurvey<Word>::Around;

  void add(const PageShape&, const Around&, const Samples&) override {}
  void merge(const SampleSurvey<Word>&) override {}
  [[nodiscard]] std::unique_ptr<SampleCodec<Word>> codec() const override {
    return std::make_unique<PlainCodec<Word>>();
  }
};

/// Calls make(depth) with the least depth that can hold so many ranks.
template <class Make>
auto with_depth_of_ranks(std::size_t count, Make make) {
  if (count <= std::size_t{Depth8::kGreatest} + 1) return make(Depth8{});
  if (count <= std::size_t{Depth12::kGreatest} + 1) return make(Depth12{});
  return make(Depth16{});
}

/// Returns the prevailing sample, if there is one and samples have one byte.
template <class Word>
std::optional<Word> prevailing_byte(std::optional<std::uint32_t> prevailing) {
  if (sizeof(Word) > 1 || !prevailing || *prevailing > std::numeric_limits<Word>::max()) return {};
  return static_cast<Word>(*prevailing);
}

template <class Word>
std::unique_ptr<SampleSurvey<Word>> ranked_survey(std::shared_ptr<const SampleRanks> ranks,
                                                  std::optional<Word> prevailing) {
  return with_depth_of_ranks(ranks->values().size(), [&](auto depth) -> std::unique_ptr<SampleSurvey<Word>> {
    using Depth = decltype(depth);
    using Rank = typename Depth::Word;
    std::optional<std::uint32_t> rank;
    if (prevailing) rank = ranks->rank(*prevailing);
    return std::make_unique<RankedSurvey<Word, Rank>>(
        std::move(ranks), std::make_unique<InterpolationSurvey<Depth>>(prevailing_byte<Rank>(rank)));
  });
}

template <class Depth>
std::unique_ptr<SampleCodec<typename Depth::Word>> parse_interpolation(std::span<const std::byte> tables,
                                                                       std::string_view name) {
  return std::make_unique<InterpolationCodec<Depth>>(InterpolationCodec<Depth>::parse(tables, name));
}

template <class Word>
std::unique_ptr<SampleCodec<Word>> parse_ranked(std::span<const std::byte> tables, std::string_view name) {
  ByteReader in(tables);
  const std::span<const std::byte> bytes = in.sized_bytes();
  if (!in.good()) fail("{}: expected the different samples, found too little data", name);
  auto ranks =
      std::make_shared<const SampleRanks>(SampleRanks::read(bytes, 8 * static_cast<int>(sizeof(Word)), name));
  return with_depth_of_ranks(ranks->values().size(), [&](auto depth) -> std::unique_ptr<SampleCodec<Word>> {
    using Depth = decltype(depth);
    return std::make_unique<RankedCodec<Word, typename Depth::Word>>(
        std::move(ranks), parse_interpolation<Depth>(in.rest(), name));
  });
}

}  // namespace

std::size_t carried_along(SampleCoding coding, std::byte first, std::size_t size) {
  const bool carries = coding != SampleCoding::kSplitEdge &&
                       static_cast<PageKind>(first & std::byte{3}) == PageKind::kResiduals;
  return carries ? std::min(size, std::tuple_size_v<BytesAlong>) : 0;
}

template <class Word>
std::unique_ptr<SampleSurvey<Word>> sample_survey(SampleCoding coding,
                                                  std::shared_ptr<const SampleRanks> ranks,
                                                  std::optional<Word> prevailing) {
  ADAMAS_ASSERT((coding == SampleCoding::kRanks) == (ranks != nullptr));
  if (coding == SampleCoding::kPlain) return std::make_unique<PlainSurvey<Word>>();
  if (coding == SampleCoding::kSplitEdge) return std::make_unique<SplitEdgeSurvey<Word>>();
  if constexpr (sizeof(Word) > 1) {
    if (coding == SampleCoding::kRanks) return ranked_survey<Word>(std::move(ranks), prevailing);
  }
  ADAMAS_ASSERT(coding == SampleCoding::kInterpolation);
  return std::make_unique<InterpolationSurvey<DepthOf<Word>>>(prevailing_byte<Word>(prevailing));
}

template <class Word>
std::unique_ptr<SampleCodec<Word>> parse_sample_codec(SampleCoding coding, std::span<const std::byte> tables,
                                                      std::string_view name) {
  if (coding == SampleCoding::kSplitEdge) {
    constexpr int kBits = 8 * static_cast<int>(sizeof(Word));
    return std::make_unique<SplitEdgeCodec<Word>>(ResidualCode::parse(tables, kBits, name));
  }
  if constexpr (sizeof(Word) > 1) {
    if (coding == SampleCoding::kRanks) return parse_ranked<Word>(tables, name);
  }
  if (coding == SampleCoding::kRanks) fail("{}: expected ranks of samples of 2 bytes or more, found 1", name);
  return parse_interpolation<DepthOf<Word>>(tables, name);
}

ADAMAS_INSTANTIATE_FUNCTION_FOR_WORDS(sample_survey);
ADAMAS_INSTANTIATE_FUNCTION_FOR_WORDS(parse_sample_codec);

}  // namespace adamas::isosurface
