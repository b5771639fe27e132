#include "workflow/slices/slice_series.h"

#include <optional>
#include <utility>

#include "adamas/series.h"
#include "adamas/series_output.h"
#include "adamas/steps.h"
#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/unstructured_mesh_io.h"
#include "core/picture/film.h"
#include "workflow/input/left_out_steps.h"
#include "workflow/input/named_progress.h"
#include "workflow/input/series_forms.h"
#include "workflow/slices/cut_input.h"
#include "workflow/slices/slice_scale.h"

namespace adamas::workflow {

using namespace interfaces;
using namespace io;
using namespace picture;

namespace {

/// The kind of output of a series.
enum class SeriesPictures { kFilm, kPictures, kPolygons };

SeriesPictures kind_of(const std::string& output) {
  if (is_film(output)) return SeriesPictures::kFilm;
  return file_extension(output) == ".pvd" || file_extension(output) == ".vtp" ? SeriesPictures::kPolygons
                                                                              : SeriesPictures::kPictures;
}

/// Drops reports and remarks of a first reading of a step.
class StepProgress final : public NamedProgress {
 public:
  using NamedProgress::NamedProgress;
  void begin(std::string name, bool quiet) {
    set_name(std::move(name));
    quiet_ = quiet;
  }
  void report(std::string_view stage, double fraction) override {
    if (!quiet_) NamedProgress::report(stage, fraction);
  }
  void note(NoteKind kind, std::string_view text) override {
    if (!quiet_ || kind != NoteKind::kRemark) NamedProgress::note(kind, text);
  }

 private:
  bool quiet_ = false;
};

/// Reads and cuts the steps of a series one after another.
class StepSlices {
 public:
  StepSlices(const SliceRequest& request, const SliceSteps& steps, OutputSet& outputs, Progress& progress)
      : request_(request), steps_(steps.chosen), outputs_(outputs), progress_(progress) {
    if (request.original.empty()) return;
    originals_ = series_steps({request.original});
    if (!originals_.empty() && originals_.size() != steps.all)
      fail("{}: expected {} steps as {} has, found {}", request.original, steps.all, request.inputs.front(),
           originals_.size());
  }

  /// Cuts a step; none where it cannot be read. `last`: this is the pass that draws. In the pass before,
  /// interfaces are not needed, and notes are dropped.
  std::optional<CutInput> cut(std::size_t n, bool polygons, bool last) {
    const SliceStep& step = steps_[n];
    if (left_out_.contains(step.number)) return {};
    progress_.begin(step.name, !last);
    SliceRequest one = request_;
    one.input.path = step.file;
    one.volume = step.volume;
    one.step = step.stored;
    if (step.time_number) one.input.data.time = step.time_number;
    if (!originals_.empty()) one.original = originals_[step.number].file;
    if (!last) one.interfaces = false;
    std::optional<CutInput> result;
    const bool is_read = left_out_.read(
        step.number, [&] { result.emplace(workflow::cut_input(one, polygons, outputs_, progress_)); });
    if (!is_read) return {};
    // The name is that of all steps, not that of one of several data sets.
    result->input.sample_name = request_.volume.array;
    const SliceInput& input = result->input;
    if (input.data && !input.mesh) {
      forms_.check(step.name, *input.data);
    } else {
      forms_.check(step.name, input.materials(), input.box());
    }
    return result;
  }
  [[nodiscard]] const LeftOutSteps& left_out() const { return left_out_; }

