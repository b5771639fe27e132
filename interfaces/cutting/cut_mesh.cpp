#include "interfaces/cutting/cut_mesh.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "adamas/progress.h"
#include "core/base/loop_progress.h"
#include "core/base/typed_id.h"
#include "interfaces/cutting/bisected_cells.h"
#include "interfaces/cutting/cell_division.h"
#include "interfaces/cutting/interface_target.h"
#include "interfaces/cutting/labelled_mesh.h"
#include "interfaces/cutting/local_changes.h"
#include "interfaces/cutting/mesh_improvement.h"
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

constexpr int kMostSteps = 40, kMostHalvings = 3;
constexpr double kEnough = 1e-11;  ///< the greatest missing volume that is accepted, relative to the whole
/// This part of the greatest term is added to the diagonal of the equations to make them regular.
constexpr double kRegular = 1e-9;
/// Steps end if more than this part of the volume missing before is still missing.
constexpr double kStill = 0.999;

/// The derivatives of the volumes of the bodies round a vertex with respect to its position.
struct Slopes {
  std::uint32_t vertex;
  double weight;  ///< the weight of the vertex's moves
  std::vector<std::pair<std::uint32_t, Vec3>> by_body;
};

class Restoration {
 public:
  Restoration(LabelledMesh& mesh, const IdVector<BodyId, double>& volumes, double wanted_quality, double most)
      : mesh_(mesh), wanted_(volumes), wanted_quality_(wanted_quality), most_(most) {
    for (const double volume : volumes) whole_ += volume;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      if (mesh.sides(v).bodies() > 1) free_.push_back(v);
    }
    start_.reserve(free_.size());
    for (const std::uint32_t v : free_) start_.push_back(mesh.point(v));
    give_lost_volumes();
  }

  void run(Progress& progress) {
    double before = std::numeric_limits<double>::infinity();
    for (int step = 0; step <= kMostSteps; ++step) {
      progress.step("restoring volumes", static_cast<double>(step) / (kMostSteps + 1));
      const Eigen::VectorXd missing = wanted_volumes() - volumes();
      if (missing.size() == 0 || missing.cwiseAbs().maxCoeff() <= kEnough * whole_) return;
      // Bodies whose vertices cannot move any further keep their volumes.
      if (!(missing.lpNorm<1>() < kStill * before) || !move(missing)) return;
      before = missing.lpNorm<1>();
    }
  }

 private:
  void give_lost_volumes() {
    const Eigen::VectorXd there = volumes();
    const auto largest = std::max_element(wanted_.begin(), wanted_.end());
    for (std::size_t b = 0; b < wanted_.size(); ++b) {
      if (there[static_cast<Eigen::Index>(b)] > 0 ||
          wanted_.begin() + static_cast<std::ptrdiff_t>(b) == largest)
        continue;
      *largest += std::exchange(wanted_[BodyId(b)], 0.0);
    }
  }

  [[nodiscard]] Eigen::VectorXd wanted_volumes() const {
    return Eigen::Map<const Eigen::VectorXd>(wanted_.data(), static_cast<Eigen::Index>(wanted_.size()));
  }
  [[nodiscard]] Eigen::VectorXd volumes() const {
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(wanted_.size()));
    for (std::uint32_t c = 0; c < mesh_.cell_count(); ++c) {
      if (!mesh_.is_alive(c)) continue;
      const auto& v = mesh_.cell(c).vertices;
      sums[mesh_.cell(c).body.value] +=
          signed_volume(mesh_.point(v[0]), mesh_.point(v[1]), mesh_.point(v[2]), mesh_.point(v[3]));
    }
    return sums;
  }

  [[nodiscard]] Slopes slopes_at(std::uint32_t v) const {
    Slopes slopes{v, 0, {}};
    for (const std::uint32_t c : mesh_.star(v)) {
      LabelledMesh::Tetrahedron t = mesh_.cell(c).vertices;
      // The corners of the face opposite to v are ordered so that the volume with v as the apex is positive.
      const auto place = std::find(t.begin(), t.end(), v) - t.begin();
      if (place % 2 == 0)
        std::swap(t[static_cast<std::size_t>(place + 1) % 4], t[static_cast<std::size_t>(place + 2) % 4]);
      const Vec3 &a = mesh_.point(t[static_cast<std::size_t>(place + 1) % 4]),
                 &b = mesh_.point(t[static_cast<std::size_t>(place + 2) % 4]),
                 &d = mesh_.point(t[static_cast<std::size_t>(place + 3) % 4]);
      const Vec3 slope = (1.0 / 6) * cross(b - a, d - a);
      const std::uint32_t body = mesh_.cell(c).body.value;
      const auto found = std::find_if(slopes.by_body.begin(), slopes.by_body.end(),
                                      [&](const auto& entry) { return entry.first == body; });
      if (found == slopes.by_body.end()) {
        slopes.by_body.emplace_back(body, slope);
      } else {
        found->second += slope;
      }
    }
    double area = 0;
    for (auto& [body, slope] : slopes.by_body) {
      for (int axis = 0; axis < 3; ++axis) {
        if ((mesh_.walls(v) >> (2 * axis) & 3u) != 0) slope[axis] = 0;
      }
      area += norm(slope);
    }
    slopes.weight = area > 0 ? 1 / area : 0;
    return slopes;
  }

  /// Makes one step; returns whether there was a vertex that could move.
  bool move(const Eigen::VectorXd& missing) {
    std::vector<Slopes> slopes;
    std::vector<Eigen::Triplet<double>> entries;
    for (const std::uint32_t v : free_) {
      slopes.push_back(slopes_at(v));
      const Slopes& s = slopes.back();
      for (const auto& [a, slope_a] : s.by_body) {
        for (const auto& [b, slope_b] : s.by_body)
          entries.emplace_back(a, b, s.weight * dot(slope_a, slope_b));
      }
    }
    if (entries.empty()) return false;
    // The equations are singular: the volumes add up to the whole, so one equation follows from the others,
    // and a body that no vertex can change has none.
    double scale = 0;
    for (const auto& entry : entries) scale = std::max(scale, entry.value());
    for (Eigen::Index b = 0; b < missing.size(); ++b) entries.emplace_back(b, b, kRegular * scale);
    Eigen::SparseMatrix<double> matrix(missing.size(), missing.size());
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    const Eigen::VectorXd factors = solver.solve(missing);
    if (solver.info() != Eigen::Success || !factors.allFinite()) return false;
    std::vector<std::uint32_t> still_free;
    std::vector<Vec3> still_start;
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      Vec3 step;
      for (const auto& [body, slope] : slopes[i].by_body) step += slopes[i].weight * factors[body] * slope;
      if (move_vertex(slopes[i].vertex, start_[i], step)) {
        still_free.push_back(slopes[i].vertex);
        still_start.push_back(start_[i]);
      }
    }
    free_ = std::move(still_free);
    start_ = std::move(still_start);
    return true;
  }

  /// Moves a vertex by the step or a part of it; returns false if the vertex stays.
  bool move_vertex(std::uint32_t v, const Vec3& start, Vec3 step) {
    const Vec3 before = mesh_.point(v);
    for (int halving = 0; halving <= kMostHalvings; ++halving, step *= 0.5) {
      mesh_.move(v, before + step);
      if (distance(mesh_.point(v), start) <= most_ && least_quality(mesh_, mesh_.star(v)) >= wanted_quality_)
        return true;
    }
    mesh_.move(v, before);
    return false;
  }

  LabelledMesh& mesh_;
  IdVector<BodyId, double> wanted_;
  double wanted_quality_, most_, whole_ = 0;
  std::vector<std::uint32_t> free_;  ///< the vertices that may still move
  std::vector<Vec3> start_;          ///< their original positions
};

