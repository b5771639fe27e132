#include "adamas/experiment.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "adamas/files.h"
#include "core/base/error.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/multi_material_writer.h"
#include "core/io/solver_mesh_io.h"
#include "core/io/unstructured_mesh_io.h"
#include "core/picture/slice_picture.h"
#include "interfaces/api/resample_options.h"
#include "interfaces/cutting/cut_mesh.h"
#include "interfaces/cutting/cut_mesh_file.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/network/interface_network.h"
#include "workflow/experiments/experiment_report.h"
#include "workflow/experiments/experiment_request.h"
#include "workflow/experiments/experiment_run.h"
#include "workflow/input/left_out_steps.h"
#include "workflow/input/read_input.h"
#include "workflow/output/resampled_mesh_output.h"
#include "workflow/output/surface_pictures.h"
#include "workflow/series/balance.h"
#include "workflow/series/resample_steps.h"
#include "workflow/series/series_film.h"
#include "workflow/slices/slice_panels.h"

namespace adamas {

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

/// An experiment, step by step. Its findings go into the record and into the folder.
class Experiment {
 public:
  Experiment(const ExperimentOptions& options, const OutputFolder& folder, Progress& progress)
      : options_(options), folder_(folder), progress_(progress) {}

  ExperimentRecord run() {
    load();
    show_input();
    refine();
    show_meshes();
    cut_slices();
    follow_curve();
    balance();
    compare_with_published();
    if (!options_.steps.empty()) follow_series();
    return std::move(record_);
  }

 private:
  void load();
  void load_last_step();
  void read(const std::filesystem::path& file);
  void show_input();
  void refine();
  void show_meshes();
  void cut_slices();
  void add_slice(ResampledMesh& mesh, const Plane& plane, const std::string& name, const std::string& caption,
                 const std::optional<Box2>& detail);
  void follow_curve();
  void balance();
  void compare_with_published();
  void follow_series();

  /// Returns the part of the first plane that is shown enlarged.
  [[nodiscard]] std::optional<Box2> detail_window() const {
    if (!options_.detail) return std::nullopt;
    const auto& [a0, a1, b0, b1] = *options_.detail;
    return Box2{{a0, b0}, {a1, b1}};
  }

  void write_interfaces_of(const InterfaceMesh& mesh, const std::string& name, bool triangle_edges) {
    progress_.step("writing " + name, -1);
    write_interface_mesh(folder_.file(name + ".vtp"), mesh);
    DrawingOptions picture = options_.drawing;
    picture.triangle_edges = triangle_edges;
    write_surface_picture(folder_.file(name + ".png"), mesh, input_.source.box, picture);
  }

  const ExperimentOptions& options_;
  const OutputFolder& folder_;
  Progress& progress_;
  LoadedInput input_;
  SliceInput slices_;
  ResamplingOptions targets_;
  ResampledMesh interface_mesh_;  ///< refined to the interface error
  ResampledMesh mesh_;            ///< refined to the field errors too, where they were asked for
  ExperimentRecord record_;
};

void Experiment::load() {
  std::filesystem::path file = with_main_file(options_.input).path;
  if (options_.generate) {
    file = folder_.file("input.vtr");
    write_multi_material_data(file, *generate_data(*options_.generate, progress_).release());
  }
  if (options_.steps.empty()) {
    read(file);
  } else {
    load_last_step();
  }
  if (!input_.data)
    fail("{}: expected data on a grid, found {}", input_.source.name,
         input_.cells ? "a mesh of cells" : "interfaces");
  if (options_.generate) input_.data->source = input_.source.name = "input.vtr";
  const MultiMaterialData& data = *input_.data;
  check_shown_interfaces(options_.drawing.shown, data.materials, data.source);
  targets_ = to_resampling_options(options_.resampling, input_.source);
  record_.title = options_.title.empty() ? "Resampling " + input_.source.name : options_.title;
  const auto counts = [&](int axis) { return data.grid.sites(axis); };
  record_.input =
      fmt::format("{}: {} x {} x {} {}, {} materials, {} fields",
                  std::filesystem::path(input_.source.name).filename().string(), counts(0), counts(1),
                  counts(2), data.grid.centering == Centering::kCells ? "cells" : "points",
                  data.materials.size(), data.fields.size());
  if (!options_.steps.empty())
    record_.input =
        fmt::format("{}, {} steps; the last: {}", options_.series_name, options_.steps.size(), record_.input);
  std::vector<FieldInfo> fields;
  if (input_.source.fields) fields = input_.source.fields->fields();
  record_.fields = summarize(fields);
  if (!options_.field.empty()) record_.shown = find_field(fields, options_.field, data.source).field;
  record_.density = density_field(options_.density, fields, data.source);
}

void Experiment::read(const std::filesystem::path& file) {
  InputOptions from = options_.input;
  from.path = file;
  input_ = load_input(from, reconstruction_of(options_.resampling), progress_,
                      [this](const InputFacts& found) { check_experiment(options_, found); });
}

/// Loads the last step that is not damaged.
void Experiment::load_last_step() {
  const std::vector<SeriesEntry>& steps = options_.steps;
  LeftOutSteps left_out;
  for (std::size_t n = steps.size(); n-- > 0;) {
    if (left_out.read(n, [&] { read(steps[n].file); })) return;
  }
  left_out.check(steps.size());
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
      run_resampler(input_.source, without_fields(targets_), progress_, &interface_mesh_, &approximated);
  write_interfaces_of(approximated, "mesh-interfaces", true);
  const auto wanted = [](const auto& target) { return target.has_value(); };
  if (std::any_of(targets_.field_errors.begin(), targets_.field_errors.end(), wanted))
    record_.with_fields = run_resampler(input_.source, targets_, progress_, &mesh_);
  write_surface_picture(folder_.file("mesh-interfaces.html"), approximated, input_.source.box,
                        options_.drawing,
                        picture_block(record_.with_fields ? mesh_ : interface_mesh_, options_.drawing));
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
      to_solver_mesh(cut_mesh(mesh, kCutTolerance * targets_.interface_error, progress_), mesh);
  write_solver_mesh(folder_.file("cut-mesh.vtu"), cut);
  write_unstructured_mesh(folder_.file("cut-mesh-faces.vtp"), face_surface(cut));
}

void Experiment::add_slice(ResampledMesh& mesh, const Plane& plane, const std::string& name,
                           const std::string& caption, const std::optional<Box2>& detail) {
  slices_.mesh = std::move(mesh);
  SliceStyle style{.plane = plane, .field = options_.field};
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
    progress_.step("writing " + file, -1);
    write_slice(picture, folder_.file(file), size);
    record_.slices.push_back({file, text});
  };
  write(name + ".png", caption);
  if (!detail) return;
  picture.window = detail;
  write(name + "-detail.png", "A part of it, enlarged.");
}

