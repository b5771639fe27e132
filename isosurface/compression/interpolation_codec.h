#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "isosurface/compression/activity_context.h"
#include "isosurface/compression/context_tables.h"
#include "isosurface/compression/interpolation_cells.h"
#include "isosurface/compression/residual_tokens.h"
#include "isosurface/compression/sample_codec.h"

namespace adamas {

/// SampleCoding::kInterpolation. A page is predicted in the sets of InterpolationPrediction. The activity
/// round a point and its set are the context of its residual; all activities of a set are known before any of
/// its residuals. A ResidualWriter codes the residuals set by set, with the tables of the whole file, after a
/// byte with the page's kind. A complete page is predicted as in SplitEdgeCodec, and has one context of its
/// own.
template <class Depth>
class InterpolationCodec final : public SampleCodec<typename Depth::Word> {
 public:
  using Word = typename Depth::Word;
  using typename SampleCodec<Word>::Samples;
  using typename SampleCodec<Word>::Around;
  static constexpr std::size_t kContextsOfSet = ActivityContext<Depth>::kContexts;
  static constexpr std::size_t kComplete = InterpolationCells<Depth>::kSets * kContextsOfSet;
  static constexpr std::size_t kContexts = kComplete + 1;

  explicit InterpolationCodec(ContextTables contexts);
  /// Throws Error, which begins with `name`.
  static InterpolationCodec parse(std::span<const std::byte> tables, std::string_view name);

  [[nodiscard]] std::vector<std::byte> tables() const override;
  void encode(const PageShape& shape, const Around& around, const Samples& samples,
              std::vector<std::byte>& out) const override;
  [[nodiscard]] bool decode(std::span<const std::byte> bytes, const PageShape& shape, const Around& around,
                            Samples& samples) const override;

 private:
  using Reader = ResidualReader<Word>;

  /// What gives the table of an activity of the set.
  [[nodiscard]] auto table_of(int set) const;
  bool decode_smooth(const PageShape& shape, const Around& around, Samples& samples) const;
  bool decode_sets(Reader& reader, const PageShape& shape, const Around& around, Samples& samples) const;
  bool decode_complete(Reader& reader, const PageShape& shape, Samples& samples) const;

  ContextTables contexts_;
  RansTables tables_;
  std::vector<std::uint8_t> table_of_activity_;  ///< by set, where activities are few enough
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
  ContextCounts counts_;
};

}  // namespace adamas
