#pragma once

#include <cstdint>

namespace adamas::inline core {

// Hashes of 64 bits, and random numbers made of them. Where entries of a table go, and with them the order of
// some outputs, follows from these values: none of the formulas may change.

/// 2^64 divided by the golden ratio, as an odd number.
inline constexpr std::uint64_t kGoldenRatio64 = 0x9e3779b97f4a7c15;

/// Multiplicative hashing by the golden ratio (Knuth, The Art of Computer Programming 3, 6.4), which spreads
/// successive numbers evenly. The high bits are the good ones.
constexpr std::uint64_t fibonacci_hash(std::uint64_t x) { return x * kGoldenRatio64; }

/// The first `bits` bits of fibonacci_hash: one of 2^bits slots.
constexpr std::uint64_t fibonacci_slot(std::uint64_t x, int bits) { return fibonacci_hash(x) >> (64 - bits); }

/// Extends the hash of a sequence of values, which is 0 for an empty one, by one value. Its high bits are the
/// good ones.
constexpr std::uint64_t hash_combine(std::uint64_t hash, std::uint64_t value) {
  return fibonacci_hash(hash ^ value);
}

/// Brings the good high bits of a product to the low ones and spreads them by another multiplication: one
/// round of the mixer known as degski64.
constexpr std::uint64_t remix(std::uint64_t h) { return (h ^ (h >> 32)) * 0xd6e8feb86659fd93; }

/// An invertible function after which all bits are as good as random (Stafford's mixer 13, which ends a step
/// of SplitMix64).
constexpr std::uint64_t mix64(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

/// The next random number of SplitMix64 (Steele, Lea and Flood, Fast splittable pseudorandom number
/// generators, 2014): a counter, mixed. Any seed serves as the first state.
constexpr std::uint64_t next_splitmix64(std::uint64_t& state) { return mix64(state += kGoldenRatio64); }

/// An edge of a mesh by its two vertices, the lower one first, as one number.
constexpr std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
}

}  // namespace adamas::inline core
