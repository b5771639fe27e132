#pragma once

#include <memory>
#include <span>
#include <vector>

#include "isosurface/compression/page_order.h"
#include "isosurface/compression/split_edge/split_edge_codec.h"

namespace adamas::isosurface {

/// SampleCoding::kPlain: every page raw, whatever it holds, so that all of one shape have the same size. What
/// compression is compared with.
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

/// Nothing needs to be counted.
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

}  // namespace adamas::isosurface
