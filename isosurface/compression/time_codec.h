#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "isosurface/compression/sample_codec.h"

namespace adamas::isosurface {

// Pages of a series are coded in space, as those of a volume, or as differences in time (D 5.1): the samples
// less those of the step before, or less what these and those of the step before that lead on to. Differences
// are words modulo 2^bits, so that nothing is lost, and coded in space in turn. The first byte of a coded
// page has the order of its differences, from 0 to 2, above the two bits of its kind.

/// The only byte of a page whose own points have the samples of the step before: of order 1, and of a kind
/// that differences do not have.
inline constexpr std::byte kAsBefore{3 | 1 << 2};

/// Every so many steps, from the first one on, pages are coded in space alone.
inline constexpr std::uint32_t kWholeSteps = 8;

/// How many steps before this one its pages may be coded with.
constexpr int steps_before(std::uint32_t step) { return static_cast<int>(std::min(step % kWholeSteps, 2u)); }

/// The order of the differences that a coded page holds; from 0 to 63, of which those above 2 are none.
constexpr int time_order(std::span<const std::byte> coded) {
  return coded.empty() ? 0 : std::to_integer<int>(coded[0]) >> 2;
}

/// A page's samples, and those round it, one step before or two.
template <class Word>
struct EarlierPage {
  PagePoints<Word> samples;
  typename Surroundings<Word>::template Points<Word> around;  ///< undefined where the page is complete
};

/// Counts what pages of a series hold, as SampleSurvey, for the tables of their codecs.
template <class Word>
class TimeSurvey {
 public:
  /// `in_space`: of samples. `with_differences`: whether pages may be coded in time at all.
  TimeSurvey(std::unique_ptr<SampleSurvey<Word>> in_space, SampleCoding coding, bool with_differences);

  using Around = typename SampleCodec<Word>::Around;
  using Samples = typename SampleCodec<Word>::Samples;

  /// `before`: of the step before, then of that before it, as many as the page may be coded with.
  void add(const PageShape& shape, const Around& around, const Samples& samples,
           std::span<const EarlierPage<Word>> before);
  void merge(const TimeSurvey& other);

  [[nodiscard]] std::unique_ptr<SampleCodec<Word>> codec() const { return in_space_->codec(); }
  /// Null where no page may be coded in time.
  [[nodiscard]] std::unique_ptr<SampleCodec<Word>> differences() const {
    return differences_ ? differences_->codec() : nullptr;
  }

 private:
  std::unique_ptr<SampleSurvey<Word>> in_space_, differences_;
};

/// Makes pages of samples of a series into bytes and back, lossless. May be used by several threads at once.
template <class Word>
class TimeCodec {
 public:
  using Around = typename SampleCodec<Word>::Around;
  using Samples = typename SampleCodec<Word>::Samples;

  explicit TimeCodec(const TimeSurvey<Word>& survey)
      : in_space_(survey.codec()), differences_(survey.differences()) {}
  /// From `tables` and `time_tables`, which are empty where no page is coded in time. Throws Error, which
  /// begins with `name`, unless a codec's tables could have given just these bytes.
  TimeCodec(SampleCoding coding, std::span<const std::byte> tables, std::span<const std::byte> time_tables,
            std::string_view name);

  [[nodiscard]] std::vector<std::byte> tables() const { return in_space_->tables(); }
  [[nodiscard]] std::vector<std::byte> time_tables() const {
    return differences_ ? differences_->tables() : std::vector<std::byte>{};
  }

  /// Appends the page's own points in the shortest way that was found; the rest is as of SampleCodec.
  /// `before`: as many as the page may be coded with.
  void encode(const PageShape& shape, const Around& around, const Samples& samples,
              std::span<const EarlierPage<Word>> before, std::vector<std::byte>& out,
              std::span<const std::byte> along) const;
  /// `before`: time_order(bytes) of them, or more. Returns false, and leaves anything in `samples` and
  /// `along`, where the bytes are not those of a page.
  [[nodiscard]] bool decode(std::span<const std::byte> bytes, const PageShape& shape, const Around& around,
                            std::span<const EarlierPage<Word>> before, Samples& samples,
                            BytesAlong& along) const;

 private:
  std::unique_ptr<SampleCodec<Word>> in_space_, differences_;
};

extern template class TimeSurvey<std::uint8_t>;
extern template class TimeSurvey<std::uint16_t>;
extern template class TimeSurvey<std::uint32_t>;
extern template class TimeCodec<std::uint8_t>;
extern template class TimeCodec<std::uint16_t>;
extern template class TimeCodec<std::uint32_t>;

}  // namespace adamas::isosurface
