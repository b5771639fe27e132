#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "isosurface/compression/activity_context.h"
#include "isosurface/compression/context_groups.h"
#include "isosurface/compression/interpolation_cells.h"
#include "isosurface/compression/range_coder.h"
#include "isosurface/compression/residual_reader.h"
#include "isosurface/compression/sample_codec.h"

namespace adamas {

/// SampleCoding::kInterpolation. A page is predicted in the sets of InterpolationPrediction; the activity
/// round a point and its set are the context of its residual, all of a set known before any of its residuals.
/// Tokens are coded by RangeTables, with the contexts and frequencies of the whole file; what tokens leave
/// open are plain bits. A complete page is predicted as in SplitEdgeCodec, and has a context of its own.
///
/// Bytes: the kind; the states, 4 bits for the length of each and the bits below its leading 1; the plain
/// bits; zeros up to a whole byte; words of 16 bits, which are read from the last to the first.
template <class Depth>
class InterpolationCodec final : public SampleCodec<typename Depth::Word> {
 public:
  using Word = typename Depth::Word;
  using typename SampleCodec<Word>::Samples;
  using typename SampleCodec<Word>::Around;
  static constexpr std::size_t kContextsOfSet = ActivityContext<Depth>::kContexts;
  static constexpr std::size_t kComplete = InterpolationCells<Depth>::kSets * kContextsOfSet;
  static constexpr std::size_t kContexts = kComplete + 1;

  explicit InterpolationCodec(ContextGroups groups);
  /// Throws Error, which begins with `name`.
  static InterpolationCodec parse(std::span<const std::byte> tables, std::string_view name);

  [[nodiscard]] std::vector<std::byte> tables() const override;
  void encode(const PageShape& shape, const Around& around, const Samples& samples,
              std::vector<std::byte>& out) const override;
  [[nodiscard]] bool decode(std::span<const std::byte> bytes, const PageShape& shape, const Around& around,
                            Samples& samples) const override;

 private:
  using Reader = ResidualReader<Word>;

  /// The group of an activity of the set.
  [[nodiscard]] auto group_of(int set) const;
  bool decode_smooth(const PageShape& shape, const Around& around, Samples& samples) const;
  bool decode_sets(Reader& reader, const PageShape& shape, const Around& around, Samples& samples) const;
  bool decode_complete(Reader& reader, const PageShape& shape, Samples& samples) const;
  /// Appends the code of residuals, of which point n is in groups[n].
  void write(std::span<const std::uint8_t> groups, std::span<const Word> folded,
             std::vector<std::byte>& out) const;

  ContextGroups groups_;
  RangeTables tables_;
  std::vector<std::uint8_t> group_of_activity_;  ///< by set, where they have a table
};

template <class Depth>
class InterpolationSurvey final : public SampleSurvey<typename Depth::Word> {
 public:
  using Word = typename Depth::Word;
  using typename SampleSurvey<Word>::Samples;
  using typename SampleSurvey<Word>::Around;

  InterpolationSurvey();
  void add(const PageShape& shape, const Around& around, const Samples& samples) override;
  void merge(const SampleSurvey<Word>& other) override;
  [[nodiscard]] std::unique_ptr<SampleCodec<Word>> codec() const override;

 private:
  ContextTallies counts_;
};

}  // namespace adamas
