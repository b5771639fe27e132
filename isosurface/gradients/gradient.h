#pragma once

#include <array>

namespace adamas {

/// Of the samples of a volume, in values per unit of length, as many of them are kept.
using Gradient = std::array<float, 3>;

}  // namespace adamas
