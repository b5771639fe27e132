#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "adamas/output_folder.h"
#include "adamas/series.h"
#include "cli/command.h"
#include "cli/experiment_options.h"
#include "cli/experiment_report.h"
#include "cli/experiment_series.h"
#include "cli/generated_data.h"
#include "cli/left_out_steps.h"
#include "cli/series_curves.h"
#include "cli/surface_picture.h"
#include "cli/usage.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/multi_material_writer.h"
#include "core/io/solver_mesh_io.h"
#include "core/io/unstructured_mesh_io.h"
#include "core/picture/film.h"
#include "interfaces/cutting/cut_mesh.h"
#include "interfaces/cutting/cut_mesh_file.h"
#include "interfaces/library/resample_options.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/network/network_mesh.h"
#include "workflow/output/picture_block.h"
#include "workflow/slices/slice_panels.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;
using namespace picture;
using namespace workflow;

namespace {

/// The width in pixels of pictures with three panels.
constexpr double kSliceWidth = 2000;

ResamplingOptions without_fields(ResamplingOptions options) {
  std::fill(options.field_errors.begin(), options.field_errors.end(), std::nullopt);
  return options;
}

/// An experiment, step by step; what it finds goes into the record and into the folder.
class Experiment {
 public:
  Experiment(const ExperimentOptions& options, const ExperimentRequest& request,
             const std::vector<SeriesEntry>& steps, OutputFolder& folder, Console& console)
      : options_(options), request_(request), steps_(steps), folder_(folder), console_(console) {}

  ExperimentRecord run() {
    load();
    show_input();
    refine();
    show_meshes();
    cut_slices();
    follow_curve();
    balance();
    compare_with_published();
    if (!steps_.empty()) {
      record_.series = follow_series(options_, request_, steps_, folder_, console_);
      record_.film = options_.film.file;
    }
    record_.seconds = console_.seconds();
    return std::move(record_);
  }

 private:
  void load();
  void load_last_step();
  void show_input();
  void refine();
  void show_meshes();
  void cut_slices();
  void add_slice(ResampledMesh& mesh, const Plane& plane, const std::string& name, const std::string& caption,
                 const std::optional<Box2>& detail);
  void follow_curve();
  void balance();
  void compare_with_published();

  void write_interfaces_of(const InterfaceMesh& mesh, const std::string& name, bool triangle_edges) {
    console_.step("writing " + name, -1);
    write_interface_mesh(folder_.file(name + ".vtp"), mesh);
    DrawingOptions picture = options_.pictures.drawing;
    picture.triangle_edges = triangle_edges;
    workflow::write_surface_picture(folder_.file(name + ".png"), mesh, input_.source.box, picture);
  }

