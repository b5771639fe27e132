#include "interfaces/comparison/comparison.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "interfaces/comparison/comparison_run.h"
#include "interfaces/comparison/element_errors.h"
#include "interfaces/comparison/heat_conduction.h"
#include "interfaces/simplification/interface_simplification.h"

namespace adamas::interfaces {

namespace {

using Clock = std::chrono::steady_clock;

/// Points closer to a side of the box than this part of its diagonal are moved onto it.
constexpr double kOntoBox = 1e-9;
/// Distances below this part of the wanted error count as equal to it and are not measured more exactly.
constexpr double kResolution = 0.01;
/// The last trial gets at least this many seconds, so that the child that reaches the limit reports it.
constexpr double kLeastSeconds = 0.01;

}  // namespace

std::vector<ComparedMesh> Comparison::run() {
  bool first = true;
  for (const double error : options_.interface_errors) {
    ResamplingOptions wanted = options_.resampling;
    wanted.interface_error = error;
    const OwnMesh own = make_own_mesh(source_, wanted, progress_);
    finish(own.row, own);
    finish(own.cut_row, own);
    if (std::exchange(first, false)) {
      stitch_input();
      if (options_.tetgen) add_untouched(own);
    }
    if (options_.tetgen) add_resampled(own);
    if (options_.tetgen) add_simplified(own);
    if (options_.mesh3) add_mesh3(own);
    if (options_.mesh3) add_mesh3_simplified(own);
    if (options_.mesh3 && options_.image) add_mesh3_labels(own);
  }
  return std::move(rows_);
}

double Comparison::matched_distance(const ComparedMesh& row, const OwnMesh& own) {
  return std::max(row.figures.distance.greatest(), kResolution * *own.row.interface_error);
}

void Comparison::finish(ComparedMesh row, const OwnMesh& own) {
  const double ratio = matched_distance(row, own) / matched_distance(own.row, own);
  row.matched = row.failure.empty() && std::abs(ratio - 1) <= SizingOptions().tolerance;
  rows_.push_back(row);
  if (options_.finished) options_.finished(row);
}

double Comparison::seconds_left() const {
  return options_.mesher.limits.seconds - std::chrono::duration<double>(Clock::now() - started_).count();
}

MesherOptions Comparison::mesher() const {
  MesherOptions result = options_.mesher;
  result.limits.whole_seconds = result.limits.seconds;
  result.limits.seconds = std::max(seconds_left(), kLeastSeconds);
  return result;
}

PiecewiseLinearComplex Comparison::stitch(std::span<const Vec3> points,
                                          std::span<const BodyTriangle> triangles) const {
  return stitch_to_box(
      source_.name, points, triangles, source_.box, kOntoBox * source_.box.diagonal(),
      [this](const Vec3& p) { return source_.body_at(p, nullptr); }, options_.mesher.program, progress_);
}

void Comparison::stitch_input() {
  const InterfaceNetwork& network = *source_.network;
  std::vector<BodyTriangle> triangles;
  for (std::uint32_t t = 0; t < network.triangles().size(); ++t) {
    const auto& interface = network.interface(network.interface_of(t));
    triangles.push_back({network.triangles()[t], interface.a, interface.b});
  }
  try {
    input_ = stitch(network.points(), triangles);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    input_fault_ = error.what();
  }
}

/// Returns the failure of a mesh that lacks materials of the input; empty if it has all.
std::string Comparison::lost_materials(const MeshFigures& figures) const {
  const InterfaceTable& table = source_.network->table();
  for (BodyId b(0); b.value < table.body_count(); ++b.value) {
    const MaterialId m = table.material(b);
    if (!(figures.volumes[m] > 0)) return "lost the material '" + source_.materials[m] + "'";
  }
  return "";
}

void Comparison::measure(const ReferenceResult& result, double target, ComparedMesh& row) {
  row.failure = result.failure;
  row.seconds = result.seconds;
  row.peak_memory_bytes = result.peak_memory_bytes;
  if (!row.failure.empty()) return;
  const InterfaceTable& table = source_.network->table();
  MeshFigures& figures = row.figures;
  figures = {};
  figures.tetrahedra = result.mesh.tetrahedra.size();
  figures.vertices = result.mesh.points.size();
  figures.dihedral = dihedral_range(result.mesh);
  figures.volumes.assign(source_.materials.size(), 0.0);
  std::size_t lost = 0;
  const auto volumes = body_volumes(result.mesh, table.body_count());
  for (BodyId b(0); b.value < volumes.size(); ++b.value) {
    figures.volumes[table.material(b)] += volumes[b];
    if (!(volumes[b] > 0)) ++lost;
  }
  row.failure = lost_materials(figures);
  if (!row.failure.empty()) return;
  if (lost > 0)
    row.note += fmt::format("{}{} of {} bodies are lost", row.note.empty() ? "" : "; ", lost, volumes.size());
  figures.distance =
      measure_distance(source_, result.mesh.points, interface_faces(result.mesh), target, progress_);
}

void Comparison::measure_chosen(const ReferenceResult& result, const OwnMesh& own, ComparedMesh& row) {
  row.figures.condition_number = stiffness_condition_number(result.mesh, source_.box);
  if (!source_.fields) return;
  const auto start = Clock::now();
  const std::vector<VertexRecord> vertices = fields_at_vertices(result.mesh, source_);
  row.field_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  row.figures.fields =
      measure_element_errors(source_, measured_cells(result.mesh, vertices), own.half_width, progress_)
          .figures(own.at_interface);
}

/// Runs TetGen with the wanted switches. If it crashes or loses something, it runs again with the least
/// tolerance, since interfaces in cells have nearly flat triangles, and again without its sorting of points,
/// with which some inputs of few points crash.
ReferenceResult Comparison::run_tetgen(const PiecewiseLinearComplex& complex, ComparedMesh& row) {
  ReferenceResult first;
  start_clock();
  for (const char* more : {"", "T1e-14", "b0"}) {
    const std::string switches = options_.tetgen_switches + more;
    progress_.step("meshing by TetGen", -1);
    ReferenceResult result = mesh_by_tetgen(complex, switches, mesher(), progress_);
    if (result.failure.empty() && *more != '\0')
      row.note += (row.note.empty() ? "failed with " : "; failed with ") + options_.tetgen_switches;
    row.switches = switches;
    if (result.failure.empty()) return result;
    if (*more == '\0') first = std::move(result);
    if ((!first.crashed && !first.failure.starts_with("lost")) || seconds_left() <= 0) break;
  }
  row.switches = options_.tetgen_switches;
  return first;
}

void Comparison::add_tetgen(const PiecewiseLinearComplex& complex, const OwnMesh& own, ComparedMesh& row) {
  const ReferenceResult result = run_tetgen(complex, row);
  measure(result, *own.row.interface_error, row);
  if (row.failure.empty()) measure_chosen(result, own, row);
}

void Comparison::add_untouched(const OwnMesh& own) {
  ComparedMesh row;
  row.kind = MeshKind::kTetGenUntouched;
  row.failure = input_fault_;
  if (input_) add_tetgen(*input_, own, row);
  if (row.failure.empty())
    row.note += std::string(row.note.empty() ? "" : "; ") +
                "distance 0 by construction, but for facets joined that are coplanar within 0.1 degrees";
  finish(row, own);
}

void Comparison::add_resampled(const OwnMesh& own) {
  ComparedMesh row;
  row.kind = MeshKind::kTetGen;
  row.interface_error = own.row.interface_error;
  try {
    add_tetgen(stitch(own.interface_points, own.interfaces), own, row);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    row.failure = error.what();
  }
  finish(row, own);
}

PiecewiseLinearComplex Comparison::simplified_input(double error, std::string& note) {
  SimplificationOptions options;
  options.error = error;
  const auto start = Clock::now();
  const SimplifiedNetwork found = simplify_interfaces(source_, options, progress_);
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  note = fmt::format("{} of {} triangles of the input's within {:.4g}, simplified in {:.3f} s",
                     found.mesh.triangles.size(), found.triangles_before, found.certificate.networks.upper,
                     seconds);
  std::vector<BodyTriangle> triangles;
  for (std::size_t t = 0; t < found.bodies.size(); ++t)
    triangles.push_back({found.mesh.triangles[t].points, found.bodies[t][0], found.bodies[t][1]});
  return stitch(found.mesh.points, triangles);
}

/// Adds a row for the input's interfaces simplified within the wanted error or, if TetGen fails with them,
/// within a part of it.
void Comparison::add_simplified(const OwnMesh& own) {
  std::string failed;
  for (const double part : {1.0, 0.5, 0.25}) {
    ComparedMesh row;
    row.kind = MeshKind::kTetGenSimplified;
    row.interface_error = own.row.interface_error;
    try {
      add_tetgen(simplified_input(part * *row.interface_error, row.note), own, row);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      row.failure = error.what();
    }
    row.note += failed;
    if (row.failure.empty() || part == 0.25) return finish(row, own);
    failed += fmt::format("; failed with those simplified to {:.4g}", part * *row.interface_error);
  }
}

std::vector<ComparedMesh> compare_meshes(const ResamplingSource& source, const ComparisonOptions& options,
                                         Progress& progress) {
  return Comparison(source, options, progress).run();
}

}  // namespace adamas::interfaces
