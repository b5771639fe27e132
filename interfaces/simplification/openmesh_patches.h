#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <array>
#include <cstdint>
#include <vector>

#include "core/data/interface_mesh.h"
#include "interfaces/network/bodies.h"

namespace adamas::interfaces {

/// OpenMesh's traits: coordinates are in double precision, and elements have their numbers in the original
/// mesh.
struct PatchTraits : OpenMesh::DefaultTraitsDouble {
  VertexAttributes(OpenMesh::Attributes::Status);
  HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge | OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
  VertexTraits { std::uint32_t point = 0; };
  FaceTraits { std::uint32_t triangle = 0; };
};
using PatchMesh = OpenMesh::TriMesh_ArrayKernelT<PatchTraits>;

/// An interface between two bodies as an OpenMesh mesh, or a part of it; its normals point to `front`.
struct InterfacePatch {
  BodyId front, back;
  PatchMesh mesh;
};

inline OpenMesh::Vec3d to_openmesh(const Vec3& p) { return {p.x, p.y, p.z}; }
inline Vec3 from_openmesh(const OpenMesh::Vec3d& p) { return {p[0], p[1], p[2]}; }

/// Makes one patch or more per pair of bodies, in the order of the pairs, as adamas::to_openmesh
/// (adamas/openmesh.h) does per pair of materials: the lower body is in front, an edge of three or more
/// triangles is a border of each of them, and a point where fans touch becomes a vertex of each fan. Every
/// triangle is in one patch, except those with two equal points, whose `sides` need not be valid. `sides`:
/// the bodies in front and behind; throws Error if their number is not that of the triangles.
std::vector<InterfacePatch> to_openmesh(const InterfaceMesh& mesh,
                                        const std::vector<std::array<BodyId, 2>>& sides);

/// The triangles of patches on shared points.
struct JoinedPatches {
  InterfaceMesh mesh;  ///< its source is set by the caller
  std::vector<std::array<BodyId, 2>> sides;
  std::vector<std::uint32_t> points;  ///< for each point of the mesh, the number of its vertices
};

/// Joins patches: vertices with the same point number become one point; points are in the order of these
/// numbers, triangles in the order of theirs. Faces that are marked as deleted are left out.
/// `body_materials`: the material of each body; `materials`: their names.
JoinedPatches from_openmesh(const std::vector<InterfacePatch>& patches,
                            const IdVector<BodyId, MaterialId>& body_materials,
                            const IdVector<MaterialId, std::string>& materials);

}  // namespace adamas::interfaces
