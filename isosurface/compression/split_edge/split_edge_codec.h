#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "isosurface/compression/sample_codec.h"
#include "isosurface/compression/split_edge/residual_code.h"

namespace adamas::isosurface {

/// The codec of SampleCoding::kSplitEdge: the residuals of a page in hierarchical z-order, by a ResidualCode.
/// A page that has a residual without a codeword, or does not shrink, is stored raw.
template <class Word>
class SplitEdgeCodec : public SampleCodec<Word> {
 public:
  using typename SampleCodec<Word>::Samples;
  using typename SampleCodec<Word>::Around;

  explicit SplitEdgeCodec(ResidualCode code) : code_(std::move(code)) {}

  [[nodiscard]] std::vector<std::byte> tables() const override { return code_.serialise(); }
  void encode_with(const PageShape& shape, const Around& around, const Samples& samples,
                   std::vector<std::byte>& out, std::span<const std::byte> along) const override;
  [[nodiscard]] bool decode_with(std::span<const std::byte> bytes, const PageShape& shape,
                                 const Around& around, Samples& samples, BytesAlong& along) const override;

 private:
  ResidualCode code_;
};

template <class Word>
class SplitEdgeSurvey final : public SampleSurvey<Word> {
 public:
  using typename SampleSurvey<Word>::Samples;
  using typename SampleSurvey<Word>::Around;

  void add(const PageShape& shape, const Around& around, const Samples& samples) override;
  void merge(const SampleSurvey<Word>& other) override;
  [[nodiscard]] std::unique_ptr<SampleCodec<Word>> codec() const override;

 private:
  ResidualStatistics statistics_{8 * static_cast<int>(sizeof(Word))};
};

}  // namespace adamas::isosurface
