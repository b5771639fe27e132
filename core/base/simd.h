#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

/// Put before a loop, this tells the compiler that its iterations are independent of each other, which g++
/// does not see in loops over many arrays.
#if defined(__clang__)
#define ADAMAS_INDEPENDENT
#else
#define ADAMAS_INDEPENDENT _Pragma("GCC ivdep")
#endif

namespace adamas::inline core {

/// Computing with several numbers at a time, by the vector extension that g++ and clang share: where the
/// processor has no vectors of a length, the compiler makes the same of shorter ones or of single numbers.
/// Each number comes out as if it were computed with alone, so that no result depends on the length.
///
/// Highway (1.0.3) was tried in its place. It made a kernel of floats as fast and one of bytes 1.3 times as
/// fast, which is less than 2% of decoding a page, and such files took from 4 to 15 times as long to compile.

/// While this is set, which tests do, vectors have 16 bytes on every processor.
inline std::atomic<bool> only_short_vectors{false};

/// Whether the processor computes with 32 bytes at a time.
inline bool has_wide_lanes() {
#if defined(__x86_64__)
  static const bool kWide = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("bmi2") != 0;
  return kWide && !only_short_vectors.load(std::memory_order_relaxed);
#else
  return false;
#endif
}

#if defined(__x86_64__)
template <class Work>
[[gnu::target("avx2,bmi,bmi2,lzcnt"), gnu::flatten]] void with_lanes_of_32_bytes(Work& work) {
  work(std::integral_constant<std::size_t, 32>{});
}
#endif

/// Calls work with the number of bytes, as a constant, that the processor computes with at a time. All that
/// `work` calls has to be inlined, so that it is compiled for this processor.
template <class Work>
void with_wide_lanes(Work work) {
#if defined(__x86_64__)
  if (has_wide_lanes()) return with_lanes_of_32_bytes(work);
#endif
  work(std::integral_constant<std::size_t, 16>{});
}

/// Vectors of `Bytes` bytes with numbers of type T. Operators are those of the language, number by number; a
/// comparison gives -1 or 0 in integers of the same size. A template parameter that is a vector type loses
/// its length, so the type is a member of this struct. The functions are inlined, so that it does not matter
/// how vectors would be passed.
template <class T, std::size_t Bytes>
struct Simd {
  static constexpr std::size_t kCount = Bytes / sizeof(T);
  using Numbers [[gnu::vector_size(Bytes)]] = T;

  [[gnu::always_inline]] static inline Numbers load(const T* from) {
    Numbers numbers;
    std::memcpy(&numbers, from, sizeof numbers);
    return numbers;
  }
  [[gnu::always_inline]] static inline void store(Numbers numbers, T* to) {
    std::memcpy(to, &numbers, sizeof numbers);
  }
  /// The lesser of both, number by number; a where one of the two is NaN.
  [[gnu::always_inline]] static inline Numbers lesser(Numbers a, Numbers b) { return b < a ? b : a; }
  /// The greater of both, number by number; a where one of the two is NaN.
  [[gnu::always_inline]] static inline Numbers greater(Numbers a, Numbers b) { return b > a ? b : a; }
};

/// Stores the least byte of each number by one shuffle; compilers would extract them one by one.
template <std::size_t Bytes>
[[gnu::always_inline]] inline void store_least_bytes(typename Simd<std::int32_t, Bytes>::Numbers numbers,
                                                     std::uint8_t* to) {
  constexpr int kLeast = std::endian::native == std::endian::little ? 0 : 3;
  typename Simd<std::uint8_t, Bytes>::Numbers all;
  std::memcpy(&all, &numbers, sizeof all);
  [&]<std::size_t... N>(std::index_sequence<N...>) __attribute__((always_inline)) {
    const auto least = __builtin_shufflevector(all, all, (static_cast<int>(4 * N) + kLeast)...);
    std::memcpy(to, &least, sizeof least);
  }
  (std::make_index_sequence<Bytes / 4>());
}

/// Compares four floats: bit n of the result tells whether a[n] <= b[n].
[[gnu::always_inline]] inline unsigned bits_not_greater(Simd<float, 16>::Numbers a,
                                                        Simd<float, 16>::Numbers b) {
#if defined(__SSE2__)
  return static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(a, b)));
