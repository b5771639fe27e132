#include "isosurface/storage/number_remainders.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "core/base/assert.h"
#include "isosurface/compression/entropy/bit_stream.h"

namespace adamas::isosurface {

namespace {

/// The number of remainders that are coded with as many bits each.
constexpr std::size_t kRun = 1024;
/// The bits of a remainder that are written at once.
constexpr int kHalf = 32;

template <class Stored>
using WordOf = std::conditional_t<sizeof(Stored) == 8, std::uint64_t,
                                  std::conditional_t<sizeof(Stored) == 4, std::uint32_t, std::uint16_t>>;

template <class T>
T at(std::span<const std::byte> bytes, std::size_t n) {
  T value;
  std::memcpy(&value, bytes.data() + n * sizeof(T), sizeof(T));
  return value;
}

template <class T>
void put(std::span<std::byte> bytes, std::size_t n, T value) {
  std::memcpy(bytes.data() + n * sizeof(T), &value, sizeof(T));
}

template <class Stored, class Sample>
Stored nearest(Sample sample) {
  if constexpr (std::is_floating_point_v<Stored> || !std::is_floating_point_v<Sample>) {
    return static_cast<Stored>(sample);
  } else {
    // The least and the greatest number of a type with 64 bits are beyond those that a float has.
    constexpr auto kLimits = std::numeric_limits<Stored>();
    const double end = std::ldexp(1.0, kLimits.digits);
    const double value = std::nearbyint(static_cast<double>(sample));
    if (std::isnan(value)) return 0;
    if (value >= end) return kLimits.max();
    if (value <= static_cast<double>(kLimits.lowest())) return kLimits.lowest();
    return static_cast<Stored>(value);
  }
}

/// Returns a number as an unsigned integer, in the order of the values.
template <class Stored>
WordOf<Stored> word_of(Stored number) {
  using Word = WordOf<Stored>;
  constexpr Word kSign = Word{1} << (8 * sizeof(Word) - 1);
  const auto word = std::bit_cast<Word>(number);
  if constexpr (std::is_floating_point_v<Stored>) return (word & kSign) != 0 ? ~word : word | kSign;
  return word;
}

template <class Stored>
Stored number_of(WordOf<Stored> word) {
  using Word = WordOf<Stored>;
  constexpr Word kSign = Word{1} << (8 * sizeof(Word) - 1);
  if constexpr (std::is_floating_point_v<Stored>)
    word = (word & kSign) != 0 ? static_cast<Word>(word ^ kSign) : static_cast<Word>(~word);
  return std::bit_cast<Stored>(word);
}

/// Folds differences, modulo 2^bits, so that small ones of either sign are small.
template <class Word>
Word folded(Word difference) {
  constexpr int kTop = 8 * sizeof(Word) - 1;
  return static_cast<Word>(difference << 1) ^ static_cast<Word>(-(difference >> kTop));
}
template <class Word>
Word unfolded(Word word) {
  return static_cast<Word>(word >> 1) ^ static_cast<Word>(-(word & 1));
}

/// Calls `visit` with a zero of a type with remainders.
template <class Visit>
void visit_wide_type(StoredType type, Visit&& visit) {
  visit_stored_type(type, [&visit](auto zero) {
    if constexpr (sizeof(zero) >= 4 && !std::is_same_v<decltype(zero), float>) {
      visit(zero);
    } else {
      ADAMAS_ASSERT(false);
    }
  });
}

}  // namespace

void nearest_numbers(StoredType type, std::span<const std::byte> samples, std::span<std::byte> numbers) {
  visit_stored_type(type, [&]<class Stored>(Stored) {
    visit_stored_type(stored_type(sample_type_for(type)), [&]<class Sample>(Sample) {
      for (std::size_t n = 0; n < numbers.size() / sizeof(Stored); ++n)
        put(numbers, n, nearest<Stored>(at<Sample>(samples, n)));
    });
  });
}

std::vector<std::byte> encode_remainders(StoredType type, std::span<const std::byte> numbers,
                                         std::span<const float> samples) {
  std::vector<std::byte> bytes;
  bool any = false;
  visit_wide_type(type, [&]<class Stored>(Stored) {
    using Word = WordOf<Stored>;
    std::vector<Word> run;
    for (std::size_t begin = 0; begin < samples.size(); begin += kRun) {
      run.clear();
      int width = 0;
      for (std::size_t n = begin; n < std::min(samples.size(), begin + kRun); ++n) {
        const Word word = word_of(at<Stored>(numbers, n)), base = word_of(nearest<Stored>(samples[n]));
        run.push_back(folded(static_cast<Word>(word - base)));
        width = std::max(width, static_cast<int>(std::bit_width(run.back())));
      }
      any = any || width > 0;
      bytes.push_back(static_cast<std::byte>(width));
      BitWriter out(bytes);
      for (const std::uint64_t word : run) {
        const int low = std::min(width, kHalf);
        out.put(word & ((std::uint64_t{1} << low) - 1), low);
        if (width > kHalf) out.put(word >> kHalf, width - kHalf);
      }
      out.finish();
    }
  });
  if (!any) bytes.clear();
  return bytes;
}

bool decode_remainders(StoredType type, std::span<const std::byte> record, std::size_t count,
                       std::vector<std::byte>& remainders) {
  remainders.assign(count * stored_bytes(type), std::byte{});
  if (record.empty()) return true;
  bool good = true;
  visit_wide_type(type, [&]<class Stored>(Stored) {
    using Word = WordOf<Stored>;
    for (std::size_t begin = 0; begin < count && good; begin += kRun) {
      const std::size_t end = std::min(count, begin + kRun);
      const int width = record.empty() ? 255 : std::to_integer<int>(record[0]);
      const std::size_t bytes = (static_cast<std::size_t>(width) * (end - begin) + 7) / 8;
      good = width <= static_cast<int>(8 * sizeof(Word)) && bytes < record.size();
      if (!good) return;
      BitReader in(record.subspan(1, bytes));
      record = record.subspan(1 + bytes);
      for (std::size_t n = begin; n < end; ++n) {
        in.refill();
        std::uint64_t word = in.take(std::min(width, kHalf));
        if (width > kHalf) {
          in.refill();
          word |= in.take(width - kHalf) << kHalf;
        }
        put(std::span(remainders), n, unfolded(static_cast<Word>(word)));
      }
    }
  });
  return good && record.empty();
}

void add_remainders(StoredType type, std::span<const float> samples, std::span<const std::byte> remainders,
                    std::span<std::byte> numbers) {
  visit_wide_type(type, [&]<class Stored>(Stored) {
    using Word = WordOf<Stored>;
    for (std::size_t n = 0; n < samples.size(); ++n)
      put(numbers, n,
          number_of<Stored>(
              static_cast<Word>(word_of(nearest<Stored>(samples[n])) + at<Word>(remainders, n))));
  });
}

}  // namespace adamas::isosurface
