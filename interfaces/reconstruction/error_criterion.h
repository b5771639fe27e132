#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/median.h"

namespace adamas::interfaces {

/// What tells errors of fractions, on grids and on meshes of any cells (docs/blurred_fractions.md, Errors of
/// fractions): mixed cells are left out one by one and predicted by quadrics through their neighbours'
/// distances.
struct ErrorCriterion {
  /// Neighbours count up to this squared distance, in cells; at least so many make a quadric.
  static constexpr int kSquaredReach = 5;
  static constexpr std::size_t kLeastNeighbours = 14;
  /// The least sum of the neighbours' weights; with less they are too far from the interface.
  static constexpr double kLeastWeight = 0.05;
  /// Errors are estimated from fractions between kLeastClear and 1 - kLeastClear, of about kMostCells cells
  /// at most.
  static constexpr double kLeastClear = 0.02;
  static constexpr std::size_t kMostCells = 20000;

  /// The step between the mixed cells of which errors are estimated.
  static std::size_t stride(std::size_t mixed) { return mixed / kMostCells + 1; }

  /// How far the fraction of a material is from that predicted for its cell.
  struct Sample {
    double off = -1;    ///< below 0 where nothing is predicted
    double curved = 0;  ///< the mean curvature, signed, in cells
    std::uint16_t material = 0;
    bool is_sharp = false;
  };
  /// Returns the standard deviation of errors of fractions; none where too few cells can be predicted.
  /// `wanted`: the number of cells that would be looked at if all could be predicted; `materials`: that of
  /// materials; `width`: the median width of steps in cells.
  static std::optional<double> deviation(std::vector<Sample> samples, std::size_t wanted,
                                         std::size_t materials, double width) {
    constexpr std::size_t kLeastCells = 100;
    constexpr double kLeastPart = 0.1;
    std::erase_if(samples, [](const Sample& sample) { return sample.off < 0; });
    const double least = kLeastPart * static_cast<double>(wanted);
    if (samples.size() < kLeastCells || static_cast<double>(samples.size()) < least) return {};
    // Distances from planes in cells are less exact for a curved interface, by the material's median
    // curvature: sharp ones differ by this times its square even without errors.
    constexpr double kOfCurved = 0.5;
    std::vector<std::vector<double>> curved(materials);
    for (const Sample& sample : samples) curved[sample.material].push_back(sample.curved);
    std::vector<double> means(curved.size(), 0), off;
    for (std::size_t m = 0; m < means.size(); ++m) {
      if (!curved[m].empty()) means[m] = median(curved[m]);
    }
    for (const Sample& sample : samples) {
      const double mean = means[sample.material];
      off.push_back(sample.is_sharp ? std::max(0.0, sample.off - kOfCurved * mean * mean) : sample.off);
    }
    const double found = kDeviationByMedian * median(off), own = error_of_method(width);
    return found > own ? std::sqrt(found * found - own * own) : 0;
  }

  /// Returns the part of an entry's difference from its prediction that is kept. `squares`: the mean of the
  /// squared differences in the cell and its neighbours; `own`: the weight of the entry's own distance in a
  /// quadric through it and its neighbours.
  static double part_kept(double squares, double noise, double own) {
    constexpr double kBeyond = 2;
    const double kept = std::max(0.0, 1 - kBeyond * noise * noise / std::max(squares, 1e-12));
    return kept + (1 - kept) * own;
  }

 private:
  /// Returns the noise that the method finds for fractions without errors: the surface through the
  /// neighbours' distances is less exact the narrower the step is, up to the error for a sphere of 16 cells.
  /// `width`: the width of the steps, in cells.
  static double error_of_method(double width) {
    constexpr double kSharp = 0.014, kFrom = 0.58, kFalls = 4.2;
    return kSharp * std::exp(-kFalls * std::max(0.0, width - kFrom));
  }
};

}  // namespace adamas::interfaces
