#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "isosurface/compression/sample_codec.h"
#include "isosurface/volume/page.h"

namespace adamas::timevarying {

// Pages of a series are coded in space, like those of a volume, or as differences in time (D 5.1): the
// samples minus those of the step before, or minus the linear extrapolation of the two steps before.
// Differences are words modulo 2^bits, so that nothing is lost, and are then coded in space. time_order()
// tells how a page is coded.

/// The samples of a page at an earlier step, and those round it.
template <class Word>
struct EarlierPage {
  isosurface::PagePoints<Word> samples;
  /// Undefined if the page is complete.
  typename isosurface::Surroundings<Word>::template Points<Word> around;
};

/// Collects the statistics of the pages of a series, as SampleSurvey does, for the tables of a TimeCodec.
template <class Word>
class TimeSurvey {
 public:
  /// `in_space` surveys samples; `with_differences` says whether pages may be coded in time at all.
  TimeSurvey(std::unique_ptr<isosurface::SampleSurvey<Word>> in_space, isosurface::SampleCoding coding,
             bool with_differences);

  using Around = typename isosurface::SampleCodec<Word>::Around;
  using Samples = typename isosurface::SampleCodec<Word>::Samples;

  /// `before` has the page at the step before, then at the one before that, as many as it may be coded with.
  void add(const isosurface::PageShape& shape, const Around& around, const Samples& samples,
           std::span<const EarlierPage<Word>> before);
  void merge(const TimeSurvey& other);

  [[nodiscard]] std::unique_ptr<isosurface::SampleCodec<Word>> codec() const { return in_space_->codec(); }
  /// The codec of differences; null if no page may be coded in time.
  [[nodiscard]] std::unique_ptr<isosurface::SampleCodec<Word>> differences() const {
    return differences_ ? differences_->codec() : nullptr;
  }

 private:
  std::unique_ptr<isosurface::SampleSurvey<Word>> in_space_, differences_;
};

/// Codes the samples of pages of a series without loss. Several threads may use it at once.
template <class Word>
class TimeCodec {
 public:
  using Around = typename isosurface::SampleCodec<Word>::Around;
  using Samples = typename isosurface::SampleCodec<Word>::Samples;

  explicit TimeCodec(const TimeSurvey<Word>& survey)
      : in_space_(survey.codec()), differences_(survey.differences()) {}
  /// Makes the codec again from its tables; `time_tables` are empty if no page is coded in time. Throws
  /// Error, which begins with `name`, unless a codec could have written exactly these bytes as its tables.
  TimeCodec(isosurface::SampleCoding coding, std::span<const std::byte> tables,
            std::span<const std::byte> time_tables, std::string_view name);

  [[nodiscard]] const isosurface::SampleCodec<Word>& in_space() const { return *in_space_; }
  [[nodiscard]] std::vector<std::byte> tables() const { return in_space_->tables(); }
  [[nodiscard]] std::vector<std::byte> time_tables() const {
    return differences_ ? differences_->tables() : std::vector<std::byte>{};
  }

  /// Appends the page's own points in the shortest coding found; everything else is as in SampleCodec.
  /// `before` has as many pages as this one may be coded with.
  void encode(const isosurface::PageShape& shape, const Around& around, const Samples& samples,
              std::span<const EarlierPage<Word>> before, std::vector<std::byte>& out,
              std::span<const std::byte> along) const;
  /// `before` has at least time_order(bytes) pages. Returns false if the bytes are not those of a page;
  /// `samples` and `along` are then unspecified.
  [[nodiscard]] bool decode(std::span<const std::byte> bytes, const isosurface::PageShape& shape,
                            const Around& around, std::span<const EarlierPage<Word>> before, Samples& samples,
                            isosurface::BytesAlong& along) const;

 private:
  std::unique_ptr<isosurface::SampleCodec<Word>> in_space_, differences_;
};

extern template class TimeSurvey<std::uint8_t>;
extern template class TimeSurvey<std::uint16_t>;
extern template class TimeSurvey<std::uint32_t>;
extern template class TimeCodec<std::uint8_t>;
extern template class TimeCodec<std::uint16_t>;
extern template class TimeCodec<std::uint32_t>;

}  // namespace adamas::timevarying