/// Moves vertices where bodies meet so that each body has its volume, up to 1e-11 of the whole. The moves are
/// the shortest ones, with weights inverse to the area round a vertex (Newton's method; the volumes'
/// derivatives are exact). Vertices whose cells would become worse than `wanted_quality` stay, and none moves
/// by more than `most`. The largest body gets the volume of bodies that the mesh does not have.
void restore_volumes(LabelledMesh& mesh, const IdVector<BodyId, double>& volumes, double wanted_quality,
                     double most, Progress& progress) {
  Restoration(mesh, volumes, wanted_quality, most).run(progress);
}

}  // namespace

double default_cut_tolerance(const ResampledMesh& mesh, double interface_error) {
  // A mesh of planes has no error from which a tolerance follows.
  const double least = 1e-4 * mesh.box.diagonal();
  return std::max(kCutTolerance * interface_error, least);
}

ConformingMesh cut_mesh(const ResampledMesh& mesh, double tolerance, Progress& progress) {
  const LoopProgress loops(progress);
  const ExtractedInterfaces wanted = approximated_interfaces(mesh, progress);
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

CutMeshExamination examine_cut_mesh(const ConformingMesh& cut, const ResampledMesh& mesh, double target,
                                    Progress& progress) {
  const LoopProgress loops(progress);
  CutMeshExamination report;
  report.dihedral = dihedral_range(cut);
  const ExtractedInterfaces of_mesh = approximated_interfaces(mesh, progress);
  const ExtractedInterfaces of_cut = interfaces_of(cut, mesh.table);
  const std::size_t bodies = mesh.table.body_count();
  const auto before = body_topology(of_mesh, bodies, mesh.box);
  const auto after = body_topology(of_cut, bodies, mesh.box);
  const auto volumes = body_volumes(mesh.table, mesh.cell_set()), cut_volumes = body_volumes(cut, bodies);
  for (BodyId b(0); b.value < bodies; ++b.value) {
    report.volume_difference = std::max(report.volume_difference, std::abs(cut_volumes[b] - volumes[b]));
    if (before[b] != after[b]) report.changed.push_back({b, before[b], after[b], volumes[b]});
  }
  if (of_mesh.mesh.triangles.empty()) return report;
  InterfaceComparison comparison(of_mesh.mesh, mesh.box, true, target);
  comparison.measure(of_cut.mesh, progress);
  report.distance = comparison.finish(progress);
  return report;
}

}  // namespace adamas::interfaces