#else
  unsigned bits = 0;
  for (unsigned n = 0; n < 4; ++n) bits |= (a[n] <= b[n] ? 1u : 0u) << n;
  return bits;
#endif
}

/// Eight numbers of a row, in vectors of 16 bytes at most: compilers unroll loops of so few steps before they
/// make vectors of them.
template <class T>
struct EightLanes {
  static constexpr std::size_t kPartBytes = 8 * sizeof(T) < 16 ? 8 * sizeof(T) : 16;
  static constexpr std::size_t kStep = kPartBytes / sizeof(T), kParts = 8 / kStep;
  using Vector = Simd<T, kPartBytes>;
  using Part = typename Vector::Numbers;
  Part parts[kParts];

  static EightLanes load(const T* from) {
    EightLanes lanes;
    std::memcpy(lanes.parts, from, sizeof lanes.parts);
    return lanes;
  }
  void store(T* to) const { std::memcpy(to, parts, sizeof parts); }

  static EightLanes least(const EightLanes& a, const EightLanes& b) {
    EightLanes lanes;
    for (std::size_t n = 0; n < kParts; ++n) lanes.parts[n] = Vector::lesser(a.parts[n], b.parts[n]);
    return lanes;
  }
  static EightLanes greatest(const EightLanes& a, const EightLanes& b) {
    EightLanes lanes;
    for (std::size_t n = 0; n < kParts; ++n) lanes.parts[n] = Vector::greater(a.parts[n], b.parts[n]);
    return lanes;
  }
  [[nodiscard]] EightLanes inverted() const {
    EightLanes lanes;
    for (std::size_t n = 0; n < kParts; ++n) lanes.parts[n] = ~parts[n];
    return lanes;
  }
  /// Merges two vectors: lanes of even number come from the first, lanes of odd number from the second.
  static EightLanes by_turns(const EightLanes& even, const EightLanes& odd) {
    constexpr auto kEven = [] {
      std::array<T, 8> mask{};
      for (std::size_t n = 0; n < mask.size(); n += 2) mask[n] = static_cast<T>(~T{0});
      return mask;
    }();
    const EightLanes taken = load(kEven.data());
    EightLanes lanes;
    for (std::size_t n = 0; n < kParts; ++n)
      lanes.parts[n] = (even.parts[n] & taken.parts[n]) | (odd.parts[n] & ~taken.parts[n]);
    return lanes;
  }
  /// Reads 16 numbers and distributes them alternately to two vectors.
  static void load_by_turns(const T* from, EightLanes& even, EightLanes& odd) {
    EightLanes &low = kLittle ? even : odd, &high = kLittle ? odd : even;
    for (std::size_t n = 0; n < kParts; ++n) {
      Pairs pairs;
      std::memcpy(&pairs, from + 2 * kStep * n, sizeof pairs);
      low.parts[n] = __builtin_convertvector(pairs & static_cast<Wider>(static_cast<T>(~T{0})), Part);
      high.parts[n] = __builtin_convertvector(pairs >> 8 * sizeof(T), Part);
    }
  }
  /// Writes 16 numbers, taken alternately from the two vectors.
  static void store_by_turns(const EightLanes& even, const EightLanes& odd, T* to) {
    const EightLanes &low = kLittle ? even : odd, &high = kLittle ? odd : even;
    for (std::size_t n = 0; n < kParts; ++n) {
      const Pairs pairs = __builtin_convertvector(low.parts[n], Pairs) |
                          __builtin_convertvector(high.parts[n], Pairs) << 8 * sizeof(T);
      std::memcpy(to + 2 * kStep * n, &pairs, sizeof pairs);
    }
  }

 private:
  /// The next wider unsigned integer, which two neighbours of a row are read as.
  using Wider = std::conditional_t<sizeof(T) == 1, std::uint16_t,
                                   std::conditional_t<sizeof(T) == 2, std::uint32_t, std::uint64_t>>;
  using Pairs [[gnu::vector_size(2 * kPartBytes)]] = Wider;
  static constexpr bool kLittle = std::endian::native == std::endian::little;
};

}  // namespace adamas::inline core
