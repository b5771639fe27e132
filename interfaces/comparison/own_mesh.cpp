#include "interfaces/comparison/own_mesh.h"

#include <chrono>
#include <cmath>
#include <optional>

#include "interfaces/comparison/element_errors.h"
#include "interfaces/comparison/heat_conduction.h"
#include "interfaces/comparison/peak_memory.h"
#include "interfaces/cutting/cut_mesh.h"
#include "interfaces/cutting/cut_mesh_file.h"
#include "interfaces/resampling/resample_figures.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Returns the time of resampling in seconds.
double seconds_to_refine(const ResamplingSource& source, const ResamplingOptions& options,
                         Progress& progress) {
  const auto start = Clock::now();
  Resampler resampler(source, options, progress);
  resampler.refine();
  return seconds_since(start);
}

/// Makes the mesh without fields, only to measure time and memory.
void time_without_fields(const ResamplingSource& source, const ResamplingOptions& options, ComparedMesh& row,
                         Progress& progress) {
  ResamplingSource bare = source;
  bare.fields = nullptr;
  ResamplingOptions wanted = options;
  wanted.field_errors.clear();
  const PeakMemory memory;
  row.seconds = seconds_to_refine(bare, wanted, progress);
  row.peak_memory_bytes = memory.bytes();
  wanted.certify = false;
  row.certifying_seconds = std::max(0.0, row.seconds - seconds_to_refine(bare, wanted, progress));
}

std::vector<char> elements_at_interfaces(const ResampledMesh& mesh, const ElementErrors& errors,
                                         const Progress& progress) {
  const std::vector<char> crossed = cells_with_interfaces(mesh.table, mesh.cell_set(), progress);
  std::vector<char> result(errors.cells.size());
  for (std::size_t e = 0; e < result.size(); ++e) result[e] = crossed[errors.cells[e]];
  return result;
}

/// Returns the cells as a mesh of one body.
ConformingMesh whole_cells(const ResampledMesh& mesh) {
  ConformingMesh result{mesh.points, {}, std::vector<BodyId>(mesh.cells.size(), BodyId(0))};
  for (const auto& cell : mesh.cells) result.tetrahedra.push_back(cell.vertices);
  return result;
}

void add_cut_row(const ResamplingSource& source, const ResampledMesh& mesh, OwnMesh& own,
                 Progress& progress) {
  ComparedMesh& row = own.cut_row;
  row = own.row;
  row.kind = MeshKind::kOwnCut;
  const auto start = Clock::now();
  const ConformingMesh cut = cut_mesh(mesh, kCutTolerance * *row.interface_error, progress);
  row.seconds += seconds_since(start);
  MeshFigures& figures = row.figures;
  figures.tetrahedra = cut.tetrahedra.size();
  figures.vertices = cut.points.size();
  figures.dihedral = dihedral_range(cut);
  figures.condition_number = stiffness_condition_number(cut, source.box);
  figures.distance =
      measure_distance(source, cut.points, interface_faces(cut), *row.interface_error, progress);
  figures.volumes.assign(source.materials.size(), 0.0);
  const auto volumes = body_volumes(cut, mesh.table.body_count());
  for (BodyId b(0); b.value < volumes.size(); ++b.value)
    figures.volumes[mesh.table.material(b)] += volumes[b];
  if (!source.fields) return;
  const std::vector<VertexRecord> vertices = fields_at_vertices(cut, mesh);
  figures.fields = measure_element_errors(source, measured_cells(cut, vertices), own.half_width, progress)
                       .figures(own.at_interface);
}

/// Returns all errors that were not reached; among those of volumes, only that of the worst body.
std::vector<UnreachedError> all_unreached_errors(const Resampler& resampler,
                                                 const std::vector<FieldFigures>& fields,
                                                 const Progress& progress) {
  std::vector<UnreachedError> errors = unreached_errors(resampler, fields);
  const ResamplingOptions& options = resampler.options();
  if (!options.volume_error && !options.conservation_wanted) return errors;
  const ResampleFigures measured = measure(resampler, progress);
  std::optional<UnreachedError> off, moved;
  for (BodyId b(0); b.value < measured.bodies.size(); ++b.value) {
    const ResampleReport::Body& body = measured.bodies[b.value];
    if (!body.volume_input) continue;
    const std::string whose =
        " of a body of '" + resampler.source().materials[MaterialId(body.material)] + "'";
    const auto shortfall = volume_shortfall(resampler, measured, b);
    if (shortfall && (!off || body.volume_error() > off->found))
      off = {"the volume error wanted" + whose, body.volume_error(), *options.volume_error, *shortfall};
    const double missing = body.missing();
    if (options.conservation_wanted && missing > kConserved * resampler.source().box.volume() &&
        (!moved || missing > std::abs(moved->found - moved->wanted))) {
      moved = {"the volume to be conserved" + whose,
               body.volume_mesh,
               *body.volume_input,
               {"interfaces may not move by more than the interface error", body.place}};
    }
  }
  for (const auto& error : {off, moved}) {
    if (error) errors.push_back(*error);
  }
  return errors;
}

}  // namespace

OwnMesh make_own_mesh(const ResamplingSource& source, const ResamplingOptions& options, Progress& progress) {
  OwnMesh own;
  ComparedMesh& row = own.row;
  row.interface_error = options.interface_error;
  time_without_fields(source, options, row, progress);
  const auto start = Clock::now();
  Resampler resampler(source, options, progress);
  resampler.refine();
  const ResampledMesh mesh = resampled_mesh(resampler);
  if (source.fields) row.field_seconds = std::max(0.0, seconds_since(start) - row.seconds);

  const auto extracted = extract_interfaces(mesh.table, mesh.cell_set(), source.box, progress);
  own.interface_points = extracted.mesh.points;
  std::vector<ClosestPointTree::Triangle> triangles;
  for (std::size_t t = 0; t < extracted.bodies.size(); ++t) {
    triangles.push_back(extracted.mesh.triangles[t].points);
    own.interfaces.push_back({triangles.back(), extracted.bodies[t][0], extracted.bodies[t][1]});
  }
  MeshFigures& figures = row.figures;
  figures.tetrahedra = mesh.cells.size();
  figures.vertices = mesh.points.size();
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) figures.dihedral.add(mesh.corners(c));
  figures.condition_number = stiffness_condition_number(whole_cells(mesh), source.box);
  figures.volumes = material_volumes(mesh.table, mesh.cell_set(), source.materials.size());
  figures.distance =
      measure_distance(source, extracted.mesh.points, triangles, options.interface_error, progress);
  const auto& certified = resampler.certificate();
  own.half_width = std::max(options.interface_error, certified ? certified->materials.upper : 0);
  if (source.fields) {
    const ElementErrors errors =
        measure_element_errors(source, measured_cells(mesh), own.half_width, progress);
    own.at_interface = elements_at_interfaces(mesh, errors, progress);
    figures.fields = errors.figures(own.at_interface);
  }
  row.unreached = all_unreached_errors(resampler, figures.fields, progress);
  for (const UnreachedError& error : row.unreached)
    row.note += (row.note.empty() ? "" : "; ") + error.what + " was not reached";
  add_cut_row(source, mesh, own, progress);
  return own;
}

}  // namespace adamas::interfaces
