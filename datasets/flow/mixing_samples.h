#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "adamas/volume.h"
#include "datasets/flow/mixing.h"
#include "datasets/sample_scale.h"

namespace adamas::datasets {

/// A field of a mixing flow as samples at the cells' centres.
struct MixingField {
  const char* name = nullptr;  ///< "entropy" or "density"
  const char* unit = nullptr;
  SampleScale scale;  ///< the scale for all times of a flow
  std::vector<std::byte> samples{};
  std::uint64_t cut_off = 0;  ///< number of samples, over all times, whose values were outside the scale
  /// The range of values over all times.
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
};

/// The fields of a flow at successive times, with one scale for all of them.
class MixingSamples {
 public:
  /// `mach` is the Mach number of the flow.
  MixingSamples(const std::array<std::size_t, 3>& cells, double mach, SampleType type);

  [[nodiscard]] const VolumeGrid& grid() const { return grid_; }
  /// Entropy and density at the last update.
  [[nodiscard]] const std::array<MixingField, 2>& fields() const { return fields_; }
  /// Samples the present state of the flow, on any number of threads.
  void update(const FlowSolver<2>& flow);

 private:
  VolumeGrid grid_;
  std::array<MixingField, 2> fields_;
};

}  // namespace adamas::datasets