void Experiment::cut_slices() {
  if (options_.planes.empty()) return;
  slices_.data = std::move(input_.data);
  std::size_t number = 0;
  for (const Plane& plane : options_.planes) {
    const std::string name = fmt::format("slice-{}", ++number);
    const auto detail = number == 1 ? detail_window() : std::nullopt;
    add_slice(
        interface_mesh_, plane, name,
        to_string(plane) + (options_.field.empty()
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
  for (const double error : curve_errors(options_, facts_of(input_.source), targets_.interface_error)) {
    if (error == targets_.interface_error) {
      record_.curve.push_back(record_.interfaces);
      continue;
    }
    options.interface_error = error;
    record_.curve.push_back(run_resampler(input_.source, options, progress_));
  }
}

void Experiment::balance() {
  const ResampledMesh written =
      from_unstructured_mesh(read_unstructured_mesh(folder_.file("mesh.vtu")), "mesh.vtu");
  record_.balance = balance_of(*input_.data, written, record_.density);
}

void Experiment::compare_with_published() {
  record_.published_by = options_.published_by;
  for (const auto& [name, published] : options_.published) {
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

/// Resamples the steps of the series and writes mesh.pvd with the meshes, series.csv, and the film where
/// there is to be one.
void Experiment::follow_series() {
  const std::filesystem::path list = folder_.file("mesh.pvd");
  const ResampleSeriesOptions options = series_options(options_);
  std::optional<SeriesFilm> film;
  if (!options.film.file.empty()) film.emplace(options.film, options.name);
  std::vector<SeriesEntry> meshes;
  const auto finish = [&](std::size_t n, ResampledMesh& mesh, const MaterialColours& colours) {
    const double time = options_.steps[n].time;
    if (film) film->add(time, mesh, colours);
    meshes.push_back({time, step_file(list, n, ".vtu")});
    write_resampled_mesh(folder_.file(meshes.back().file), mesh, colours);
  };
  record_.series = resample_steps(options_.steps, options, {finish, {}}, progress_);
  write_series(list, meshes);
  write_text(folder_.file("series.csv"), series_csv(*record_.series));
  record_.film = options.film.file.string();
  if (film) film->write(folder_.file(record_.film), progress_);
}

}  // namespace

std::vector<std::pair<std::string, const ExperimentRun*>> ExperimentRecord::wanted_runs() const {
  std::vector<std::pair<std::string, const ExperimentRun*>> runs{{"interfaces", &interfaces}};
  if (with_fields) runs.emplace_back("with fields", &*with_fields);
  for (const ExperimentRun& run : curve) {
    const double error = run.report.interface_error_target;
    if (curve_is_given && error != interfaces.report.interface_error_target)
      runs.emplace_back(fmt::format("curve, {:.4g}", error), &run);
  }
  return runs;
}

ExperimentRecord run_experiment(const ExperimentOptions& options, const OutputFolder& folder,
                                Progress& progress) {
  options.check();
  ExperimentRecord record;
  folder.fill([&] {
    record = Experiment(options, folder, progress).run();
    write_experiment_report(record, folder.temporary());
  });
  return record;
}

}  // namespace adamas
