#include "viewer/session/flight_frames.h"

#include <cstddef>

#include "viewer/session/camera_control.h"

namespace adamas::viewer {

using namespace isosurface;

std::vector<FlightFrame> frames_of_steps(const std::vector<Viewpoint>& path, std::uint32_t first,
                                         std::uint32_t last) {
  const std::size_t count = last - first + 1;
  std::vector<FlightFrame> frames;
  for (std::size_t n = 0; n < count; ++n)
    frames.push_back({along(path, n, count), first + static_cast<std::uint32_t>(n)});
  return frames;
}

}  // namespace adamas::viewer
