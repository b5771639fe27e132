#include "workflow/slices/gradient_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/data/volume_placement.h"
#include "core/geometry/plane.h"
#include "core/io/input_file.h"
#include "core/picture/slice_picture.h"
#include "isosurface/storage/stored_pages.h"
#include "timevarying/api/open_store.h"
#include "workflow/slices/cut_input.h"
#include "workflow/slices/slice_scale.h"

namespace adamas::workflow {

using namespace io;
using namespace isosurface;
using namespace picture;

namespace {

/// Returns the sample that is nearest to a place; none beyond the data.
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

Colour colour_of(const Vec3& direction) {
  return {0.5 * (direction.x + 1), 0.5 * (direction.y + 1), 0.5 * (direction.z + 1)};
}

/// Returns the legend: the directions along the axes, which are called i, j and k for a grid that is not
/// along x, y and z.
std::vector<LegendEntry> colour_legend(const VolumeGrid& grid) {
  const std::string names = grid.is_straight() ? "xyz" : "ijk";
  std::vector<LegendEntry> entries;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Vec3 direction;
      direction[static_cast<int>(axis)] = sign;
      entries.push_back({fmt::format("{}{}", sign > 0 ? '+' : '-', names[axis]), colour_of(direction)});
    }
  }
  entries.push_back({"no gradient", colour_of({})});
  return entries;
}

/// The colours of the nearest samples' gradients at places of the plane, and the number of samples without
/// gradient.
class GradientColours {
 public:
  GradientColours(StoreFile& file, std::uint32_t step, std::size_t memory, const PlaneFrame& frame,
                  const Vec3& in_plane, Progress& progress)
      : gradients_(file, step, memory),
        grid_(file.header().grid),
        frame_(frame),
        in_plane_(in_plane),
        progress_(progress) {
    const auto [x, y] = frame.coordinates(in_plane);
    at_ = {x, y};
  }

  std::optional<Colour> at(const Vec2& place) {
    progress_.step("drawing", -1);
    const Vec2 way = place - at_;
    const auto sample = nearest_sample(grid_, in_plane_ + way.x * frame_.right + way.y * frame_.up);
    if (!sample) return {};
    const Vec3 direction = gradients_.direction(*sample).value_or(Vec3{});
    ++drawn_;
    without_ += norm(direction) == 0 ? 1 : 0;
    return colour_of(direction);
  }
  [[nodiscard]] double part_without() const {
    return drawn_ > 0 ? static_cast<double>(without_) / static_cast<double>(drawn_) : 0;
  }

 private:
  StoredGradients gradients_;
  const VolumeGrid& grid_;
  PlaneFrame frame_;
  Vec3 in_plane_;  ///< a point of the plane
  Vec2 at_;        ///< its coordinates
  Progress& progress_;
  std::uint64_t drawn_ = 0, without_ = 0;
};

}  // namespace

double draw_gradients(const SliceRequest& request, const std::string& output, OutputSet& outputs,
                      Progress& progress) {
  const std::string store = request.input.path.string();
  const Plane& plane = request.plane;
  if (!is_store(store))
    wrong_usage("--gradients: expected a store from adamas store --gradients, found {}", store);
  if (file_extension(output) == ".vtp")
    wrong_usage("--gradients: expected a picture as output, found {}", output);
  outputs.protect(store);
  const OpenOptions options;
  const std::unique_ptr<StoreFile> file = timevarying::open_store_file(store, options);
  const VolumeGrid& grid = file->header().grid;
  const std::uint32_t step = timevarying::wanted_step(request.step, *file, progress);
  const std::vector<Vec3> polygon = plane_in_samples(grid, plane);
  if (polygon.size() < 3)
    fail("{}: expected a plane that cuts {}, found {}", store, box_text(grid.box()), to_string(plane));
  const PlaneFrame frame = plane_frame(plane);
  GradientColours colours(*file, step, options.memory, frame, polygon[0], progress);
  SlicePicture drawn;
  drawn.title = std::filesystem::path(store).filename().string() + ", " + to_string(plane);
  drawn.x_label = frame.right_name;
  drawn.y_label = frame.up_name;
  drawn.window.emplace();
  for (const Vec3& corner : polygon) {
    const auto [x, y] = frame.coordinates(corner);
    drawn.window->extend({x, y});
  }
  drawn.materials = colour_legend(grid);
  drawn.panels.resize(1);
  drawn.panels[0].title = "directions of gradients";
  drawn.panels[0].colour_at = [&colours](const Vec2& place) { return colours.at(place); };
  if (file->steps() > 1) add_step_title(file->times()[step], step, drawn);
  outputs.write(output, [&](const auto& path) { picture::write_slice(drawn, path, picture_size(request)); });
  return colours.part_without();
}

}  // namespace adamas::workflow
