#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "adamas/openmesh.h"
#include "core/data/interface_mesh.h"

namespace adamas::interfaces {

/// OpenMesh's traits: coordinates are in double precision. Elements have the numbers of their origins, for
/// OpenMesh's modules, which know nothing but the mesh.
struct PatchTraits : OpenMesh::DefaultTraitsDouble {
  VertexAttributes(OpenMesh::Attributes::Status);
  HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge | OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
  VertexTraits { std::uint32_t point = 0; };
  FaceTraits { std::uint32_t triangle = 0; };
};
using PatchMesh = OpenMesh::TriMesh_ArrayKernelT<PatchTraits>;

/// An interface between two bodies as an OpenMesh mesh, or a part of it; the bodies are known.
struct InterfacePatch : OpenMeshInterface<PatchMesh> {
  /// Return the body that the normals point to, and the one behind them.
  [[nodiscard]] BodyId front_body() const { return BodyId(bodies.value()[0]); }
  [[nodiscard]] BodyId back_body() const { return BodyId(bodies.value()[1]); }
};

inline OpenMesh::Vec3d to_openmesh(const Vec3& p) { return {p.x, p.y, p.z}; }
inline Vec3 from_openmesh(const OpenMesh::Vec3d& p) { return {p[0], p[1], p[2]}; }

/// Makes one patch or more per pair of bodies, as adamas::to_openmesh does (adamas/openmesh.h). `bodies`:
/// those in front of each triangle and behind it.
std::vector<InterfacePatch> to_openmesh(const InterfaceMesh& mesh,
                                        const std::vector<std::array<BodyId, 2>>& bodies);

/// The triangles of patches on shared points.
struct JoinedPatches {
  InterfaceMesh mesh;
  std::vector<std::array<BodyId, 2>> bodies;  ///< those in front of each triangle and behind it
};

/// Joins patches as adamas::from_openmesh does. `materials`: their names. `source`: the name of the mesh.
JoinedPatches from_openmesh(std::vector<InterfacePatch> patches,
                            const IdVector<MaterialId, std::string>& materials, const std::string& source);

}  // namespace adamas::interfaces
