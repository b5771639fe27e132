#include "timevarying/time_codec.h"

#include <bit>

#include "core/base/assert.h"
#include "isosurface/storage/store_format.h"

namespace adamas::timevarying {

using namespace isosurface;

namespace {

/// The word that represents the difference 0.
template <class Word>
constexpr Word kMiddle = static_cast<Word>(Word{1} << (8 * sizeof(Word) - 1));

/// Predicts samples from those of the steps before: by `one` for order 1; for order 2 by extrapolating the
/// line through `two` and `one`.
template <class Word, std::size_t N>
void extrapolate(int order, const std::array<Word, N>& one, const std::array<Word, N>& two,
                 std::array<Word, N>& to) {
  for (std::size_t n = 0; n < N; ++n)
    to[n] = order == 1 ? one[n] : static_cast<Word>(one[n] + static_cast<Word>(one[n] - two[n]));
}

/// A page as differences of an order, and the differences round it.
template <class Word>
struct Differences {
  PagePoints<Word> samples;
  typename Surroundings<Word>::template Points<Word> around;

  Differences() = default;
  Differences(int order, const PageShape& shape, std::span<const EarlierPage<Word>> before,
              const typename SampleCodec<Word>::Around& around_now, const PagePoints<Word>* now) {
    ADAMAS_ASSERT(order >= 1 && static_cast<std::size_t>(order) <= before.size());
    const EarlierPage<Word>&one = before[0], &two = before[static_cast<std::size_t>(order) - 1];
    extrapolate(order, one.samples, two.samples, samples);
    if (now != nullptr) subtract_from(*now, samples);
    if (shape.complete) return;
    extrapolate(order, one.around, two.around, around);
    subtract_from(around_now, around);
  }

  template <std::size_t N>
  static void subtract_from(const std::array<Word, N>& now, std::array<Word, N>& numbers) {
    for (std::size_t n = 0; n < N; ++n) numbers[n] = static_cast<Word>(now[n] - numbers[n] + kMiddle<Word>);
  }

  /// The number of bits of all differences of own points, without their signs.
  [[nodiscard]] std::uint64_t bits(const PageShape& shape) const {
    std::uint64_t sum = 0;
    for_each_own_place(shape, [&](std::size_t place) {
      const auto from = static_cast<Word>(samples[place] - kMiddle<Word>);
      const auto magnitude = from >= kMiddle<Word> ? static_cast<Word>(0 - from) : from;
      sum += static_cast<std::uint64_t>(std::bit_width(magnitude));
    });
    return sum;
  }
};

/// Whether a page's own points have the same samples as the step before.
template <class Word>
bool is_as_before(const PageShape& shape, const PagePoints<Word>& samples,
                  std::span<const EarlierPage<Word>> before) {
  bool same = !before.empty();
  for_each_own_place(shape,
                     [&](std::size_t place) { same = same && samples[place] == before[0].samples[place]; });
  return same;
}

/// Finds the order whose differences have the fewest bits, and sets `best` to these. `before` must not be
/// empty.
template <class Word>
int best_differences(const PageShape& shape, const typename SampleCodec<Word>::Around& around,
                     const PagePoints<Word>& samples, std::span<const EarlierPage<Word>> before,
                     Differences<Word>& best) {
  best = Differences<Word>(1, shape, before, around, &samples);
  if (before.size() < 2) return 1;
  const Differences<Word> second(2, shape, before, around, &samples);
  if (second.bits(shape) >= best.bits(shape)) return 1;
  best = second;
  return 2;
}

}  // namespace

template <class Word>
TimeSurvey<Word>::TimeSurvey(std::unique_ptr<SampleSurvey<Word>> in_space, SampleCoding coding,
                             bool with_differences)
    : in_space_(std::move(in_space)) {
  // Most samples do not change.
  if (with_differences) differences_ = sample_survey<Word>(coding_of_bytes(coding), nullptr, kMiddle<Word>);
}

template <class Word>
void TimeSurvey<Word>::add(const PageShape& shape, const Around& around, const Samples& samples,
                           std::span<const EarlierPage<Word>> before) {
  in_space_->add(shape, around, samples);
  if (!differences_ || before.empty() || is_as_before(shape, samples, before)) return;
  Differences<Word> best;
  best_differences<Word>(shape, around, samples, before, best);
  differences_->add(shape, best.around, best.samples);
}

template <class Word>
void TimeSurvey<Word>::merge(const TimeSurvey& other) {
  in_space_->merge(*other.in_space_);
  if (differences_) differences_->merge(*other.differences_);
}

template <class Word>
TimeCodec<Word>::TimeCodec(SampleCoding coding, std::span<const std::byte> tables,
                           std::span<const std::byte> time_tables, std::string_view name)
    : in_space_(parse_sample_codec<Word>(coding, tables, name)) {
  if (!time_tables.empty())
    differences_ = parse_sample_codec<Word>(coding_of_bytes(coding), time_tables, name);
}

template <class Word>
void TimeCodec<Word>::encode(const PageShape& shape, const Around& around, const Samples& samples,
                             std::span<const EarlierPage<Word>> before, std::vector<std::byte>& out,
                             std::span<const std::byte> along) const {
  const std::size_t begin = out.size();
  in_space_->encode_with(shape, around, samples, out, along);
  // No other coding is shorter than that of a page equal to its prediction.
  if (!differences_ || before.empty() || out.size() == begin + 1) return;
  if (is_as_before(shape, samples, before)) {
    out.resize(begin);
    out.push_back(kAsBefore);
    return;
  }
  Differences<Word> best;
  const int order = best_differences<Word>(shape, around, samples, before, best);
  std::vector<std::byte> in_time;
  differences_->encode_with(shape, best.around, best.samples, in_time, along);
  if (in_time.size() >= out.size() - begin) return;
  in_time[0] |= static_cast<std::byte>(order << 2);
  out.resize(begin);
  out.insert(out.end(), in_time.begin(), in_time.end());
}

template <class Word>
bool TimeCodec<Word>::decode(std::span<const std::byte> bytes, const PageShape& shape, const Around& around,
                             std::span<const EarlierPage<Word>> before, Samples& samples,
                             BytesAlong& along) const {
  const int order = time_order(bytes);
  if (order == 0) return in_space_->decode_with(bytes, shape, around, samples, along);
  if (!differences_ || static_cast<std::size_t>(order) > before.size()) return false;
  if (bytes.size() == 1 && bytes[0] == kAsBefore) {
    for_each_own_place(shape, [&](std::size_t place) { samples[place] = before[0].samples[place]; });
    along.fill(std::byte{0});
    return true;
  }
  std::vector<std::byte> coded(bytes.begin(), bytes.end());
  coded[0] &= std::byte{3};
  const Differences<Word> predicted(order, shape, before, around, nullptr);
  if (!differences_->decode_with(coded, shape, predicted.around, samples, along)) return false;
  for (std::size_t n = 0; n < samples.size(); ++n)
    samples[n] = static_cast<Word>(samples[n] + predicted.samples[n] - kMiddle<Word>);
  return true;
}

template class TimeSurvey<std::uint8_t>;
template class TimeSurvey<std::uint16_t>;
template class TimeSurvey<std::uint32_t>;
template class TimeCodec<std::uint8_t>;
template class TimeCodec<std::uint16_t>;
template class TimeCodec<std::uint32_t>;

}  // namespace adamas::timevarying
