#pragma once

#include <string>

#include "adamas/geometry.h"
#include "cli/command.h"
#include "core/picture/slice_picture.h"

namespace adamas::cli {

/// A picture of the gradients of a store in a plane.
struct GradientPicture {
  std::string store;
  Plane plane;
  std::string output;
  picture::SliceOptions size;
  std::string step{};  ///< of a series: the number of a step
};

/// Draws the directions of gradients, each of the sample that is nearest to a pixel: red, green and blue for
/// -1 to 1 along the axes of the grid (the dissertation's figure 4.4), so that grey stands for none; white
/// beyond the data; a legend tells it. Writes it and ends the run. Throws Error (kUsage) for another output,
/// and Error for a store without gradients and a plane that does not cut it.
void draw_gradients(const GradientPicture& picture, Session& session);

}  // namespace adamas::cli
