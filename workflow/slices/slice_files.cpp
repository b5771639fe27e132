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

namespace {

/// Throws Error (kUsage) for values that are not allowed, whatever the input is.
void check_values(const SliceRequest& request) {
  if (!(squared_norm(request.plane.normal) > 0))
    wrong_usage("--normal: expected a vector with a length, found 0");
  if (request.range && !((*request.range)[0] < (*request.range)[1]))
    wrong_usage("--range: expected a < b in a,b, found '{},{}'", (*request.range)[0], (*request.range)[1]);
  for (const double side : {request.width, request.greatest_height}) {
    if (!(side >= 200 && side <= 16000))
      wrong_usage("--size: expected a width and a height from 200 to 16000, found '{},{}'", request.width,
                  request.greatest_height);
  }
  if (request.frame_rate && !(*request.frame_rate > 0))
    wrong_usage("--frame-rate: expected a positive number, found '{}'", *request.frame_rate);
}

/// What one picture shows: an input, or one step of a series.
struct OneInput {
  SliceRequest request;  ///< its main file is `input.path`
  std::optional<StepOfSeries> step;
};

/// Takes the only step of a series that was chosen, or the input where there is none.
OneInput one_input(const SliceRequest& request, const SliceSteps& steps) {
  OneInput one{request, {}};
  if (!request.inputs.empty()) one.request.input.path = request.inputs.front();
  if (steps.chosen.empty()) return one;
  const SliceStep& only = steps.chosen.front();
  one.step = {only.time, only.number};
  one.request.input.path = only.file;
  if (only.time_number) one.request.input.data.time = only.time_number;
  one.request.step.reset();
  return one;
}

}  // namespace

Slice slice(const SliceRequest& request, Progress& progress) {
  const LoopProgress loops(progress);
  check_values(request);
  if (request.gradients) wrong_usage("--gradients: expected a picture as output, found none");
  if (request.sections == SliceSections::kAll)
    wrong_usage("--mode all: expected a picture as output, found none");
  const SliceSteps steps = find_slice_steps(request, {});
  if (request.steps || (!steps.chosen.empty() && !request.step))
    wrong_usage("--step: expected the number of one of the {} steps of {}, found none", steps.all,
                request.inputs[0]);
  OutputSet none;
  return last_section(cut_input(one_input(request, steps).request, true, none, progress));
}

SliceReport write_slice(const SliceRequest& given, const std::filesystem::path& output_path,
                        OutputSet& outputs, Progress& progress) {
  const LoopProgress loops(progress);
  const std::string output = output_path.string();
  check_values(given);
  const SliceSteps steps = find_slice_steps(given, output);
  const OneInput one = one_input(given, steps);
  const SliceRequest& request = one.request;
  if (!given.inputs.empty()) outputs.protect(given.inputs.front());
  outputs.protect(with_main_file(request.input).path);
  if (!steps.chosen.empty() && (!given.step || names_series(output)))
    return slice_series(given, steps, output, outputs, progress);
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
  const std::optional<StepOfSeries>& titled = one.step ? one.step : cut.input.step;
  outputs.write(output, [&](const auto& path) {
    if (polygons) return io::write_unstructured_mesh(path, section_polygons(cut));
    picture::SlicePicture picture = make_picture(request, cut);
    if (titled) add_step_title(titled->time, titled->number, picture);
    picture::write_slice(picture, path, picture_size(request));
  });
  return report;
}

}  // namespace adamas
