#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/base/error.h"
#include "interfaces/comparison/comparison_run.h"

namespace adamas::interfaces {

/// Curves are approximated by edges of this size: the deviation of such an edge from a circle as large as a
/// quarter of the box is about the facet distance.
Mesh3Criteria Comparison::criteria(double facet_distance) const {
  const Vec3 size = source_.box.size();
  const double bend = 0.25 * std::min({size.x, size.y, size.z});
  Mesh3Criteria result;
  result.facet_distance = facet_distance;
  result.edge_size = std::sqrt(8 * facet_distance * bend);
  return result;
}

SizingTrial Comparison::try_mesh3(const OwnMesh& own, double facet_distance, const Mesher& make,
                                  Mesh3Match& match) {
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
  ReferenceResult result = make(sizes);
  measure(result, *row.interface_error, row);
  const bool made = row.failure.empty();
  const double distance = matched_distance(row, own), wanted = matched_distance(own.row, own);
  const double mismatch = made ? std::abs(std::log(distance / wanted)) : std::numeric_limits<double>::max();
  if (trial == 1 || mismatch < match.mismatch)
    match = {row, sizes, std::move(result), mismatch, trial, false};
  if (made) return {Outcome::kMeasured, distance};
  return {row.failure.starts_with("lost") ? Outcome::kTooCoarse : Outcome::kTooFine, 0};
}

/// Searches the size with which the row of a match has the distance of the resampled mesh, unless it has
/// failed already.
void Comparison::match_mesh3(const OwnMesh& own, const Mesher& make, Mesh3Match& match) {
  ComparedMesh& row = match.row;
  const double wanted = matched_distance(own.row, own);
  if (row.failure.empty() && (own.interfaces.empty() || !std::isfinite(wanted)))
    row.failure = "there is no distance to match";
  const std::string known = row.note;
  if (row.failure.empty()) {
    // If the distance is nearly 0, the search begins with the coarsest possible size.
    const bool exact = own.row.figures.distance.greatest() < wanted;
    const double first = 0.5 * (exact ? *row.interface_error : wanted);
    SizingOptions sizing;
    sizing.greatest = source_.box.diagonal();
    start_clock();
    search_sizing(
        wanted, first, [&](double size) { return try_mesh3(own, size, make, match); }, sizing);
  }
  row.trials = match.trials;
  const auto add = [&row](const std::string& text) { row.note += (row.note.empty() ? "" : "; ") + text; };
  if (match.over)
    add(fmt::format("the time limit of {:g} s ended the search", options_.mesher.limits.seconds));
  // Each trial begins with its own note.
  if (!known.empty() && match.trials > 0) add(known);
  if (row.failure.empty()) measure_chosen(match.result, own, row);
  finish(row, own);
}

void Comparison::add_mesh3(const OwnMesh& own) {
  Mesh3Match match;
  match.row.kind = MeshKind::kMesh3;
  match.row.interface_error = own.row.interface_error;
  match.row.failure = input_fault_;
  match_mesh3(
      own, [this](const Mesh3Criteria& sizes) { return mesh_by_mesh3(*input_, sizes, mesher(), progress_); },
      match);
  if (match.row.failure.empty()) add_optimised(own, match);
}

/// Interfaces are simplified within half of the error: the other half is for Mesh_3, which approximates them.
void Comparison::add_mesh3_simplified(const OwnMesh& own) {
  Mesh3Match match;
  match.row.kind = MeshKind::kMesh3Simplified;
  match.row.interface_error = own.row.interface_error;
  std::optional<PiecewiseLinearComplex> complex;
  try {
    complex = simplified_input(0.5 * *own.row.interface_error, match.row.note);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    match.row.failure = error.what();
  }
  match_mesh3(
      own, [&](const Mesh3Criteria& sizes) { return mesh_by_mesh3(*complex, sizes, mesher(), progress_); },
      match);
}

/// The label is the material of a tetrahedron. Its body is the one at its centroid if it has that material,
/// else the first of that material.
ReferenceResult Comparison::mesh_labels(const Mesh3Criteria& sizes) const {
  ReferenceResult result = mesh_by_mesh3(*options_.image, sizes, mesher(), progress_);
  const InterfaceTable& table = source_.network->table();
  std::map<MaterialId, BodyId> first;
  for (BodyId b(0); b.value < table.body_count(); ++b.value) first.try_emplace(table.material(b), b);
  for (std::size_t t = 0; t < result.mesh.bodies.size(); ++t) {
    const MaterialId material(result.mesh.bodies[t].value);
    const auto c = result.mesh.corners(t);
    const BodyId there = source_.body_at(0.25 * (c[0] + c[1] + c[2] + c[3]), nullptr);
    const auto found = first.find(material);
    if (found == first.end()) {
      result.failure = "made tetrahedra of a material that has no body";
      break;
    }
    result.mesh.bodies[t] = table.material(there) == material ? there : found->second;
  }
  return result;
}

void Comparison::add_mesh3_labels(const OwnMesh& own) {
  Mesh3Match match;
  match.row.kind = MeshKind::kMesh3Labels;
  match.row.interface_error = own.row.interface_error;
  match_mesh3(
      own, [this](const Mesh3Criteria& sizes) { return mesh_labels(sizes); }, match);
}

void Comparison::add_optimised(const OwnMesh& own, const Mesh3Match& match) {
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
  if (row.failure.empty()) measure_chosen(result, own, row);
  finish(row, own);
}

}  // namespace adamas::interfaces
