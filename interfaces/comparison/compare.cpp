#include "adamas/compare.h"

#include <cmath>
#include <utility>

#include "adamas/verify.h"
#include "core/base/error.h"
#include "interfaces/api/input.h"
#include "interfaces/api/resample_options.h"
#include "interfaces/api/resample_report.h"
#include "interfaces/comparison/comparison.h"

namespace adamas {

using namespace interfaces;

namespace {

/// Returns the options of resampling for each interface error, in the given order.
std::vector<ResampleOptions> all_runs(const CompareOptions& options) {
  std::vector<ResampleOptions> result;
  for (const ErrorTarget& error : options.interface_errors) {
    result.push_back(options.resampling);
    result.back().interface_error = error;
  }
  if (result.empty()) result.push_back(options.resampling);
  return result;
}

/// Returns the coordinates along an axis at which one label ends and the next begins: the nodes, if cells
/// have the labels; the middles between nodes, if nodes have them.
std::vector<double> walls_of(const RectilinearGrid& grid, int axis) {
  const auto& nodes = grid.nodes[static_cast<std::size_t>(axis)];
  if (grid.centering == Centering::kCells) return nodes;
  std::vector<double> walls{nodes.front()};
  for (std::size_t i = 1; i < nodes.size(); ++i) walls.push_back(0.5 * (nodes[i - 1] + nodes[i]));
  walls.push_back(nodes.back());
  return walls;
}

/// Returns the labels of an input; none if it has fractions or interfaces instead.
std::optional<LabelImage> label_image(const Input::Contents& input) {
  if (input.mesh || input.data->labels.empty()) return std::nullopt;
  const MultiMaterialData& data = *input.data;
  const SiteArray<std::uint16_t> labels = data.labels.dense();
  return LabelImage{
      walls_of(data.grid, 0), walls_of(data.grid, 1), walls_of(data.grid, 2), {labels.begin(), labels.end()}};
}

/// Sets the greatest error of all fields, each relative to the range of its field.
void add_relative_errors(const ComparedMesh& mesh, const ResamplingSource& source, ComparisonRow& row) {
  const auto raise = [](std::optional<double>& to, double value) { to = std::max(to.value_or(0), value); };
  for (std::size_t f = 0; f < mesh.figures.fields.size(); ++f) {
    const FieldInfo& info = source.fields->fields()[f];
    const double range = info.max - info.min;
    const auto& [all, near] = mesh.figures.fields[f];
    if (!(range > 0) || all.count() == 0) continue;
    raise(row.field_max_error, all.max / range);
    raise(row.field_mean_error, all.mean() / range);
    if (near.count() == 0) continue;
    raise(row.field_interface_max_error, near.max / range);
    raise(row.field_interface_mean_error, near.mean() / range);
  }
}

/// Returns the greatest relative difference between a material's volume in the mesh and in the input.
std::optional<double> volume_error(const ComparedMesh& mesh, const ResamplingSource& source) {
  std::optional<double> result;
  for (MaterialId m(0); m.value < source.volumes.size(); ++m.value) {
    if (!(source.volumes[m] > 0)) continue;
    const double error = std::abs(mesh.figures.volumes[m] / source.volumes[m] - 1);
    result = std::max(result.value_or(0), error);
  }
  return result;
}

ComparisonRow row_of(const ComparedMesh& mesh, const ResamplingSource& source) {
  ComparisonRow row = mesh;
  if (!mesh.failure.empty()) {
    // Seconds and memory of attempts that came to nothing do not count.
    row.seconds = row.field_seconds = 0;
    row.peak_memory_bytes = 0;
    return row;
  }
  const MeshFigures& figures = mesh.figures;
  row.tetrahedra = figures.tetrahedra, row.vertices = figures.vertices;
  row.dihedral_min = figures.dihedral.min, row.dihedral_max = figures.dihedral.max;
  row.condition_number = figures.condition_number;
  row.distance_to_input = figures.distance.to_input;
  row.distance_from_input = figures.distance.from_input;
  add_relative_errors(mesh, source, row);
  row.volume_error = volume_error(mesh, source);
  for (std::size_t f = 0; f < figures.fields.size(); ++f)
    row.fields.push_back(field_report(source.fields->fields()[f], figures.fields[f]));
  row.materials = material_reports(source, figures.volumes);
  return row;
}

}  // namespace

// TetGen's output can only be read with the switches z and p, and some other switches make it write files.
void CompareOptions::check() const {
  constexpr const char* kKnown = "zpYqaMTXOCDSbVQ0123456789./e-";
  if (!tetgen && !mesh3) wrong_usage("--reference: expected tetgen, mesh3 or both, found neither");
  if (!(time_limit > 0)) wrong_usage("--time-limit: expected a positive number, found {}", time_limit);
  if (memory_limit < kLeastMesherMemory)
    wrong_usage("--memory-limit: expected a whole number of at least {}, found '{}'", kLeastMesherMemory,
                memory_limit);
  if (tetgen_switches.find('z') == std::string::npos || tetgen_switches.find('p') == std::string::npos ||
      tetgen_switches.find_first_not_of(kKnown) != std::string::npos || tetgen_switches.size() > 100)
    wrong_usage("--tetgen-switches: expected z, p and others of {}, found '{}'", kKnown, tetgen_switches);
}

std::size_t CompareOptions::reference_count(bool labels) const {
  const std::size_t errors = std::max<std::size_t>(interface_errors.size(), 1);
  return (tetgen ? 1 + 2 * errors : 0) + (mesh3 ? (labels ? 4 : 3) * errors : 0);
}

struct MeshComparison::Contents {
  Input input;
  ResamplingSource source;  ///< this refers to the input
  ComparisonOptions options;
};

MeshComparison::MeshComparison(const Input& input, const CompareOptions& options, Progress& progress) {
  options.check();
  ComparisonOptions comparison;
  comparison.mesher.program = find_reference_program("compare");
  comparison.mesher.limits.seconds = options.time_limit;
  comparison.mesher.limits.memory_bytes = options.memory_limit;
  comparison.tetgen = options.tetgen, comparison.mesh3 = options.mesh3;
  comparison.tetgen_switches = options.tetgen_switches;
  const std::vector<ResampleOptions> runs = all_runs(options);
  for (const ResampleOptions& run : runs) check_options(run, input.contents().facts);
  ResamplingSource source = input.contents().source(
      {.smooth_labels = options.resampling.smooth_labels, .fractions = options.resampling.fractions},
      progress);
  comparison.image = label_image(input.contents());
  comparison.resampling = to_resampling_options(runs.front(), source);
  for (const ResampleOptions& run : runs)
    comparison.interface_errors.push_back(to_resampling_options(run, source).interface_error);
  contents_ = std::make_unique<Contents>(Contents{input, std::move(source), std::move(comparison)});
}

MeshComparison::MeshComparison(MeshComparison&&) noexcept = default;
MeshComparison& MeshComparison::operator=(MeshComparison&&) noexcept = default;
MeshComparison::~MeshComparison() = default;

const std::string& MeshComparison::name() const { return contents_->source.name; }

std::vector<ComparisonRow> MeshComparison::run(const std::function<void(const ComparisonRow&)>& finished,
                                               Progress& progress) const {
  std::vector<ComparisonRow> rows;
  ComparisonOptions options = contents_->options;
  options.finished = [&](const ComparedMesh& mesh) {
    rows.push_back(row_of(mesh, contents_->source));
    if (finished) finished(rows.back());
  };
  compare_meshes(contents_->source, options, progress);
  return rows;
}

}  // namespace adamas
