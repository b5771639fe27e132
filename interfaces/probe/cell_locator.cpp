#include "interfaces/probe/cell_locator.h"

#include <algorithm>

#include "core/geometry/tetrahedron.h"

namespace adamas::interfaces {

namespace {

std::vector<Box3> cell_boxes(const ResampledMesh& mesh) {
  std::vector<Box3> boxes(mesh.cells.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (const std::uint32_t v : mesh.cells[i].vertices) boxes[i].extend(mesh.points[v]);
  }
  return boxes;
}

}  // namespace

CellLocator::CellLocator(const ResampledMesh& mesh) : mesh_(mesh), tree_(cell_boxes(mesh)) {}

std::optional<CellLocator::Location> CellLocator::locate(const Vec3& p) const {
  // The cells' corners are exact, so the box of the cell that holds the point contains the point.
  return nearest_within(p, 0, [](std::uint32_t) { return true; });
}

std::optional<CellLocator::Location> CellLocator::nearest(
    const Vec3& p, const std::function<bool(std::uint32_t)>& accept) const {
  const double diagonal = mesh_.box.diagonal();
  for (double radius = 0;; radius = std::min(std::max(4 * radius, 1e-3 * diagonal), diagonal)) {
    if (const auto found = nearest_within(p, radius, accept)) return found;
    if (radius >= diagonal) return std::nullopt;
  }
}

std::optional<CellLocator::Location> CellLocator::nearest_within(
    const Vec3& p, double radius, const std::function<bool(std::uint32_t)>& accept) const {
  if (!mesh_.box.contains(p)) return std::nullopt;
  thread_local std::vector<std::uint32_t> candidates;
  tree_.near(p, radius, candidates);
  std::optional<Location> best;
  double greatest = 0;
  for (const std::uint32_t cell : candidates) {
    if (!accept(cell)) continue;
    const Weights w = Tetrahedron(mesh_.corners(cell)).weights(p);
    const double least = std::min({w[0], w[1], w[2], w[3]});
    if (!best || least > greatest) best = Location{cell, w}, greatest = least;
    if (least >= 0) return Location{cell, w};
  }
  return best;
}

}  // namespace adamas::interfaces
