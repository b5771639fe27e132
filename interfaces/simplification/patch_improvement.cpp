#include "interfaces/simplification/patch_improvement.h"

#include <algorithm>

#include "interfaces/simplification/openmesh_patches.h"
#include "interfaces/simplification/surface_guard.h"

namespace adamas {

namespace {

/// Flips that gain less than this, in degrees, are not worth it, and could go on for ever.
constexpr double kLeastGain = 0.01;
constexpr int kMostFlipPasses = 10, kSmoothingPasses = 5;
/// The parts of the way to the middle that are tried.
constexpr double kSteps[] = {1, 0.5, 0.25};

using Vertex = PatchMesh::VertexHandle;

/// The two triangles at an edge a-b, with c and d opposite, as OpenMesh flips them.
SurfaceChange flip_change(const PatchMesh& mesh, PatchMesh::EdgeHandle edge) {
  const auto first = mesh.halfedge_handle(edge, 0), second = mesh.halfedge_handle(edge, 1);
  const auto point = [&mesh](Vertex v) { return mesh.data(v).point; };
  const std::uint32_t a = point(mesh.from_vertex_handle(first)), b = point(mesh.to_vertex_handle(first)),
                      c = point(mesh.to_vertex_handle(mesh.next_halfedge_handle(first))),
                      d = point(mesh.to_vertex_handle(mesh.next_halfedge_handle(second)));
  const std::uint32_t f = mesh.data(mesh.face_handle(first)).triangle,
                      g = mesh.data(mesh.face_handle(second)).triangle;
  SurfaceChange change;
  change.old_faces = {f, g};
  change.faces = {{f, {a, d, c}}, {g, {d, b, c}}};
  return change;
}

}  // namespace

std::size_t flip_edges(InterfacePatch& patch, SurfaceGuard& guard, const Progress& progress) {
  PatchMesh& mesh = patch.mesh;
  std::size_t flips = 0;
  for (int pass = 0; pass < kMostFlipPasses; ++pass) {
    progress.check();
    const std::size_t before = flips;
    for (const auto edge : mesh.edges()) {
      if (mesh.status(edge).deleted() || mesh.is_boundary(edge) || !mesh.is_flip_ok(edge)) continue;
      SurfaceChange change = flip_change(mesh, edge);
      change.angle_above = guard.smallest_angle(change.old_faces) + kLeastGain;
      if (!guard.allows(change)) continue;
      guard.apply(change);
      mesh.flip(edge);
      ++flips;
    }
    if (flips == before) break;
  }
  return flips;
}

std::size_t smooth_points(InterfacePatch& patch, const ClosestPointTree& original, SurfaceGuard& guard,
                          const Progress& progress) {
  PatchMesh& mesh = patch.mesh;
  std::size_t moves = 0;
  for (int pass = 0; pass < kSmoothingPasses; ++pass) {
    progress.check();
    for (const Vertex vertex : mesh.vertices()) {
      if (mesh.status(vertex).deleted() || mesh.status(vertex).locked()) continue;
      SurfaceChange change;
      for (const auto face : mesh.vf_range(vertex)) {
        SurfaceChange::Face same{mesh.data(face).triangle, {}};
        std::size_t c = 0;
        for (const Vertex corner : mesh.fv_range(face)) same.corners[c++] = mesh.data(corner).point;
        change.old_faces.push_back(same.face);
        change.faces.push_back(same);
      }
      Vec3 middle;
      double neighbours = 0;
      for (const Vertex other : mesh.vv_range(vertex))
        middle += from_openmesh(mesh.point(other)), ++neighbours;
      middle = 1 / neighbours * middle;
      const Vec3 from = from_openmesh(mesh.point(vertex));
      change.angle_above = guard.smallest_angle(change.old_faces);
      for (const double step : kSteps) {
        const auto closest = original.closest(from + step * (middle - from));
        if (!closest) break;
        change.move = {mesh.data(vertex).point, closest->point};
        if (!guard.allows(change)) continue;
        guard.apply(change);
        mesh.set_point(vertex, to_openmesh(closest->point));
        ++moves;
        break;
      }
    }
  }
  return moves;
}

}  // namespace adamas
