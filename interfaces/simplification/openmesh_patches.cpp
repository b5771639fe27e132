#include "interfaces/simplification/openmesh_patches.h"

#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>

#include "adamas/openmesh.h"
#include "core/base/error.h"

namespace adamas::interfaces {

namespace {

/// Silences OpenMesh's messages on stderr about refused operations; callers here check for these themselves.
void silence_openmesh() {
  static std::once_flag once;
  std::call_once(once, [] {
    omlog().disable();
    omout().disable();
    omerr().disable();
  });
}

/// Returns the triangles with bodies in place of materials.
InterfaceTriangles with_bodies(const InterfaceMesh& mesh, const std::vector<std::array<BodyId, 2>>& sides) {
  InterfaceTriangles result;
  result.points = mesh.points;
  result.triangles.reserve(sides.size()), result.sides.reserve(sides.size());
  for (std::size_t t = 0; t < sides.size(); ++t) {
    result.triangles.push_back(mesh.triangles[t].points);
    result.sides.push_back({sides[t][0].value, sides[t][1].value});
  }
  return result;
}

}  // namespace

std::vector<InterfacePatch> to_openmesh(const InterfaceMesh& mesh,
                                        const std::vector<std::array<BodyId, 2>>& sides) {
  silence_openmesh();
  if (sides.size() != mesh.triangles.size())
    fail("{}: expected the bodies of {} triangles, found those of {}", mesh.source, mesh.triangles.size(),
         sides.size());
  std::vector<InterfacePatch> patches;
  for (auto& [front, back, surface, vertex_origin, face_origin] :
       adamas::to_openmesh<PatchMesh>(with_bodies(mesh, sides))) {
    patches.push_back({BodyId(front), BodyId(back), std::move(surface)});
    InterfacePatch& patch = patches.back();
    for (const auto vertex : patch.mesh.vertices())
      patch.mesh.data(vertex).point = patch.mesh.property(vertex_origin, vertex).number;
    for (const auto face : patch.mesh.faces())
      patch.mesh.data(face).triangle = patch.mesh.property(face_origin, face).number;
    patch.mesh.remove_property(vertex_origin);
    patch.mesh.remove_property(face_origin);
  }
  return patches;
}

JoinedPatches from_openmesh(const std::vector<InterfacePatch>& patches,
                            const IdVector<BodyId, MaterialId>& body_materials,
                            const IdVector<MaterialId, std::string>& materials) {
  struct Place {
    std::uint32_t triangle, patch;
    int face;
  };
  std::vector<Place> places;
  std::map<std::uint32_t, Vec3> points;
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    const PatchMesh& mesh = patches[p].mesh;
    for (const auto face : mesh.faces()) {
      if (mesh.status(face).deleted()) continue;
      places.push_back({mesh.data(face).triangle, p, face.idx()});
      for (const auto vertex : mesh.fv_range(face))
        points.emplace(mesh.data(vertex).point, from_openmesh(mesh.point(vertex)));
    }
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return std::tie(a.triangle, a.patch, a.face) < std::tie(b.triangle, b.patch, b.face);
  });
  JoinedPatches result;
  result.mesh.materials = materials;
  for (const auto& [number, place] : points) {
    result.points.push_back(number);
    result.mesh.points.push_back(place);
  }
  const auto position = [&result](std::uint32_t number) {
    const auto found = std::lower_bound(result.points.begin(), result.points.end(), number);
    return static_cast<std::uint32_t>(found - result.points.begin());
  };
  for (const Place& place : places) {
    const InterfacePatch& patch = patches[place.patch];
    InterfaceTriangle triangle{{}, body_materials[patch.front], body_materials[patch.back]};
    std::size_t c = 0;
    for (const auto vertex : patch.mesh.fv_range(PatchMesh::FaceHandle(place.face)))
      triangle.points[c++] = position(patch.mesh.data(vertex).point);
    result.mesh.triangles.push_back(triangle);
    result.sides.push_back({patch.front, patch.back});
  }
  return result;
}

}  // namespace adamas::interfaces
