#include "interfaces/reference/comparison.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "interfaces/reference/own_mesh.h"
#include "interfaces/reference/sizing_search.h"

namespace adamas {

namespace {

using Clock = std::chrono::steady_clock;

/// Distances below this part of the error wanted are measured no further, and all the same.
constexpr double kResolution = 0.01;
/// Points that are nearer to a side of the box than this part of its diagonal are moved onto it.
constexpr double kOntoBox = 1e-9;
/// A last try gets as much, so that a limit is told by the child that reaches it.
constexpr double kLeastSeconds = 0.01;

/// What sizes are matched by.
double matched_distance(const ComparedMesh& row) {
  return std::max(row.figures.distance.greatest(), kResolution * *row.interface_error);
}

class Comparison {
 public:
  Comparison(const ResamplingSource& source, const ComparisonOptions& options, Progress& progress)
      : source_(source), options_(options), progress_(progress) {}

  std::vector<ComparedMesh> run() {
    bool first = true;
    for (const double error : options_.interface_errors) {
      ResamplingOptions wanted = options_.resampling;
      wanted.interface_error = error;
      const OwnMesh own = make_own_mesh(source_, wanted, progress_);
      finish(own.row);
      finish(own.cut_row);
      if (std::exchange(first, false)) {
        stitch_input();
        if (options_.tetgen) add_untouched(own);
      }
      if (options_.tetgen) add_resampled(own);
      if (options_.mesh3) add_mesh3(own);
    }
    return std::move(rows_);
  }

 private:
  void finish(const ComparedMesh& row) {
    rows_.push_back(row);
    if (options_.finished) options_.finished(row);
  }
  void start_clock() { started_ = Clock::now(); }
  [[nodiscard]] double seconds_left() const {
    return options_.mesher.limits.seconds - std::chrono::duration<double>(Clock::now() - started_).count();
  }
  /// The time that is left of one mesh's.
  [[nodiscard]] MesherOptions mesher() const {
    MesherOptions result = options_.mesher;
    result.limits.whole_seconds = result.limits.seconds;
    result.limits.seconds = std::max(seconds_left(), kLeastSeconds);
    return result;
  }
  void stitch_input();
  [[nodiscard]] PiecewiseLinearComplex stitch(std::span<const Vec3> points,
                                              std::span<const BodyTriangle> triangles) const;
  ReferenceResult run_tetgen(const PiecewiseLinearComplex& complex, ComparedMesh& row);
  void add_tetgen(const PiecewiseLinearComplex& complex, const OwnMesh& own, ComparedMesh& row);
  void add_untouched(const OwnMesh& own);
  void add_resampled(const OwnMesh& own);
  void add_mesh3(const OwnMesh& own);
  /// The trial of Mesh_3 that came closest.
  struct Mesh3Match {
    ComparedMesh row;
    Mesh3Criteria criteria;
    ReferenceResult result;
    double mismatch = 0;
    std::size_t trials = 0;
    bool over = false;  ///< the time ended the search
  };
  SizingTrial try_mesh3(double wanted, double facet_distance, Mesh3Match& match);
  void add_optimised(const OwnMesh& own, const Mesh3Match& match, double wanted);
  void measure(const ReferenceResult& result, double target, ComparedMesh& row);
  void measure_fields(const ReferenceResult& result, const OwnMesh& own, ComparedMesh& row);
  [[nodiscard]] std::string lost_materials(const MeshFigures& figures) const;
  [[nodiscard]] Mesh3Criteria criteria(double facet_distance) const;

