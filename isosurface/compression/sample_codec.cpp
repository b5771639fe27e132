#include "isosurface/compression/sample_codec.h"

#include "core/base/assert.h"
#include "isosurface/compression/interpolation_codec.h"
#include "isosurface/compression/split_edge_codec.h"

namespace adamas {

template <class Word>
std::unique_ptr<SampleSurvey<Word>> sample_survey(SampleCoding coding) {
  if (coding == SampleCoding::kSplitEdge) return std::make_unique<SplitEdgeSurvey<Word>>();
  ADAMAS_ASSERT(coding == SampleCoding::kInterpolation);
  return std::make_unique<InterpolationSurvey<Word>>();
}

template <class Word>
std::unique_ptr<SampleCodec<Word>> parse_sample_codec(SampleCoding coding, std::span<const std::byte> tables,
                                                      std::string_view name) {
  if (coding == SampleCoding::kSplitEdge) {
    constexpr int kBits = 8 * static_cast<int>(sizeof(Word));
    return std::make_unique<SplitEdgeCodec<Word>>(ResidualCode::parse(tables, kBits, name));
  }
  ADAMAS_ASSERT(coding == SampleCoding::kInterpolation);
  return std::make_unique<InterpolationCodec<Word>>(InterpolationCodec<Word>::parse(tables, name));
}

template std::unique_ptr<SampleSurvey<std::uint8_t>> sample_survey(SampleCoding);
template std::unique_ptr<SampleSurvey<std::uint16_t>> sample_survey(SampleCoding);
template std::unique_ptr<SampleSurvey<std::uint32_t>> sample_survey(SampleCoding);
template std::unique_ptr<SampleCodec<std::uint8_t>> parse_sample_codec(SampleCoding,
                                                                       std::span<const std::byte>,
                                                                       std::string_view);
template std::unique_ptr<SampleCodec<std::uint16_t>> parse_sample_codec(SampleCoding,
                                                                        std::span<const std::byte>,
                                                                        std::string_view);
template std::unique_ptr<SampleCodec<std::uint32_t>> parse_sample_codec(SampleCoding,
                                                                        std::span<const std::byte>,
                                                                        std::string_view);

}  // namespace adamas
