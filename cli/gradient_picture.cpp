#include "cli/gradient_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/figures.h"
#include "cli/store_options.h"
#include "cli/usage_error.h"
#include "core/base/error.h"
#include "core/data/volume_placement.h"
#include "core/geometry/place_text.h"
#include "core/geometry/plane.h"
#include "core/io/input_file.h"
#include "core/picture/canvas.h"
#include "core/picture/raster.h"

namespace adamas {

namespace {

/// The pixels of a rectangle of the plane.
struct PixelGrid {
  PlaneFrame frame;
  Vec3 corner;  ///< the upper left one
  double step;
  int width, height;

  [[nodiscard]] Vec3 place(int x, int y) const {
    return corner + ((x + 0.5) * step) * frame.right - ((y + 0.5) * step) * frame.up;
  }
};

PixelGrid pixels_round(const std::vector<Vec3>& polygon, const Plane& plane, double width) {
  PixelGrid grid{plane_frame(plane), {}, 0, static_cast<int>(width), 0};
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double left = kInfinity, right = -kInfinity, bottom = kInfinity, top = -kInfinity;
  for (const Vec3& corner : polygon) {
    const Vec3 way = corner - polygon[0];
    left = std::min(left, dot(way, grid.frame.right));
    right = std::max(right, dot(way, grid.frame.right));
    bottom = std::min(bottom, dot(way, grid.frame.up));
    top = std::max(top, dot(way, grid.frame.up));
  }
  grid.corner = polygon[0] + left * grid.frame.right + top * grid.frame.up;
  grid.step = (right - left) / grid.width;
  constexpr double kMostRows = 16000;
  grid.height = static_cast<int>(std::clamp(std::round((top - bottom) / grid.step), 1.0, kMostRows));
  return grid;
}

/// The sample that is nearest to a place; none beyond the data.
std::optional<LatticePoint> nearest_sample(const VolumeGrid& grid, const Vec3& place) {
  const Vec3 offset = grid.in_frame(place) - grid.origin;
  LatticePoint p{};
  for (int axis = 0; axis < 3; ++axis) {
    const double at = offset[axis] / grid.spacing[axis];
    const auto last = static_cast<double>(grid.dimensions[static_cast<std::size_t>(axis)] - 1);
    if (!(at >= -1e-6 && at <= last + 1e-6)) return std::nullopt;
    p[axis] = static_cast<std::int32_t>(std::clamp(std::round(at), 0.0, last));
  }
  return p;
}

}  // namespace

void draw_gradients(const GradientPicture& picture, Session& session) {
  if (!is_store(picture.store))
    wrong_usage("--gradients: expected a store from adamas store --gradients, found {}", picture.store);
  if (file_extension(picture.output) != ".png")
    wrong_usage("--gradients: expected a .png as output, found {}", picture.output);
  StoreInput input;
  input.path = picture.store;
  input.step = picture.step;
  const std::unique_ptr<StoreFile> file = open_store(input, session);
  const VolumeGrid& grid = file->header().grid;
  StoredGradients gradients(*file, wanted_step(input, *file, session), store_memory(input));
  const std::vector<Vec3> polygon = plane_in_samples(grid, picture.plane);
  if (polygon.size() < 3)
    fail("{}: expected a plane that cuts {}, found {}", picture.store, box_text(grid.box()),
         to_string(picture.plane));
  const PixelGrid pixels = pixels_round(polygon, picture.plane, picture.width);
  Raster raster(pixels.width, pixels.height);
  std::uint64_t without = 0;
  for (int y = 0; y < pixels.height; ++y) {
    session.console.step("drawing", static_cast<double>(y) / pixels.height);
    for (int x = 0; x < pixels.width; ++x) {
      raster.set(x, y, {1, 1, 1});
      const auto sample = nearest_sample(grid, pixels.place(x, y));
      if (!sample) continue;
      const Vec3 g = gradients.direction(*sample).value_or(Vec3{});
      without += norm(g) == 0 ? 1 : 0;
      raster.set(x, y, {0.5 * (g.x + 1), 0.5 * (g.y + 1), 0.5 * (g.z + 1)});
    }
  }
  const double part = static_cast<double>(without) / (static_cast<double>(pixels.width) * pixels.height);
  session.console.table({{"pixels without a gradient", fmt::format("{:.2f}%", 100 * part)}});
  session.outputs.write(picture.output, [&](const auto& path) { write_png(path, raster); });
  const Figures figures{{"plane", to_string(picture.plane)}, {"part_without_gradient", part}};
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
  session.outputs.commit();
}

}  // namespace adamas
