#pragma once

#include <cstdint>
#include <vector>

namespace adamas::bench {

/// Returns a random field at side^3 points of a box, x fastest, scaled so that its values are from 0 to 1.
/// Its energy falls with the wave number k as k^(-5/3) (Kolmogorov 1941), from waves of a quarter of the box
/// to those of two points. Values are the same on any number of threads.
std::vector<float> turbulence(std::uint64_t side);

}  // namespace adamas::bench
