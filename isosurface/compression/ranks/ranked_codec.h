#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "isosurface/compression/sample_codec.h"
#include "isosurface/volume/page.h"

namespace adamas::isosurface {

/// The different samples of a volume that has few, as words (OrderedWord), and the rank of each, that is, the
/// number of lesser ones.
class SampleRanks {
 public:
  static constexpr std::size_t kMost = std::size_t{1} << 16;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// Makes ranks of `values`, 1 to kMost of them, each greater than the one before.
  explicit SampleRanks(std::vector<std::uint32_t> values);
  /// Reads ranks of words of `bits` bits that `write` has written. Throws Error, which begins with `name`.
  static SampleRanks read(std::span<const std::byte> bytes, int bits, std::string_view name);

  [[nodiscard]] std::vector<std::byte> write() const;
  [[nodiscard]] std::span<const std::uint32_t> values() const { return values_; }
  /// Returns the rank of a value; kNone where there is no such value.
  [[nodiscard]] std::uint32_t rank(std::uint32_t value) const {
    if (value < values_.front() || value > values_.back()) return kNone;
    std::uint32_t rank = first_[(value - values_.front()) >> shift_];
    while (values_[rank] < value) ++rank;
    return values_[rank] == value ? rank : kNone;
  }
  template <class Word>
  void ranks(std::span<const Word> values, std::uint32_t* ranks) const;

 private:
  std::vector<std::uint32_t> values_;
  /// The rank of the first value whose distance from the least one has these upper bits or greater ones,
  /// indexed by these bits.
  std::vector<std::uint32_t> first_;
  int shift_ = 0;
};

/// Collects the different samples of a volume.
template <class Word>
class SampleCensus {
 public:
  /// Adds the page's own points.
  void add(const PageShape& shape, const PagePoints<Word>& samples);
  /// Returns the ranks; null where there are too many different samples for ranks to pay.
  [[nodiscard]] std::shared_ptr<const SampleRanks> ranks() const;

 private:
  /// The greatest number of different samples for which ranks pay. It is less for words of 16 bits, as ranks
  /// save less there.
  static constexpr std::size_t kMost = sizeof(Word) == 1 ? 0 : sizeof(Word) == 2 ? 4095 : SampleRanks::kMost;
  /// The least mean number of samples per value that pays for the bytes of the value.
  static constexpr std::uint64_t kLeastOfEach = 32;

  std::unordered_set<std::uint32_t> values_;  ///< at most one more than kMost
  std::uint64_t samples_ = 0;
  Word last_ = 0;
};

/// Codes samples by their ranks (SampleRanks), with a codec of words that need not be wider than the ranks. A
/// page with a sample that has no rank is stored raw; in predictions such a sample counts as the least.
template <class Word, class Rank>
class RankedCodec final : public SampleCodec<Word> {
 public:
  using typename SampleCodec<Word>::Samples;
  using typename SampleCodec<Word>::Around;

  RankedCodec(std::shared_ptr<const SampleRanks> ranks, std::unique_ptr<SampleCodec<Rank>> codec);

  [[nodiscard]] std::vector<std::byte> tables() const override;
  void encode_with(const PageShape& shape, const Around& around, const Samples& samples,
                   std::vector<std::byte>& out, std::span<const std::byte> along) const override;
  [[nodiscard]] bool decode_with(std::span<const std::byte> bytes, const PageShape& shape,
                                 const Around& around, Samples& samples, BytesAlong& along) const override;

 private:
  std::shared_ptr<const SampleRanks> ranks_;
  std::unique_ptr<SampleCodec<Rank>> codec_;
  std::vector<std::uint32_t> words_;  ///< indexed by rank; 0 where there is no value
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

}  // namespace adamas::isosurface
