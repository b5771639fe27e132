#include "viewer/contents/section_meshes.h"

#include <vector>

#include "core/base/error.h"
#include "core/geometry/plane_sides.h"
#include "viewer/contents/mesh_maker.h"

namespace adamas::viewer {

using namespace interfaces;

namespace {

/// Adds a convex polygon as a fan of triangles.
void add_piece(const SectionPiece& piece, const Vec3& normal, MeshMaker& maker) {
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < piece.corners.size(); ++i) {
    MeshMaker::Values values;
    if (!piece.values.empty()) values = {piece.values[i], piece.values[i]};
    const std::uint32_t vertex = maker.add_vertex(piece.corners[i], normal, values);
    if (i == 0) first = vertex;
    if (i < 2) continue;
    for (const std::uint32_t corner : {first, vertex - 1, vertex}) maker.add_index(corner);
  }
}

SharedMesh lines(const std::vector<Segment>& segments, const Vec3& normal, const Vec3& origin) {
  MeshMaker maker(origin, MeshMaker::Kind::kLines);
  for (const Segment& segment : segments) {
    for (const Vec3& end : segment) maker.add_index(maker.add_vertex(end, normal, {}));
  }
  return maker.finish();
}

}  // namespace

bool cuts(const Plane& plane, const Box3& box) {
  try {
    const PlaneSides sides(plane, box, "");
    return true;
  } catch (const Error&) {
    return false;
  }
}

MaterialContents::Section section_meshes(const CrossSection& section, const Plane& plane,
                                         const Vec3& origin) {
  const Vec3 normal = normalized(plane.normal);
  std::vector<MeshMaker> makers(section.material_area.size(), MeshMaker(origin, MeshMaker::Kind::kTriangles));
  for (const SectionPiece& piece : section.pieces) add_piece(piece, normal, makers[piece.material.value]);
  MaterialContents::Section result;
  for (MeshMaker& maker : makers) result.materials.push_back(maker.finish());
  result.cell_edges = lines(section.cell_edges, normal, origin);
  result.interface_edges = lines(section.interface_edges, normal, origin);
  return result;
}

}  // namespace adamas::viewer
