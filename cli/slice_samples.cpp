#include "cli/slice_samples.h"

#include <utility>

#include "cli/sample_slab.h"
#include "cli/usage_error.h"
#include "core/io/array_names.h"
#include "core/io/input_file.h"

namespace adamas {

SampleOrigin sample_origin(const InputOptions& input, const VolumeInput& volume,
                           const std::string& original) {
  const std::string of_volume = volume.option();
  std::string option = input.grid_option();
  if (option.empty() || option == "--field") {
    option = input.interfaces.empty() ? input.interface_option() : "--interface";
  }
  const bool about_grid = !option.empty();
  if (is_store(input.path)) {
    if (!original.empty())
      wrong_usage("--original: expected a resampled mesh (.vtu) as INPUT, found {}", input.path);
    if (about_grid) wrong_usage("{}: expected data with materials as INPUT, found {}", option, input.path);
    if (!of_volume.empty()) wrong_usage("{}: expected a volume as INPUT, found {}", of_volume, input.path);
    return SampleOrigin::kStore;
  }
  if (!of_volume.empty()) {
    if (!original.empty()) wrong_usage("{} and --original: expected one of them", of_volume);
    if (about_grid) wrong_usage("{} and {}: expected one of them", of_volume, option);
    if (input.path.empty()) wrong_usage("{}: expected a volume as INPUT, found none", of_volume);
    return SampleOrigin::kVolume;
  }
  if (about_grid || !original.empty() || input_kind(input.path) != InputKind::kGrid ||
      fraction_material(file_stem(input.path))) {
    return SampleOrigin::kNone;
  }
  const bool samples = has_one_array(input.path) || is_aslant_image(input.path);
  return samples ? SampleOrigin::kVolume : SampleOrigin::kNone;
}

SliceInput load_samples(const InputOptions& input, VolumeInput volume, SampleOrigin origin,
                        std::string& field, const Plane& plane,
                        const std::function<void(const SliceInput&)>& check, Session& session) {
  SliceInput result;
  result.name = input.path;
  StoreInput store;
  store.path = volume.path = input.path;
  if (origin == SampleOrigin::kVolume && volume.array.empty() && is_aslant_image(input.path)) {
    volume.array = std::exchange(field, {});
  }
  SampleSlab slab = origin == SampleOrigin::kStore
                        ? store_slab(store, plane, session)
                        : volume_slab(open_volume_input(volume, session), plane, session);
  result.data = std::make_unique<MultiMaterialData>(std::move(slab.data));
  if (!slab.grid.is_straight()) result.turned = std::move(slab.grid);
  check(result);
  return result;
}

}  // namespace adamas