 private:
  const SliceRequest& request_;
  const std::vector<SliceStep>& steps_;
  OutputSet& outputs_;
  StepProgress progress_;
  std::vector<SeriesEntry> originals_;
  SeriesForms forms_;
  LeftOutSteps left_out_;
};

/// The destination of the pictures of a series.
class PictureOutput {
 public:
  PictureOutput(const SliceRequest& request, const std::vector<SliceStep>& steps, const std::string& output,
                OutputSet& outputs)
      : kind_(kind_of(output)), size_(picture_size(request)), output_(output), outputs_(outputs) {
    if (request.frame_rate) {
      if (kind_ != SeriesPictures::kFilm)
        wrong_usage("--frame-rate: expected a film (.mp4, .webm or .gif), found '-o {}'", output_);
      rate_ = *request.frame_rate;
    }
    if (kind_ == SeriesPictures::kFilm) {
      require_film_maker(output_);
      outputs.declare("-o", output_, film_endings());
      return;
    }
    std::vector<double> times;
    for (const SliceStep& step : steps) times.push_back(step.time);
    const std::string ending =
        kind_ == SeriesPictures::kPolygons ? ".vtp" : std::filesystem::path(output_).extension().string();
    if (kind_ == SeriesPictures::kPictures && ending != ".png" && ending != ".svg" && ending != ".pdf")
      wrong_usage(
          "-o: expected of a series a film (.mp4, .webm, .gif), a pattern of pictures as S_%04d.png or a "
          "list of polygons (.pvd), found '{}'",
          output_);
    files_.emplace(output_, std::move(times), ending, outputs, steps.front().number);
  }

  [[nodiscard]] SeriesPictures kind() const { return kind_; }
  void add(std::size_t n, const SlicePicture& picture) {
    if (kind_ != SeriesPictures::kFilm) {
      files_->write(
          n, [&](const auto& path) { picture::write_slice(picture, path, size_); }, outputs_);
      return;
    }
    const Raster frame = draw_slice_frame(picture, size_);
    outputs_.write(output_, [&](const auto& path) {
      if (!film_) film_ = std::make_unique<Film>(path, frame.width(), frame.height(), rate_);
      film_->add(frame);
    });
  }
  void add(std::size_t n, const UnstructuredMesh& polygons) {
    files_->write(
        n, [&](const auto& path) { write_unstructured_mesh(path, polygons); }, outputs_);
  }
  void leave_out(std::size_t n) {
    if (files_) files_->leave_out(n, outputs_);
  }
  void finish() {
    if (files_) files_->write_list(outputs_);
    if (film_) outputs_.write(output_, [this](const auto&) { film_->finish(); });
  }

 private:
  SeriesPictures kind_;
  SliceOptions size_;
  double rate_ = kFrameRate;
  std::string output_;
  OutputSet& outputs_;
  std::optional<SeriesOutput> files_;
  std::unique_ptr<Film> film_;
};

}  // namespace

SliceReport slice_series(const SliceRequest& request, const SliceSteps& all, const std::string& output_name,
                         OutputSet& outputs, Progress& progress) {
  if (request.gradients) wrong_usage("--gradients: expected one store, found a series");
  const std::vector<SliceStep>& steps = all.chosen;
  for (const SliceStep& step : steps) outputs.protect(step.file);
  PictureOutput output(request, steps, output_name, outputs);
  StepSlices slices(request, all, outputs, progress);
  const bool polygons = output.kind() == SeriesPictures::kPolygons;
  const std::string series = std::filesystem::path(request.inputs.front()).filename().string();
  SliceScale scale(series + ", " + to_string(request.plane));
  // A first pass is needed because the colours of the first step depend on the values of the last.
  for (std::size_t n = 0; n < steps.size() && !polygons; ++n)
    if (const auto cut = slices.cut(n, polygons, false)) scale.add(make_picture(request, *cut));
  slices.left_out().check(steps.size());
  SliceReport report;
  report.is_series = true;
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const std::optional<CutInput> cut = slices.cut(n, polygons, true);
    if (!cut) {
      output.leave_out(n);
      continue;
    }
    report.steps.push_back({steps[n].number, steps[n].time, steps[n].file, section_areas(*cut)});
    progress.step("drawing " + steps[n].name, static_cast<double>(n) / static_cast<double>(steps.size()));
    if (polygons) {
      output.add(n, section_polygons(*cut));
      continue;
    }
    SlicePicture picture = make_picture(request, *cut);
    scale.apply(steps[n].number, steps[n].time, picture);
    output.add(n, picture);
  }
  slices.left_out().check(steps.size());
  output.finish();
  report.left_out = slices.left_out().all();
  if (const auto shown = request.range ? value_range(request) : scale.range())
    report.range = {shown->low, shown->high};
  return report;
}

}  // namespace adamas::workflow
