#include "interfaces/simplification/openmesh_patches.h"

#include <iterator>
#include <utility>

namespace adamas::interfaces {

std::vector<InterfacePatch> to_openmesh(const InterfaceMesh& mesh,
                                        const std::vector<std::array<BodyId, 2>>& bodies) {
  std::vector<InterfacePatch> patches;
  for (auto& interface :
       adamas::to_openmesh<PatchMesh>(to_interface_triangles(InterfaceMesh(mesh), bodies))) {
    InterfacePatch& patch = patches.emplace_back(InterfacePatch{std::move(interface)});
    for (const auto vertex : patch.mesh.vertices())
      patch.mesh.data(vertex).point = patch.mesh.property(patch.vertex_origin, vertex).number;
    for (const auto face : patch.mesh.faces())
      patch.mesh.data(face).triangle = patch.mesh.property(patch.face_origin, face).number;
  }
  return patches;
}

JoinedPatches from_openmesh(std::vector<InterfacePatch> patches,
                            const IdVector<MaterialId, std::string>& materials, const std::string& source) {
  std::vector<OpenMeshInterface<PatchMesh>> interfaces(std::make_move_iterator(patches.begin()),
                                                       std::make_move_iterator(patches.end()));
  const InterfaceTriangles joined =
      adamas::from_openmesh(interfaces, std::vector<std::string>(materials.begin(), materials.end()));
  JoinedPatches result{to_interface_mesh(joined, source), {}};
  result.bodies.reserve(joined.bodies.size());
  for (const auto& [front, back] : joined.bodies) result.bodies.push_back({BodyId(front), BodyId(back)});
  return result;
}

}  // namespace adamas::interfaces
