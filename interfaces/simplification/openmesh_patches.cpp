#include "interfaces/simplification/openmesh_patches.h"

#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <map>
#include <mutex>

#include "core/base/disjoint_sets.h"
#include "core/base/error.h"

namespace adamas::interfaces {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

/// OpenMesh tells on stderr of triangles that it refuses, which are seen to here.
void silence_openmesh() {
  static std::once_flag once;
  std::call_once(once, [] {
    omlog().disable();
    omout().disable();
    omerr().disable();
  });
}

/// A triangle, turned so that its front is the lower body.
struct Turned {
  std::uint32_t number;
  std::array<std::uint32_t, 3> points;
};

/// A triangle at an edge.
struct Side {
  std::uint32_t low, high;
  std::uint32_t triangle;
  std::uint32_t corner;  ///< where the edge starts, in the triangle's direction
  bool forward;
};

std::vector<Side> sides_of(const std::vector<Turned>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t c = 0; c < 3; ++c) {
      const std::uint32_t a = triangles[t].points[c], b = triangles[t].points[(c + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, c, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return std::tie(x.low, x.high, x.triangle) < std::tie(y.low, y.high, y.triangle);
  });
  return sides;
}

/// Corners of triangles that are one vertex: those that edges of just two triangles, which run opposite ways
/// along it, keep together.
DisjointSets joined_corners(const std::vector<Turned>& triangles) {
  DisjointSets corners(3 * triangles.size());
  const std::vector<Side> sides = sides_of(triangles);
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last].low == sides[first].low &&
           sides[last].high == sides[first].high)
      ++last;
    if (last - first != 2 || sides[first].forward == sides[first + 1].forward) continue;
    const Side &a = sides[first], &b = sides[first + 1];
    corners.join(3 * a.triangle + a.corner, 3 * b.triangle + (b.corner + 1) % 3);
    corners.join(3 * a.triangle + (a.corner + 1) % 3, 3 * b.triangle + b.corner);
  }
  return corners;
}

/// Makes a patch of the triangles; returns those that OpenMesh refuses.
std::vector<Turned> fill(const InterfaceMesh& mesh, const std::vector<Turned>& triangles, PatchMesh& patch) {
  DisjointSets corners = joined_corners(triangles);
  std::vector<std::uint32_t> vertex(3 * triangles.size(), kNone);
  std::vector<Turned> refused;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    std::array<PatchMesh::VertexHandle, 3> handles;
    for (std::uint32_t c = 0; c < 3; ++c) {
      std::uint32_t& number = vertex[corners.find(3 * t + c)];
      if (number == kNone) {
        const PatchMesh::VertexHandle added =
            patch.add_vertex(to_openmesh(mesh.points[triangles[t].points[c]]));
        patch.data(added).point = triangles[t].points[c];
        number = static_cast<std::uint32_t>(added.idx());
      }
      handles[c] = PatchMesh::VertexHandle(static_cast<int>(number));
    }
    const PatchMesh::FaceHandle face = patch.add_face(handles[0], handles[1], handles[2]);
    if (face.is_valid()) {
      patch.data(face).triangle = triangles[t].number;
    } else {
      refused.push_back(triangles[t]);
    }
  }
  patch.delete_isolated_vertices();
  patch.garbage_collection();
  return refused;
}

}  // namespace

std::vector<InterfacePatch> to_openmesh(const InterfaceMesh& mesh,
                                        const std::vector<std::array<BodyId, 2>>& sides) {
  silence_openmesh();
  if (sides.size() != mesh.triangles.size())
    fail("{}: expected the bodies of {} triangles, found those of {}", mesh.source, mesh.triangles.size(),
         sides.size());
  std::map<std::array<BodyId, 2>, std::vector<Turned>> interfaces;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t].points;
    if (a == b || b == c || c == a) continue;
    const auto& [front, back] = sides[t];
    if (front < back) {
      interfaces[{front, back}].push_back({t, {a, b, c}});
    } else {
      interfaces[{back, front}].push_back({t, {a, c, b}});
    }
  }
  std::vector<InterfacePatch> patches;
  for (auto& [pair, triangles] : interfaces) {
    // The first triangle of all is never refused.
    while (!triangles.empty()) {
      InterfacePatch& patch = patches.emplace_back();
      patch.front = pair[0], patch.back = pair[1];
      triangles = fill(mesh, triangles, patch.mesh);
    }
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
