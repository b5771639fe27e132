#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "isosurface/compression/entropy/context_tables.h"
#include "isosurface/compression/interpolation/interpolation_page.h"
#include "isosurface/compression/interpolation/residual_tokens.h"
#include "isosurface/compression/sample_codec.h"

namespace adamas::isosurface {

/// The codec of SampleCoding::kInterpolation. A page is predicted in the sets of InterpolationPrediction. The
/// activity round a point and its set are the context of its residual; all activities of a set are known
/// before any of its residuals. A volume with samples of one byte may have a prevailing sample, such as the
/// background of a scan: it has a token of its own where it is not predicted, and the distance of predictions
/// from it is a part of the context. A ResidualWriter codes the residuals set by set, with the tables of the
/// whole file, after a byte with the page's kind. A complete page is predicted as in SplitEdgeCodec, and has
/// one context of its own.
template <class Depth>
class InterpolationCodec final : public SampleCodec<typename Depth::Word> {
 public:
  using Word = typename Depth::Word;
  using typename SampleCodec<Word>::Samples;
  using typename SampleCodec<Word>::Around;
  using Prevailing = std::optional<Word>;
  static constexpr bool kMayPrevail = ResidualToken<Word>::kHasPrevailing;
  static constexpr std::size_t contexts_of_set(bool prevails) {
    return std::size_t{ActivityContext<Depth>::kContexts} * (prevails ? ActivityContext<Depth>::kClasses : 1);
  }
  /// Returns the context of a complete page, which comes behind those of the sets.
  static constexpr std::size_t complete_context(bool prevails) {
    return InterpolationCells<Depth>::kSets * contexts_of_set(prevails);
  }
  static constexpr std::size_t token_count(bool prevails) {
    return std::size_t{ResidualToken<Word>::kTokens} + (prevails ? 1 : 0);
  }

  /// Makes a codec. No sample prevails unless kMayPrevail is set.
  InterpolationCodec(ContextTables contexts, Prevailing prevailing);
  /// Makes a codec from its tables. Throws Error, which begins with `name`.
  static InterpolationCodec parse(std::span<const std::byte> tables, std::string_view name);

  [[nodiscard]] std::vector<std::byte> tables() const override;
  void encode_with(const PageShape& shape, const Around& around, const Samples& samples,
                   std::vector<std::byte>& out, std::span<const std::byte> along) const override;
  [[nodiscard]] bool decode_with(std::span<const std::byte> bytes, const PageShape& shape,
                                 const Around& around, Samples& samples, BytesAlong& along) const override;

 private:
  using Reader = ResidualReader<Word>;

  /// Returns a function from an activity of the set to its table.
  [[nodiscard]] auto table_of(int set) const;
  /// Predicts a set, and finds the numbers by which its tables are indexed.
  template <std::size_t Bytes>
  void predict(InterpolationPage<Depth>& page, int set) const;
  bool decode_smooth(const PageShape& shape, const Around& around, Samples& samples) const;
  bool decode_sets(Reader& reader, const PageShape& shape, const Around& around, Samples& samples) const;
  bool decode_complete(Reader& reader, const PageShape& shape, Samples& samples) const;

  Prevailing prevailing_;
  ContextTables contexts_;
  RansTables tables_;
  /// Indexed by set and activity, if activities are few enough.
  std::vector<std::uint8_t> table_of_activity_;
};

template <class Depth>
class InterpolationSurvey final : public SampleSurvey<typename Depth::Word> {
 public:
  using Word = typename Depth::Word;
  using typename SampleSurvey<Word>::Samples;
  using typename SampleSurvey<Word>::Around;

  explicit InterpolationSurvey(std::optional<Word> prevailing = {});
  void add(const PageShape& shape, const Around& around, const Samples& samples) override;
  void merge(const SampleSurvey<Word>& other) override;
  [[nodiscard]] std::unique_ptr<SampleCodec<Word>> codec() const override;

 private:
  std::optional<Word> prevailing_;
  ContextCounts counts_;
};

}  // namespace adamas::isosurface
