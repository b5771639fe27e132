#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "isosurface/view/viewpoint.h"

namespace adamas::viewer {

/// A picture of a flight.
struct FlightFrame {
  isosurface::Viewpoint viewpoint;
  std::optional<std::uint32_t> step;  ///< the step that it shows; empty: the step of the state
};

/// One frame for each step from `first` to `last`, while the camera moves along the path, which has at least
/// one viewpoint.
std::vector<FlightFrame> frames_of_steps(const std::vector<isosurface::Viewpoint>& path, std::uint32_t first,
                                         std::uint32_t last);

}  // namespace adamas::viewer
