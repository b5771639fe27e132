#include "adamas/slice_volume.h"

#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/base/naming.h"
#include "timevarying/api/open_store.h"
#include "workflow/slices/cut_input.h"
#include "workflow/slices/slice_samples.h"

namespace adamas {

using namespace workflow;

namespace {

Slice section_of(SliceInput input, const Plane& plane) {
  CutInput result;
  result.input = std::move(input);
  result.style.plane = plane;
  result.style.field = kSampleField;
  result.modes = {SliceMode::kInput};
  result.sections.push_back(cut(result.input, SliceMode::kInput, result.style));
  return last_section(result);
}

}  // namespace

Slice slice(const Volume& volume, const Plane& plane, Progress& progress) {
  constexpr const char* kName = "volume";
  const LoopProgress loops(progress);
  volume.grid.check(kName);
  if (volume.samples.size() != volume.grid.bytes())
    fail("{}: expected {} bytes of samples, found {}", kName, volume.grid.bytes(), volume.samples.size());
  return section_of(volume_samples(kName, volume, plane, progress), plane);
}

Slice slice(VolumeStore& store, const Plane& plane, const std::optional<std::uint64_t>& step,
            Progress& progress) {
  const LoopProgress loops(progress);
  isosurface::StoreFile& file = timevarying::StoreAccess::file(store);
  const std::uint32_t number = timevarying::wanted_step(step, file, progress);
  return naming(file.name(), [&] {
    return section_of(store_samples(file, number, timevarying::StoreAccess::memory(store), plane, progress),
                      plane);
  });
}

}  // namespace adamas
