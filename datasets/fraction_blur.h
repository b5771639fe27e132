#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adamas/generate.h"  // FractionBlur

namespace adamas::datasets {

inline constexpr double kGreatestNoise = 1;

/// Throws Error if an option is not a number or out of range.
void check(const FractionBlur& blur);

/// Convolves the values of cells, x fastest, with a Gaussian whose standard deviation is `blur` cells, along
/// one axis after the other. Its weights are exp(-k^2 / (2 blur^2)) up to 4 blur + 1 cells away, scaled to
/// add up to 1; beyond its ends a row of cells continues with its last value. The result is the same on any
/// number of threads.
void blur_cells(std::span<float> values, const std::array<std::size_t, 3>& cells, double blur);

/// Adds normally distributed noise of standard deviation `noise` to those fractions of a cell that are mixed,
/// clips them to [0, 1] and scales all to add up to 1. They stay as they are if nothing is left to scale. The
/// noise follows from the seed and the cell's number.
void add_noise(std::vector<double>& fractions, double noise, std::uint64_t seed, std::size_t cell);

}  // namespace adamas::datasets
