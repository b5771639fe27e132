#include "adamas/resample.h"

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/data/grid_data.h"
#include "core/data/interface_mesh.h"
#include "core/geometry/length_limits.h"
#include "interfaces/library/adaptive_mesh.h"
#include "interfaces/library/resample_options.h"
#include "interfaces/library/resample_report.h"
#include "interfaces/network/check.h"
#include "interfaces/network/mending.h"
#include "interfaces/resampling/output.h"
#include "interfaces/source/grid_source.h"

namespace adamas {

using namespace interfaces;

namespace {

AdaptiveMesh resample(const ResamplingSource& source, const ResampleOptions& options, Progress& progress) {
  Resampler resampler(source, to_resampling_options(options, source), progress);
  resampler.refine();
  progress.step("measuring", -1);
  auto contents = std::make_unique<AdaptiveMesh::Contents>();
  contents->report = report_of(resampler, progress);
  contents->mesh = resampled_mesh(resampler);
  contents->tetrahedra.reserve(contents->mesh.cells.size());
  for (const auto& cell : contents->mesh.cells) contents->tetrahedra.push_back(cell.vertices);
  return AdaptiveMesh(std::move(contents));
}

}  // namespace

AdaptiveMesh resample(const GridData& data, const ResampleOptions& options, Progress& progress) {
  const LoopProgress loops(progress);
  const MultiMaterialData taken = to_multi_material_data(data);
  return resample(
      make_grid_source(taken, {.smooth_labels = options.smooth_labels, .fractions = options.fractions},
                       progress),
      options, progress);
}

AdaptiveMesh resample(const InterfaceTriangles& interfaces, const Box3& domain,
                      const ResampleOptions& options, Progress& progress) {
  const LoopProgress loops(progress);
  InterfaceMesh mesh = to_interface_mesh(interfaces, "interfaces");
  if (options.smooth_labels) fail("{}: expected labels to smooth, found given interfaces", mesh.source);
  check_lengths(mesh.source, domain);
  check_interface_arrays(mesh);
  Box3 found;
  for (const Vec3& p : mesh.points) found.extend(p);
  if (!found.touches(domain))
    fail("{}: expected interfaces in the domain, found them beside it", mesh.source);
  mend_interface_mesh(mesh, &domain);
  check_interface_mesh(mesh, &domain);
  return resample(make_mesh_source(mesh, domain, nullptr, progress), options, progress);
}

}  // namespace adamas
