#include "cli/slice_input.h"

#include "cli/given_interfaces.h"
#include "cli/usage_error.h"
#include "core/io/input_file.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/reconstruction/reconstruction.h"

namespace adamas {

namespace {

void load_original(const InputOptions& options, bool with_interfaces, Console& console, SliceInput& input) {
  const bool gridded = !options.path.empty() && input_kind(options.path) == InputKind::kGrid;
  if (has_given_interfaces(options)) input.interfaces = read_given_interfaces(options);
  if (!gridded && input.interfaces) return;
  input.data = std::make_unique<MultiMaterialData>(load_data(options, console));
  if (input.interfaces || !with_interfaces) return;
  input.interfaces = Reconstruction(*input.data, console).mesh();
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

SliceInput load_slice_input(const InputOptions& options, const std::string& original, bool with_interfaces,
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
  load_original(from, with_interfaces, console, input);
  return input;
}

}  // namespace adamas