  const ExperimentOptions& options_;
  const ExperimentRequest& request_;
  const std::vector<SeriesEntry>&
      steps_;  ///< of a series, whose last whole step is the input; empty for one file
  OutputFolder& folder_;
  Console& console_;
  workflow::LoadedInput input_;
  SliceInput slices_;
  ResamplingOptions targets_;
  ResampledMesh interface_mesh_;  ///< within the interface error
  ResampledMesh mesh_;            ///< within the field errors too, where they were asked for
  ExperimentRecord record_;
};

void Experiment::load() {
  InputArguments from = with_main_file(options_.input);
  if (!options_.generate.empty()) {
    from.path = folder_.file("input.vtr");
    write_multi_material_data(from.path, generate_data(request_.data, console_));
  }
  if (steps_.empty()) {
    input_ = load_input(from, console_, [this](const InputFacts& found) { request_.check(found); });
  } else {
    load_last_step();
  }
  if (!options_.generate.empty()) input_.data->source = input_.source.name = "input.vtr";
  const MultiMaterialData& data = *input_.data;
  check_shown_interfaces(options_.pictures.drawing.shown, data.materials, data.source);
  targets_ = to_resampling_options(request_.resampling, input_.source);
  record_.title = options_.title.empty() ? "Resampling " + input_.source.name : options_.title;
  const auto counts = [&](int axis) { return data.grid.sites(axis); };
  record_.input =
      fmt::format("{}: {} x {} x {} {}, {} materials, {} fields",
                  std::filesystem::path(input_.source.name).filename().string(), counts(0), counts(1),
                  counts(2), data.grid.centering == Centering::kCells ? "cells" : "points",
                  data.materials.size(), data.fields.size());
  if (!steps_.empty())
    record_.input = fmt::format("{}, {} steps; the last: {}",
                                std::filesystem::path(options_.inputs.front()).filename().string(),
                                steps_.size(), record_.input);
  if (input_.source.fields) record_.fields = input_.source.fields->fields();
  if (!options_.show.empty()) record_.shown = find_field(record_.fields, options_.show, data.source).field;
  record_.density = request_.density(record_.fields, data.source);
}

/// The last one that is not damaged.
void Experiment::load_last_step() {
  InputArguments from = options_.input;
  LeftOutSteps left_out;
  const auto check = [this](const InputFacts& found) { request_.check(found); };
  for (std::size_t n = steps_.size(); n-- > 0;) {
    from.path = steps_[n].file;
    if (left_out.read_input(n, from, check, console_, input_)) return;
  }
  left_out.check(steps_.size());
}

void Experiment::show_input() {
  InterfaceMesh mesh = network_mesh(*input_.source.network, input_.source.materials, input_.source.name);
  std::map<std::pair<MaterialId, MaterialId>, std::size_t> counts;
  for (const InterfaceTriangle& t : mesh.triangles) ++counts[std::minmax(t.front, t.back)];
  for (const auto& [pair, count] : counts)
    record_.triangles.emplace_back(mesh.materials[pair.first] + " | " + mesh.materials[pair.second], count);
  write_interfaces_of(mesh, "input-interfaces", false);
  record_.input_pictures.push_back(
      {"input-interfaces.png",
       "Interfaces of the input; each side has the colour of the material behind it."});
  slices_.name = input_.source.name;
  slices_.interfaces = std::move(mesh);
}

void Experiment::refine() {
  InterfaceMesh approximated;
  record_.interfaces =
      run_resampler(input_.source, without_fields(targets_), console_, &interface_mesh_, &approximated);
  write_interfaces_of(approximated, "mesh-interfaces", true);
  const auto wanted = [](const auto& target) { return target.has_value(); };
  if (std::any_of(targets_.field_errors.begin(), targets_.field_errors.end(), wanted))
    record_.with_fields = run_resampler(input_.source, targets_, console_, &mesh_);
  workflow::write_surface_picture(folder_.file("mesh-interfaces.html"), approximated, input_.source.box,
                                  options_.pictures.drawing,
                                  workflow::picture_block(record_.with_fields ? mesh_ : interface_mesh_));
}

void Experiment::show_meshes() {
  record_.mesh_pictures.push_back({"mesh-interfaces.png", "Interfaces of the mesh, triangle by triangle."});
  record_.mesh_pictures.push_back(
      {"mesh-interfaces.html", "The same, to be turned: materials go on and off, and a plane cuts."});
  if (record_.with_fields) {
    write_unstructured_mesh(folder_.file("interface-mesh.vtu"), to_unstructured_mesh(interface_mesh_));
  }
  const ResampledMesh& mesh = record_.with_fields ? mesh_ : interface_mesh_;
  write_unstructured_mesh(folder_.file("mesh.vtu"), to_unstructured_mesh(mesh));
  const SolverMesh cut =
      to_solver_mesh(cut_mesh(mesh, kCutTolerance * targets_.interface_error, console_), mesh);
  write_solver_mesh(folder_.file("cut-mesh.vtu"), cut);
  write_unstructured_mesh(folder_.file("cut-mesh-faces.vtp"), face_surface(cut));
}

void Experiment::add_slice(ResampledMesh& mesh, const Plane& plane, const std::string& name,
                           const std::string& caption, const std::optional<Box2>& detail) {
  slices_.mesh = std::move(mesh);
  SliceStyle style{.plane = plane, .field = options_.show};
  std::vector<SliceMode> modes{SliceMode::kInput, SliceMode::kMaterials};
  if (!style.field.empty()) modes.insert(modes.begin() + 1, SliceMode::kPlain);
  SliceOptions size;
  size.width = kSliceWidth;
  style.input_cells = shows_cells(slices_, plane, size, modes.size());
  std::vector<CrossSection> sections;
  for (const SliceMode mode : modes) sections.push_back(cut(slices_, mode, style));
  SlicePicture picture = make_slice_picture(slices_, modes, style, sections);
  mesh = *std::move(slices_.mesh);
  const auto write = [&](const std::string& file, const std::string& text) {
    console_.step("writing " + file, -1);
    write_slice(picture, folder_.file(file), size);
    record_.slices.push_back({file, text});
  };
  write(name + ".png", caption);
  if (!detail) return;
  picture.window = detail;
  write(name + "-detail.png", "A part of it, enlarged.");
}

void Experiment::cut_slices() {
  if (request_.planes.empty()) return;
  slices_.data = std::move(input_.data);
  std::size_t number = 0;
  for (const Plane& plane : request_.planes) {
    const std::string name = fmt::format("slice-{}", ++number);
    const auto detail = number == 1 ? request_.detail : std::nullopt;
    add_slice(
        interface_mesh_, plane, name,
        to_string(plane) + (options_.show.empty()
                                ? ": the input; the mesh that holds the interfaces."
                                : ": the input; plain linear interpolation in the cells of the mesh that "
                                  "holds the interfaces; each material's own field."),
        detail);
    if (!record_.with_fields) continue;
    add_slice(mesh_, plane, name + "-fields",
              fmt::format("{}: the same with the mesh that holds the fields too.", to_string(plane)), detail);
  }
  input_.data = std::move(slices_.data);
}

void Experiment::follow_curve() {
  ResamplingOptions options = without_fields(targets_);
  record_.curve_is_given = !options_.curve.empty();
  for (const double error : request_.curve(facts_of(input_.source), targets_.interface_error)) {
    if (error == targets_.interface_error) {
      record_.curve.push_back(record_.interfaces);
      continue;
    }
    options.interface_error = error;
    record_.curve.push_back(run_resampler(input_.source, options, console_));
  }
}

void Experiment::balance() {
  const ResampledMesh written =
      from_unstructured_mesh(read_unstructured_mesh(folder_.file("mesh.vtu")), "mesh.vtu");
  record_.ledger = make_ledger(*input_.data, written, record_.density);
}

void Experiment::compare_with_published() {
  record_.published_by = options_.published_by;
  for (const auto& [name, published] : request_.published) {
    double here = std::numeric_limits<double>::quiet_NaN();
    if (name == "interface tetrahedra")
      here = static_cast<double>(record_.interfaces.report.interface_tetrahedra);
    if (name == "tetrahedra") here = static_cast<double>(record_.interfaces.report.tetrahedra);
    if (name == "tetrahedra with fields") here = static_cast<double>(record_.last().report.tetrahedra);
    if (!record_.fields.empty()) {
      const ResampleReport::Errors& near = record_.last().report.fields[record_.shown].at_interfaces;
      if (name == "greatest field error at interfaces") here = near.max_error;
      if (name == "mean field error at interfaces") here = near.mean_error;
    }
    for (const auto& [pair, count] : record_.triangles) {
      if (name == "triangles " + pair) here = static_cast<double>(count);
    }
    record_.published.push_back({name, published, here});
  }
}

void print_record(const ExperimentRecord& record, const std::string& folder, Console& console) {
  std::vector<std::vector<std::string>> rows{
      {"mesh", "tetrahedra", "with interfaces", "interface error", "seconds"}};
  const auto add = [&](const std::string& name, const ExperimentRun& run) {
    rows.push_back(
        {name, std::to_string(run.report.tetrahedra), std::to_string(run.report.interface_tetrahedra),
         run.report.interface_error ? fmt::format("{:.4g}", run.report.interface_error->certified) : "-",
         fmt::format("{:.2f}", run.seconds)});
  };
  add("interfaces", record.interfaces);
  if (record.with_fields) add("with fields", *record.with_fields);
  console.table(rows);
  // Those of the steps of a series, of which the input is one, were told as they were made.
  for (const auto& [mesh, run] : wanted_runs(record)) {
    const bool told = record.series && (run == &record.interfaces || run == &record.last());
    if (told) continue;
    for (const std::string& line : run->told) console.note_incomplete("{}: {}", mesh, line);
  }
  if (record.series) {
    console.print("\n");
    print_series(*record.series, console);
  }
  if (!record.published.empty()) {
    rows = {{"", record.published_by, "here"}};
    for (const PublishedFigure& figure : record.published)
      rows.push_back(
          {figure.name, fmt::format("{:.6g}", figure.published), fmt::format("{:.6g}", figure.here)});
    console.print("\n");
    console.table(rows);
  }
  // Of curves of a series there are two files each.
  const std::size_t curves = record.series ? 2 * series_curves(*record.series).size() : 0;
  console.print(
      "\n  {}: report.html, metrics.json and {} pictures\n", folder,
      record.input_pictures.size() + record.mesh_pictures.size() + record.slices.size() + curves + 2);
}

void run(ExperimentOptions& options, Session& session) {
  const std::vector<SeriesEntry> steps = series_steps(options.inputs);
  if (!options.inputs.empty())
    options.input.path = steps.empty() ? options.inputs.front() : steps.back().file;
  const ExperimentRequest request(options);
  if (steps.empty() && !options.film.file.empty())
    wrong_usage("--film: expected a series (a .pvd or several files)");
  if (!options.film.file.empty()) require_film_maker(options.film.file);
  for (const SeriesEntry& step : steps) session.outputs.protect(step.file);
  protect_inputs(options.input, with_main_file(options.input).path, session.outputs);
  session.outputs.protect_other(options.output);
  session.outputs.check_outside("-o", options.output);
  OutputFolder folder("an experiment", options.output, options.overwrite);
  ExperimentRecord record;
  Figures figures;
  folder.fill([&] {
    record = Experiment(options, request, steps, folder, session.console).run();
    write_experiment_report(record, folder.temporary());
    figures = experiment_figures(record);
    write_figures(folder.file("metrics.json"), figures);
  });
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, figures); });
  session.console.check();
  print_record(record, options.output, session.console);
  session.console.flush();
  folder.commit();
  session.commit();
  if (record.series) record.series->left_out.note(session.console);
}

}  // namespace

void add_experiment(const Command& app, Session& session) {
  const auto options = std::make_shared<ExperimentOptions>();
  const Command command = add_command(app, session, "experiment",
                                      "A resampling experiment from one file, with pictures and a report",
                                      "adamas experiment -c datasets/impact.toml -o impact\n"
                                      "  adamas experiment run.pvd --plane z=0 --film film.mp4 -o run",
                                      [options, &session] { run(*options, session); });
  add_experiment_options(command, *options);
}

}  // namespace adamas::cli
