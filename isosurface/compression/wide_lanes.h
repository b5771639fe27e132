#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

/// Before a loop that reads nothing that it writes, which g++ does not see where there are many arrays.
#if defined(__clang__)
#define ADAMAS_INDEPENDENT
#else
#define ADAMAS_INDEPENDENT _Pragma("GCC ivdep")
#endif

namespace adamas {

#if defined(__x86_64__)
template <class Work>
[[gnu::target("avx2,bmi,bmi2,lzcnt"), gnu::flatten]] void with_lanes_of_32_bytes(Work& work) {
  work(std::integral_constant<std::size_t, 32>{});
}
#endif

/// Whether the processor computes with 32 bytes at a time.
inline bool has_wide_lanes() {
#if defined(__x86_64__)
  static const bool kWide = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("bmi2") != 0;
  return kWide;
#else
  return false;
#endif
}

/// Calls work with the number of bytes, as a constant, that the processor computes with at a time. Results do
/// not depend on it.
template <class Work>
void with_wide_lanes(Work work) {
#if defined(__x86_64__)
  if (has_wide_lanes()) return with_lanes_of_32_bytes(work);
#endif
  work(std::integral_constant<std::size_t, 16>{});
}

/// Numbers that are computed with at a time. What takes or gives such numbers is inlined, so that it does not
/// matter how they would be handed over.
template <class T, std::size_t Bytes>
struct WideLanes {
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
  [[gnu::always_inline]] static inline Numbers lesser(Numbers a, Numbers b) { return b < a ? b : a; }
  [[gnu::always_inline]] static inline Numbers greater(Numbers a, Numbers b) { return b > a ? b : a; }
};

/// The same of floats.
template <std::size_t Bytes>
struct FloatLanes : WideLanes<float, Bytes> {
  using Numbers = typename WideLanes<float, Bytes>::Numbers;
  using Integers [[gnu::vector_size(Bytes)]] = std::int32_t;

  [[gnu::always_inline]] static inline Numbers square(Numbers x) { return x * x; }
  [[gnu::always_inline]] static inline Numbers mean_of(Numbers a, Numbers b) { return 0.5f * (a + b); }
};

}  // namespace adamas
