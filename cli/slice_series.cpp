#include "cli/slice_series.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/series_input.h"
#include "cli/series_output.h"
#include "cli/slice_scale.h"
#include "cli/usage_error.h"
#include "core/io/input_file.h"
#include "core/io/unstructured_mesh_io.h"
#include "core/picture/film.h"

namespace adamas {

namespace {

/// What is written of a series.
enum class SeriesPictures { kFilm, kPictures, kPolygons };

SeriesPictures kind_of(const std::string& output) {
  if (is_film(output)) return SeriesPictures::kFilm;
  return file_extension(output) == ".pvd" || file_extension(output) == ".vtp" ? SeriesPictures::kPolygons
                                                                              : SeriesPictures::kPictures;
}

/// The steps of a series one after another.
class StepSlices {
 public:
  StepSlices(const SliceRequest& request, const SliceSteps& steps, Session& session)
      : request_(request), steps_(steps.chosen), session_(session) {
    if (request.original.empty()) return;
    originals_ = series_steps({request.original});
    if (!originals_.empty() && originals_.size() != steps.all)
      fail("{}: expected {} steps as {} has, found {}", request.original, steps.all, request.inputs.front(),
           originals_.size());
  }

  /// `last`: it is drawn now, if at all. Before, interfaces are not needed, and notes are for the last time.
  CutInput cut(std::size_t n, bool polygons, bool last) {
    const SliceStep& step = steps_[n];
    session_.console.about = step.name;
    const bool quiet = std::exchange(session_.console.quiet, session_.console.quiet || !last);
    SliceRequest one = request_;
    one.input.path = step.file;
    one.volume = step.volume;
    one.step = step.stored;
    if (!originals_.empty()) one.original = originals_[step.number].file;
    if (!last) one.no_interfaces = true;
    CutInput result = cut_input(one, polygons, session_);
    // The name of all, not that of one step of several data sets.
    result.input.sample_name = request_.volume.array;
    const SliceInput& input = result.input;
    if (input.data && !input.mesh) {
      forms_.check(step.name, *input.data);
    } else {
      forms_.check(step.name, input.materials(), input.box());
    }
    session_.console.quiet = quiet;
    session_.console.about.clear();
    return result;
  }

 private:
  const SliceRequest& request_;
  const std::vector<SliceStep>& steps_;
  Session& session_;
  std::vector<SeriesEntry> originals_;
  SeriesForms forms_;
};

Figures step_figures(const CutInput& cut, const SliceStep& step) {
  const CrossSection& section = cut.sections.back();
  Figures figures{{"step", step.number}, {"time", step.time}, {"file", step.file}, {"area", section.area}};
  figures["materials"] = Figures::array();
  for (MaterialId m(0); m.value < section.material_area.size() && !cut.input.plain(); ++m.value)
    figures["materials"].push_back({{"name", cut.input.materials()[m]}, {"area", section.material_area[m]}});
  figures["pieces"] = section.pieces.size();
  return figures;
}

/// Where the pictures of a series go.
class PictureOutput {
 public:
  PictureOutput(const SliceRequest& request, const std::vector<SliceStep>& steps, OutputSet& outputs)
      : kind_(kind_of(request.output)),
        size_(picture_size(request)),
        output_(request.output),
        outputs_(outputs) {
    if (!request.frame_rate.empty()) {
      if (kind_ != SeriesPictures::kFilm)
        wrong_usage("--frame-rate: expected a film (.mp4, .webm or .gif), found '-o {}'", output_);
      rate_ = parse_positive("--frame-rate", request.frame_rate);
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
          n, [&](const auto& path) { write_slice(picture, path, size_); }, outputs_);
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

void slice_series(const SliceRequest& request, const SliceSteps& all, Session& session) {
  if (request.gradients) wrong_usage("--gradients: expected one store, found a series");
  const std::vector<SliceStep>& steps = all.chosen;
  for (const SliceStep& step : steps) session.outputs.protect(step.file);
  PictureOutput output(request, steps, session.outputs);
  StepSlices slices(request, all, session);
  const bool polygons = output.kind() == SeriesPictures::kPolygons;
  const std::string series = std::filesystem::path(request.inputs.front()).filename().string();
  SliceScale scale(series + ", " + to_string(parse_any_plane(request)));
  // Two times: the colours of the first step depend on the values of the last.
  for (std::size_t n = 0; n < steps.size() && !polygons; ++n)
    scale.add(make_picture(request, slices.cut(n, polygons, false)));
  Figures rows = Figures::array();
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const CutInput cut = slices.cut(n, polygons, true);
    rows.push_back(step_figures(cut, steps[n]));
    session.console.step("drawing " + steps[n].name,
                         static_cast<double>(n) / static_cast<double>(steps.size()));
    if (polygons) {
      output.add(n, section_polygons(cut));
      continue;
    }
    SlicePicture picture = make_picture(request, cut);
    scale.apply(steps[n].number, steps[n].time, picture);
    output.add(n, picture);
  }
  output.finish();
  Figures figures{
      {"plane", to_string(parse_any_plane(request))}, {"range", nullptr}, {"steps", std::move(rows)}};
  const auto shown = value_range(request) ? value_range(request) : scale.range();
  if (shown) figures["range"] = {shown->low, shown->high};
  session.console.print("  {}{}\n", counted(steps.size(), "step"),
                        shown ? fmt::format(", values from {:.6g} to {:.6g}", shown->low, shown->high) : "");
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, figures); });
  session.commit();
}

}  // namespace adamas
