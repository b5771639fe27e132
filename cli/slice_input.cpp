#include "cli/slice_input.h"

#include <algorithm>
#include <array>

#include "cli/given_interfaces.h"
#include "cli/usage_error.h"
#include "core/io/field_assembly.h"
#include "core/io/input_file.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/reconstruction/reconstruction.h"

namespace adamas {

namespace {

/// Sites on either side of a plane that its part of the interfaces depends on, and some more.
constexpr std::size_t kReach = 3;

/// The materials of the few layers of sites round a plane at right angles to an axis: all that the interfaces
/// in it depend on. None for other planes, and for one beside the domain.
std::optional<MultiMaterialData> near_plane(const MultiMaterialData& data, const Plane& plane) {
  const auto axis = plane.axis();
  const Box3 box = data.grid.domain();
  if (!axis || !(plane.origin[*axis] >= box.min[*axis] && plane.origin[*axis] <= box.max[*axis])) return {};
  const std::size_t n = data.grid.sites(*axis);
  std::size_t above = 0;
  while (above < n && data.grid.site_coordinate(*axis, above) < plane.origin[*axis]) ++above;
  const std::size_t first = above > kReach ? above - kReach : 0, last = std::min(above + kReach, n - 1);
  if (last - first + 1 >= n) return {};
  std::array<double, 6> bounds{box.min.x, box.max.x, box.min.y, box.max.y, box.min.z, box.max.z};
  const auto a = static_cast<std::size_t>(2 * *axis);
  bounds[a] = data.grid.site_coordinate(*axis, first);
  bounds[a + 1] = data.grid.site_coordinate(*axis, last);
  MultiMaterialData near;
  near.source = data.source;
  near.grid = data.grid;
  near.materials = data.materials;
  near.fractions = data.fractions;
  near.labels = data.labels;
  crop(bounds, near);
  return near;
}

void load_original(const InputOptions& options, const Plane* plane, Console& console, SliceInput& input) {
  const bool gridded = !options.path.empty() && input_kind(options.path) == InputKind::kGrid;
  if (has_given_interfaces(options)) input.interfaces = read_given_interfaces(options);
  if (!gridded && input.interfaces) return;
  input.data = std::make_unique<MultiMaterialData>(load_data(options, console));
  if (input.interfaces || plane == nullptr) return;
  const auto near = near_plane(*input.data, *plane);
  input.interfaces = Reconstruction(near ? *near : *input.data, console).mesh();
}

}  // namespace

ResampledMesh load_resampled_mesh(const std::string& path, Console& console) {
  check_input_file(path);
  console.step("reading " + path, -1);
  const UnstructuredMesh mesh = read_unstructured_mesh(path);
  if (!is_resampled_mesh(mesh)) {
    fail("{}: expected a mesh written by adamas resample, found another one", path);
  }
  return from_unstructured_mesh(mesh, path);
}

SliceInput load_slice_input(const InputOptions& options, const std::string& original, const Plane* plane,
                            Console& console) {
  SliceInput input;
  input.name = options.path;
  InputOptions from = options;
  check_input_file(options.path);
  if (input_kind(options.path) == InputKind::kMesh) {
    input.mesh = load_resampled_mesh(options.path, console);
    from.path = original;
    if (!original.empty()) check_input_file(original);
    if (original.empty() && options.any_material_option()) {
      wrong_usage("options of volume fractions, labels and fields: expected --original DATA");
    }
    if (original.empty() && options.interfaces.empty()) return input;
  } else if (!original.empty()) {
    wrong_usage("--original: expected a resampled mesh (.vtu) as INPUT, found {}", options.path);
  } else if (input_kind(options.path) != InputKind::kGrid) {
    fail("{}: expected data on a grid or a resampled mesh (.vtu), found interfaces: resample them first",
         options.path);
  }
  load_original(from, plane, console, input);
  return input;
}

}  // namespace adamas
