#include "viewer/contents/interface_places.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace adamas::viewer {

using namespace interfaces;

namespace {

constexpr std::size_t kChunk = 1024;
/// The distance from an interface at which its sides are searched, relative to the diagonal of the box: far
/// above round-off, far below any cell.
constexpr double kBeside = 1e-9;

/// The bodies that own a part of each cell.
class CellOwners {
 public:
  explicit CellOwners(const ResampledMesh& mesh) {
    std::vector<std::vector<BodyId>> parts((mesh.cells.size() + kChunk - 1) / kChunk);
    starts_.resize(mesh.cells.size() + 1);
    parallel_chunks(mesh.cells.size(), kChunk, [&](std::size_t first, std::size_t last) {
      CellOwnership ownership;
      for (std::size_t c = first; c < last; ++c) {
        mesh.ownership(c, ownership);
        if (!ownership.pure()) keep_owners(ownership.problem);
        for (const auto& candidate : ownership.problem.candidates)
          parts[first / kChunk].emplace_back(candidate.owner);
        starts_[c + 1] = ownership.problem.candidates.size();
      }
    });
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) starts_[c + 1] += starts_[c];
    bodies_.reserve(starts_.back());
    for (const auto& part : parts) bodies_.insert(bodies_.end(), part.begin(), part.end());
  }

  [[nodiscard]] bool owns(BodyId body, std::size_t cell) const {
    for (std::size_t i = starts_[cell]; i < starts_[cell + 1]; ++i) {
      if (bodies_[i] == body) return true;
    }
    return false;
  }

 private:
  std::vector<BodyId> bodies_;
  std::vector<std::size_t> starts_;  ///< cell c has the bodies starts_[c] to starts_[c + 1]
};

Vec3 clamped(const Box3& box, const Vec3& p) {
  return {std::clamp(p.x, box.min.x, box.max.x), std::clamp(p.y, box.min.y, box.max.y),
          std::clamp(p.z, box.min.z, box.max.z)};
}

class PlaceFinder {
 public:
  PlaceFinder(const ResampledMesh& mesh, const CellLocator& locator, const ExtractedInterfaces& interfaces)
      : mesh_(mesh), locator_(locator), interfaces_(interfaces), owners_(mesh) {}

  /// Finds the place of a triangle, which lies in one cell with all of its points; the bodies' own rows at
  /// the cell's corners are the same for its neighbours.
  [[nodiscard]] InterfacePlace place(std::uint32_t triangle) const {
    const auto& [a, b, c] = interfaces_.mesh.triangles[triangle].points;
    const std::vector<Vec3>& points = interfaces_.mesh.points;
    const Vec3 forward = normalized(cross(points[b] - points[a], points[c] - points[a]));
    const Vec3 middle = interfaces_.mesh.centroid(triangle);
    const auto [front, back] = interfaces_.bodies[triangle];
    const double beside = kBeside * mesh_.box.diagonal();
    InterfacePlace result;
    result.sides[0] = {front, cell(middle + beside * forward, front)};
    const std::uint32_t found = result.sides[0].cell;
    const bool has_both = found != InterfacePlace::kNoCell && owners_.owns(back, found);
    result.sides[1] = {back, has_both ? found : cell(middle - beside * forward, back)};
    const InterfaceTriangle& turned = interfaces_.mesh.triangles[triangle];
    if (turned.back < turned.front) std::swap(result.sides[0], result.sides[1]);
    return result;
  }

 private:
  [[nodiscard]] std::uint32_t cell(const Vec3& p, BodyId body) const {
    const auto found =
        locator_.nearest(clamped(mesh_.box, p), [&](std::uint32_t c) { return owners_.owns(body, c); });
    return found ? found->cell : InterfacePlace::kNoCell;
  }

  const ResampledMesh& mesh_;
  const CellLocator& locator_;
  const ExtractedInterfaces& interfaces_;
  CellOwners owners_;
};

}  // namespace

std::vector<std::vector<InterfacePlace>> interface_places(const ResampledMesh& mesh,
                                                          const CellLocator& locator,
                                                          const ExtractedInterfaces& interfaces,
                                                          std::span<const PairSurface> surfaces) {
  const PlaceFinder finder(mesh, locator, interfaces);
  std::vector<std::vector<InterfacePlace>> places(surfaces.size());
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const auto& vertices = surfaces[s].vertices;
    places[s].resize(vertices.size());
    parallel_for(vertices.size(), kChunk,
                 [&](std::size_t v) { places[s][v] = finder.place(vertices[v].triangle); });
  }
  return places;
}

}  // namespace adamas::viewer
