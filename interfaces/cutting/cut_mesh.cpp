#include "interfaces/cutting/cut_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/loop_progress.h"
#include "interfaces/cutting/bisected_cells.h"
#include "interfaces/cutting/cell_division.h"
#include "interfaces/cutting/interface_target.h"
#include "interfaces/cutting/labelled_mesh.h"
#include "interfaces/cutting/mesh_improvement.h"
#include "interfaces/cutting/restore_volumes.h"
#include "interfaces/network/body_topology.h"
#include "interfaces/resampling/body_comparison.h"
#include "interfaces/resampling/interface_comparison.h"

namespace adamas::interfaces {

namespace {

/// The angle between faces, in degrees, up to which cells are improved.
constexpr double kWantedAngle = 12;
/// The angle between faces, in degrees, that coarsening keeps.
constexpr double kCoarsenedAngle = 15;
/// If cells stay below kLowAngle, cells below kHigherAngles are improved as well, which makes room for them.
constexpr double kLowAngle = 8;
constexpr std::array<double, 3> kHigherAngles{16, 20, 25};
/// Moves that restore volumes keep this part of the least quality, or this angle, in degrees, if that is
/// better.
constexpr double kKeptQuality = 0.9, kKeptAngle = 5.5;
constexpr int kMostRounds = 10;
/// Pieces of bodies that the mesh does not have are dropped if they are at most this many tolerances large.
constexpr double kSpeck = 4;

double sine_of(double degrees) { return std::sin(degrees * std::numbers::pi / 180); }

double worst_quality(const LabelledMesh& mesh) {
  double worst = 1;
  for (std::uint32_t c = 0; c < mesh.cell_count(); ++c) {
    if (mesh.is_alive(c)) worst = std::min(worst, mesh.quality(c));
  }
  return worst;
}

/// Returns places where the boundaries of materials in two meshes of interfaces are farther apart than
/// wanted.
std::vector<Vec3> far_places(InterfaceComparison& comparison, const InterfaceMesh& wanted,
                             const InterfaceMesh& shown, const Progress& progress) {
  comparison.measure(shown, progress);
  std::vector<Vec3> places;
  for (std::uint32_t t = 0; t < wanted.triangles.size(); ++t) {
    if (comparison.too_far(t, 0) || comparison.too_far(t, 1)) places.push_back(wanted.centroid(t));
  }
  for (const std::uint32_t t : comparison.far_shown()) places.push_back(shown.centroid(t));
  return places;
}

}  // namespace

double default_cut_tolerance(const ResampledMesh& mesh, double interface_error) {
  // A mesh of planes has no error from which a tolerance follows.
  const double least = 1e-4 * mesh.box.diagonal();
  return std::max(kCutTolerance * interface_error, least);
}

ConformingMesh cut_mesh(const ResampledMesh& mesh, double tolerance, Progress& progress) {
  const LoopProgress loops(progress);
  ExtractedInterfaces wanted = extract_interfaces(mesh.table, mesh.cell_set(), mesh.box, progress);
  wanted.mesh.materials = mesh.materials;
  const InterfaceTarget target(wanted, tolerance);
  InterfaceComparison comparison(wanted.mesh, mesh.box, true, tolerance);
  BisectedCells cells(mesh, tolerance, progress);
  LabelledMesh cut = divide_cells(cells);
  for (int round = 0; round < kMostRounds; ++round) {
    snap_vertices(cut, target);
    const auto places =
        far_places(comparison, wanted.mesh, interfaces_of(cut.finish(), mesh.table).mesh, progress);
    if (round + 1 == kMostRounds || places.empty() || !cells.bisect_at(places, progress)) break;
    cut = divide_cells(cells);
  }
  drop_specks(cut, body_topology(wanted, mesh.table.body_count(), mesh.box), kSpeck * tolerance);
  const double wanted_quality = sine_of(kWantedAngle);
  bool improves = improve_mesh(cut, target, wanted_quality, progress);
  // Coarsening does not remove the mesh's own vertices, since they carry its fields.
  coarsen_mesh(cut, target, static_cast<std::uint32_t>(mesh.points.size()), sine_of(kCoarsenedAngle),
               progress);
  improves = improve_mesh(cut, target, wanted_quality, progress) && improves;
  for (const double angle : kHigherAngles) {
    if (!improves || worst_quality(cut) >= sine_of(kLowAngle)) break;
    improves = improve_mesh(cut, target, sine_of(angle), progress);
    improves = improve_mesh(cut, target, wanted_quality, progress) && improves;
  }
  const double least = std::min(wanted_quality, worst_quality(cut));
  const double kept = std::max(kKeptQuality * least, std::min(least, sine_of(kKeptAngle)));
  restore_volumes(cut, body_volumes(mesh.table, mesh.cell_set()), kept, tolerance, progress);
  return cut.finish();
}

}  // namespace adamas::interfaces