  const ResamplingSource& source_;
  const ComparisonOptions& options_;
  Progress& progress_;
  std::vector<ComparedMesh> rows_;
  std::optional<PiecewiseLinearComplex> input_;
  std::string input_fault_;
  Clock::time_point started_ = Clock::now();  ///< work on one mesh of another generator
};

PiecewiseLinearComplex Comparison::stitch(std::span<const Vec3> points,
                                          std::span<const BodyTriangle> triangles) const {
  return stitch_to_box(source_.name, points, triangles, source_.box, kOntoBox * source_.box.diagonal(),
                       [this](const Vec3& p) { return source_.body_at(p, nullptr); });
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

/// A mesh without a part of the input is no mesh of it.
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
  for (std::size_t t = 0; t < figures.tetrahedra; ++t) figures.dihedral.add(result.mesh.corners(t));
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

void Comparison::measure_fields(const ReferenceResult& result, const OwnMesh& own, ComparedMesh& row) {
  if (!source_.fields) return;
  const auto start = Clock::now();
  const std::vector<VertexRecord> vertices = fields_at_vertices(result.mesh, source_);
  row.field_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  row.figures.fields =
      measure_element_errors(source_, measured_cells(result.mesh, vertices), own.half_width, progress_)
          .figures(own.at_interface);
}

/// With the switches wanted; where TetGen crashes or loses something, once more with the least tolerance,
/// since interfaces in cells have triangles that are almost flat, and once more without its sorting of
/// points, which some inputs of few points do not survive.
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
  if (row.failure.empty()) measure_fields(result, own, row);
}

void Comparison::add_untouched(const OwnMesh& own) {
  ComparedMesh row;
  row.kind = MeshKind::kTetGenUntouched;
  row.failure = input_fault_;
  if (input_) add_tetgen(*input_, own, row);
  if (row.failure.empty())
    row.note += std::string(row.note.empty() ? "" : "; ") +
                "distance 0 by construction, but for facets joined that are coplanar within 0.1 degrees";
  finish(row);
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
  finish(row);
}

/// Curves are followed by edges of this size, so that their arrows are about the distance where they are bent
/// like a circle of a quarter of the box.
Mesh3Criteria Comparison::criteria(double facet_distance) const {
  const Vec3 size = source_.box.size();
  const double bend = 0.25 * std::min({size.x, size.y, size.z});
  Mesh3Criteria result;
  result.facet_distance = facet_distance;
  result.edge_size = std::sqrt(8 * facet_distance * bend);
  return result;
}

SizingTrial Comparison::try_mesh3(double wanted, double facet_distance, Mesh3Match& match) {
  using Outcome = SizingTrial::Outcome;
  if (match.trials > 0 && seconds_left() <= 0) {
    match.over = true;
    return {Outcome::kOver, 0};
  }
  ComparedMesh row = match.row;
  row.failure.clear(), row.note.clear(), row.figures = {};
  const Mesh3Criteria sizes = criteria(facet_distance);
  row.switches =
      fmt::format("facet_distance {:.4g}, edge_size {:.4g}, facet_angle {:g}, radius_edge_ratio {:g}",
                  sizes.facet_distance, sizes.edge_size, sizes.facet_angle, sizes.radius_edge_ratio);
  const std::size_t trial = ++match.trials;
  progress_.step(fmt::format("meshing by Mesh_3, trial {}", trial), -1);
  ReferenceResult result = mesh_by_mesh3(*input_, sizes, mesher(), progress_);
  measure(result, *row.interface_error, row);
  const bool made = row.failure.empty();
  const double distance = matched_distance(row);
  const double mismatch = made ? std::abs(std::log(distance / wanted)) : std::numeric_limits<double>::max();
  if (trial == 1 || mismatch < match.mismatch)
    match = {row, sizes, std::move(result), mismatch, trial, false};
  if (made) return {Outcome::kMeasured, distance};
  return {row.failure.starts_with("lost") ? Outcome::kTooCoarse : Outcome::kTooFine, 0};
}

void Comparison::add_mesh3(const OwnMesh& own) {
  Mesh3Match match;
  ComparedMesh& row = match.row;
  row.kind = MeshKind::kMesh3;
  row.interface_error = own.row.interface_error;
  row.failure = input_fault_;
  const double wanted = matched_distance(own.row);
  if (input_ && (own.interfaces.empty() || !std::isfinite(wanted)))
    row.failure = "there is no distance to match";
  bool matched = false;
  if (row.failure.empty()) {
    // Where there is next to no distance, sizes that are as coarse as may be come first.
    const bool exact = wanted <= kResolution * *row.interface_error;
    const double first = 0.5 * (exact ? *row.interface_error : wanted);
    SizingOptions sizing;
    sizing.greatest = source_.box.diagonal();
    start_clock();
    matched = search_sizing(
        wanted, first, [&](double size) { return try_mesh3(wanted, size, match); }, sizing);
  }
  row.matched = matched;
  row.trials = match.trials;
  if (match.over)
    row.note += fmt::format("{}the time limit of {:g} s ended the search", row.note.empty() ? "" : "; ",
                            options_.mesher.limits.seconds);
  if (row.failure.empty()) measure_fields(match.result, own, row);
  finish(row);
  if (row.failure.empty()) add_optimised(own, match, wanted);
}

void Comparison::add_optimised(const OwnMesh& own, const Mesh3Match& match, double wanted) {
  ComparedMesh row = match.row;
  row.kind = MeshKind::kMesh3Optimised;
  row.switches += ", perturb, exude";
  row.note.clear(), row.trials = 0, row.figures = {};
  Mesh3Criteria sizes = match.criteria;
  sizes.optimise = 1;
  progress_.step("meshing by Mesh_3 with optimisers", -1);
  start_clock();
  const ReferenceResult result = mesh_by_mesh3(*input_, sizes, mesher(), progress_);
  measure(result, *row.interface_error, row);
  row.matched = std::abs(matched_distance(row) / wanted - 1) <= SizingOptions().tolerance;
  if (row.failure.empty()) measure_fields(result, own, row);
  finish(row);
}

}  // namespace

std::string mesh_name(MeshKind kind) {
  switch (kind) {
    case MeshKind::kOwn:
      return "adamas";
    case MeshKind::kOwnCut:
      return "adamas cut";
    case MeshKind::kTetGen:
      return "TetGen (our interfaces)";
    case MeshKind::kTetGenUntouched:
      return "TetGen (input's)";
    case MeshKind::kMesh3:
      return "Mesh_3";
    case MeshKind::kMesh3Optimised:
      return "Mesh_3 optimised";
  }
  return "";
}

std::size_t reference_count(const ComparisonOptions& options) {
  const std::size_t errors = options.interface_errors.size();
  return (options.tetgen ? 1 + errors : 0) + (options.mesh3 ? 2 * errors : 0);
}

std::vector<ComparedMesh> compare_meshes(const ResamplingSource& source, const ComparisonOptions& options,
                                         Progress& progress) {
  return Comparison(source, options, progress).run();
}

}  // namespace adamas
