#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "isosurface/view/viewpoint.h"

namespace adamas::viewer {

/// A picture of a flight.
struct FlightFrame {
  isosurface::Viewpoint viewpoint;
  std::optional<std::uint32_t> step;  ///< the step that it shows; none: the step of the state
};

/// A frame of each step from `first` to `last`, while the camera goes along the path, which has one viewpoint
/// or more.
std::vector<FlightFrame> frames_of_steps(const std::vector<isosurface::Viewpoint>& path, std::uint32_t first,
                                         std::uint32_t last);

}  // namespace adamas::viewer
