#include "interfaces/api/simplify.h"

#include <utility>

#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/base/stopwatch.h"
#include "interfaces/api/adaptive_mesh.h"
#include "interfaces/api/error_targets.h"
#include "interfaces/api/input.h"

namespace adamas {

using namespace interfaces;

namespace interfaces {

SimplifiedNetwork simplify_source(const ResamplingSource& source, const SimplifyOptions& options,
                                  SimplificationReport& report, Progress& progress) {
  SimplificationOptions how;
  how.error = interface_error_of("--simplify", *options.error, facts_of(source));
  how.smooth = options.smooth;
  const Stopwatch watch;
  SimplifiedNetwork found = simplify_interfaces(source, how, progress);
  report.seconds = watch.seconds();
  report.processor_seconds = watch.processor_seconds();
  report.error_target = how.error;
  report.smooth = how.smooth;
  report.distances = to_distances(found.certificate);
  report.triangles_before = found.triangles_before;
  report.triangles = found.mesh.triangles.size();
  report.smallest_angle_before = found.smallest_angle_before;
  report.smallest_angle = found.smallest_angle;
  report.changed_bodies = found.changed_bodies;
  report.contacts = found.contacts;
  report.runs = found.runs;
  return found;
}

namespace {

/// Returns the interfaces that a mesh shows as a source for simplification.
ResamplingSource source_of_shown(const AdaptiveMesh::Contents& contents, Progress& progress) {
  const auto make_source = [](ExtractedInterfaces shown, const Box3& box, const InterfaceTable& table) {
    return source_of_interfaces(shown.mesh, box, std::move(shown.bodies), table.body_materials());
  };
  if (!contents.run) {
    const ResampledMesh& mesh = contents.mesh();
    return make_source(approximated_interfaces(mesh, progress), mesh.box, mesh.table);
  }
  const Resampler& resampler = *contents.run->resampler;
  const ResamplingSource& input = resampler.source();
  ResamplingSource source =
      make_source(approximated_interfaces(resampler, progress), input.box, input.network->table());
  source.voxel = input.voxel;
  return source;
}

}  // namespace

}  // namespace interfaces

void check(const SimplifyOptions& options, const Input& input) {
  if (options.smooth && !options.error) wrong_usage("--smooth: expected --simplify beside it, found none");
  if (options.error)
    static_cast<void>(interface_error_of("--simplify", *options.error, input.contents().facts));
}

SimplifiedInterfaces simplify(const AdaptiveMesh& mesh, const SimplifyOptions& options, Progress& progress) {
  const LoopProgress loops(progress);
  if (!options.error) wrong_usage("--simplify: expected an error, found none");
  const ResamplingSource source = source_of_shown(mesh.contents(), progress);
  SimplifiedInterfaces result;
  SimplifiedNetwork found = simplify_source(source, options, result.report, progress);
  result.mesh = to_interface_triangles(std::move(found.mesh), found.bodies);
  return result;
}

}  // namespace adamas
