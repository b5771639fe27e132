#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "isosurface/compression/sample_codec.h"
#include "isosurface/compression/sample_ranks.h"

namespace adamas {

/// Codes samples by their ranks (SampleRanks), with a codec of words that need not be wider than the ranks. A
/// page with a sample that has no rank is stored raw; in what a page is predicted from such a sample counts
/// as the least.
template <class Word, class Rank>
class RankedCodec final : public SampleCodec<Word> {
 public:
  using typename SampleCodec<Word>::Samples;
  using typename SampleCodec<Word>::Around;

  RankedCodec(std::shared_ptr<const SampleRanks> ranks, std::unique_ptr<SampleCodec<Rank>> codec);

  [[nodiscard]] std::vector<std::byte> tables() const override;
  void encode(const PageShape& shape, const Around& around, const Samples& samples,
              std::vector<std::byte>& out) const override;
  [[nodiscard]] bool decode(std::span<const std::byte> bytes, const PageShape& shape, const Around& around,
                            Samples& samples) const override;

 private:
  std::shared_ptr<const SampleRanks> ranks_;
  std::unique_ptr<SampleCodec<Rank>> codec_;
  std::vector<std::uint32_t> words_;  ///< by any rank; 0 where there is none
};

template <class Word, class Rank>
class RankedSurvey final : public SampleSurvey<Word> {
 public:
  using typename SampleSurvey<Word>::Samples;
  using typename SampleSurvey<Word>::Around;

  RankedSurvey(std::shared_ptr<const SampleRanks> ranks, std::unique_ptr<SampleSurvey<Rank>> survey);
  void add(const PageShape& shape, const Around& around, const Samples& samples) override;
  void merge(const SampleSurvey<Word>& other) override;
  [[nodiscard]] std::unique_ptr<SampleCodec<Word>> codec() const override;

 private:
  std::shared_ptr<const SampleRanks> ranks_;
  std::unique_ptr<SampleSurvey<Rank>> survey_;
};

}  // namespace adamas
