#include "adamas/slice_files.h"

#include "adamas/file_names.h"
#include "adamas/volume_store.h"
#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/io/input_file.h"
#include "core/io/unstructured_mesh_io.h"
#include "core/picture/slice_picture.h"
#include "workflow/slices/cut_input.h"
#include "workflow/slices/gradient_picture.h"
#include "workflow/slices/slice_samples.h"
#include "workflow/slices/slice_scale.h"
#include "workflow/slices/slice_series.h"
#include "workflow/slices/slice_steps.h"

namespace adamas {

using namespace workflow;

SliceReport write_slice(const SliceRequest& given, const std::filesystem::path& output_path,
                        OutputSet& outputs, Progress& progress) {
  const LoopProgress loops(progress);
  SliceRequest request = given;
  const std::string output = output_path.string();
  const SliceSteps steps = find_slice_steps(request, output, outputs);
  if (!request.inputs.empty()) request.input.path = request.inputs.front();
  outputs.protect(with_main_file(request.input).path);
  std::optional<StepOfSeries> step;
  if (!steps.chosen.empty()) {
    if (!request.step || names_series(output)) return slice_series(request, steps, output, outputs, progress);
    const SliceStep& only = steps.chosen.front();
    outputs.protect(only.file);
    step = StepOfSeries{only.time, only.number};
    request.input.path = only.file;
    request.step.reset();
  }
  if (request.frame_rate) wrong_usage("--frame-rate: expected a series, and a film as output");
  outputs.declare("-o", output, {".png", ".svg", ".pdf", ".vtp"});
  SliceReport report;
  if (request.gradients) {
    if (is_store(request.input.path)) static_cast<void>(sample_origin(request));
    report.part_without_gradient = draw_gradients(request, output, outputs, progress);
    return report;
  }
  const bool polygons = file_extension(output) == ".vtp";
  const CutInput cut = cut_input(request, polygons, outputs, progress);
  report.areas = section_areas(cut);
  progress.step("drawing", -1);
  outputs.write(output, [&](const auto& path) {
    if (polygons) return io::write_unstructured_mesh(path, section_polygons(cut));
    picture::SlicePicture picture = make_picture(request, cut);
    if (const auto& of = step ? step : cut.input.step) add_step_title(of->time, of->number, picture);
    picture::write_slice(picture, path, picture_size(request));
  });
  return report;
}

}  // namespace adamas
