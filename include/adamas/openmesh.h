#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "adamas/error.h"
#include "adamas/meshes.h"

// This header converts interfaces to meshes of OpenMesh, one for each pair of bodies or, where these are not
// known, of materials, and back. It needs the headers of OpenMesh and its library OpenMeshCore, and no
// library of adamas. Where three bodies meet, each pair's mesh has a border.

namespace adamas {

/// A mesh of OpenMesh with coordinates in double and no attributes of its own. The functions below accept any
/// other TriMesh whose points have three coordinates.
using OpenMeshSurface = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

/// The place of a vertex or face in the InterfaceTriangles that it was made of.
struct OpenMeshOrigin {
  std::uint32_t number = kNew;  ///< the index of the point or triangle
  bool turned = false;          ///< whether the face has the opposite orientation of the triangle

  /// The number of a vertex or face that was made later on.
  static constexpr std::uint32_t kNew = 0xffffffffu;
};

/// The interface between two bodies or two materials, or a part of it.
template <class Mesh = OpenMeshSurface>
struct OpenMeshInterface {
  std::uint32_t front = 0, back = 0;  ///< the materials; the right-hand normals of faces point to `front`
  /// The bodies in front and behind, which are of these materials; none where they are not known.
  std::optional<std::array<std::uint32_t, 2>> bodies;
  Mesh mesh;
  OpenMesh::VPropHandleT<OpenMeshOrigin> vertex_origin;  ///< a property of the mesh
  OpenMesh::FPropHandleT<OpenMeshOrigin> face_origin;    ///< another one
};

namespace openmesh_detail {

/// A triangle, turned so that its front is the lower body or material.
struct Triangle {
  OpenMeshOrigin origin;
  std::array<std::uint32_t, 3> points;
};

/// Sets of numbers that are joined two by two.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }
  /// Returns the lowest number of the set.
  [[nodiscard]] std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t i, std::uint32_t j) {
    i = find(i), j = find(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Finds the corners of triangles (3 t + c) that are one vertex: those that are connected by edges of just
/// two triangles, which run in opposite directions along the edge.
inline Sets joined_corners(const std::vector<Triangle>& triangles) {
  struct Side {
    std::uint32_t low, high, triangle, corner;
    bool forward;
  };
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
  Sets corners(3 * triangles.size());
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

/// Disables what OpenMesh prints, such as an error for each face that it refuses, which is expected here. The
/// streams are of the whole process: they are as before when the last of these objects on any thread ends.
class Silence {
 public:
  Silence() {
    Streams& streams = shared();
    const std::lock_guard lock(streams.mutex);
    if (streams.silenced++ > 0) return;
    for (std::size_t i = 0; i < streams.enabled.size(); ++i) {
      streams.enabled[i] = stream(i).is_enabled();
      stream(i).disable();
    }
  }
  ~Silence() {
    Streams& streams = shared();
    const std::lock_guard lock(streams.mutex);
    if (--streams.silenced > 0) return;
    for (std::size_t i = 0; i < streams.enabled.size(); ++i) {
      if (streams.enabled[i]) stream(i).enable();
    }
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  struct Streams {
    std::mutex mutex;
    std::size_t silenced = 0;       ///< the number of these objects
    std::array<bool, 3> enabled{};  ///< whether each stream was enabled before the first of them
  };
  static Streams& shared() {
    static Streams streams;
    return streams;
  }
  static OpenMesh::mostream& stream(std::size_t i) { return i == 0 ? omlog() : i == 1 ? omout() : omerr(); }
};

/// Removes the vertices that belong to no face.
template <class Mesh>
void remove_isolated_vertices(Mesh& mesh) {
  mesh.request_vertex_status(), mesh.request_halfedge_status();
  mesh.request_edge_status(), mesh.request_face_status();
  mesh.delete_isolated_vertices();
  mesh.garbage_collection();
  mesh.release_vertex_status(), mesh.release_halfedge_status();
  mesh.release_edge_status(), mesh.release_face_status();
}

/// Fills a mesh with the triangles; returns those that OpenMesh refuses.
template <class Mesh>
std::vector<Triangle> fill(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                           OpenMeshInterface<Mesh>& interface) {
  Mesh& mesh = interface.mesh;
  mesh.add_property(interface.vertex_origin, "adamas: origin");
  mesh.add_property(interface.face_origin, "adamas: origin");
  const Silence silence;
  Sets corners = joined_corners(triangles);
  std::vector<typename Mesh::VertexHandle> vertices(3 * triangles.size());
  std::vector<Triangle> refused;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    std::array<typename Mesh::VertexHandle, 3> handles;
    for (std::uint32_t c = 0; c < 3; ++c) {
      typename Mesh::VertexHandle& vertex = vertices[corners.find(3 * t + c)];
      if (!vertex.is_valid()) {
        const std::uint32_t number = triangles[t].points[c];
        using Scalar = typename Mesh::Scalar;
        vertex =
            mesh.add_vertex({static_cast<Scalar>(points[number].x), static_cast<Scalar>(points[number].y),
                             static_cast<Scalar>(points[number].z)});
        mesh.property(interface.vertex_origin, vertex) = {number, false};
      }
      handles[c] = vertex;
    }
    const auto face = mesh.add_face(handles[0], handles[1], handles[2]);
    if (face.is_valid()) {
      mesh.property(interface.face_origin, face) = triangles[t].origin;
    } else {
      refused.push_back(triangles[t]);
    }
  }
  if (!refused.empty()) remove_isolated_vertices(mesh);
  return refused;
}

template <class Mesh>
bool is_deleted(const Mesh& mesh, typename Mesh::FaceHandle face) {
  return mesh.has_face_status() && mesh.status(face).deleted();
}

/// Throws Error where arrays do not fit each other.
inline void check(const InterfaceTriangles& interfaces) {
  const std::string count = std::to_string(interfaces.triangles.size());
  if (interfaces.sides.size() != interfaces.triangles.size())
    throw Error("interfaces: expected the materials on both sides of " + count +
                " triangles, found those of " + std::to_string(interfaces.sides.size()));
  if (!interfaces.bodies.empty() && interfaces.bodies.size() != interfaces.triangles.size())
    throw Error("interfaces: expected the bodies on both sides of " + count + " triangles, found those of " +
                std::to_string(interfaces.bodies.size()));
  for (const auto& [a, b, c] : interfaces.triangles) {
    if (std::max({a, b, c}) >= interfaces.points.size())
      throw Error("interfaces: expected triangles of " + std::to_string(interfaces.points.size()) +
                  " points, found one of point " + std::to_string(std::max({a, b, c})));
  }
}

/// The triangles of one pair of bodies or materials, and the materials.
struct Pair {
  std::array<std::uint32_t, 2> sides;
  std::vector<Triangle> triangles;
};

/// Returns the triangles of each pair, of bodies where these are known, and otherwise of materials.
inline std::map<std::array<std::uint32_t, 2>, Pair> find_pairs(const InterfaceTriangles& interfaces) {
  const auto& keys = interfaces.bodies.empty() ? interfaces.sides : interfaces.bodies;
  std::map<std::array<std::uint32_t, 2>, Pair> pairs;
  for (std::uint32_t t = 0; t < interfaces.triangles.size(); ++t) {
    const auto& [a, b, c] = interfaces.triangles[t];
    if (a == b || b == c || c == a) continue;
    auto key = keys[t], sides = interfaces.sides[t];
    const bool turned = !(key[0] < key[1]);
    if (turned) std::swap(key[0], key[1]), std::swap(sides[0], sides[1]);
    Pair& pair = pairs.try_emplace(key, Pair{sides, {}}).first->second;
    if (pair.sides != sides)
      throw Error("interfaces: expected one material of each body, found several between bodies " +
                  std::to_string(key[0]) + " and " + std::to_string(key[1]));
    pair.triangles.push_back(turned ? Triangle{{t, true}, {a, c, b}} : Triangle{{t, false}, {a, b, c}});
  }
  return pairs;
}

}  // namespace openmesh_detail

/// Makes one mesh for each pair of bodies, in the order of the pairs, with the lower body in front; triangles
/// are turned where it is not. Where the bodies are not known, there is one mesh for each pair of materials,
/// with the lower material in front. An edge at which three or more triangles of a pair meet, or two that run
/// the same way along it, is a border of each of them, and a point at which fans touch becomes a vertex of
/// each fan. Faces that OpenMesh refuses all the same form a further mesh of the same pair. Every triangle is
/// in one mesh, except those with two equal points. Throws Error where there is not one pair of sides for
/// each triangle, or bodies are given and not one pair for each, where a body has several materials between
/// the same two bodies, or a triangle has the index of no point.
template <class Mesh = OpenMeshSurface>
std::vector<OpenMeshInterface<Mesh>> to_openmesh(const InterfaceTriangles& interfaces) {
  openmesh_detail::check(interfaces);
  std::vector<OpenMeshInterface<Mesh>> result;
  for (auto& [key, pair] : openmesh_detail::find_pairs(interfaces)) {
    // OpenMesh never refuses the first triangle.
    std::vector<openmesh_detail::Triangle> triangles = std::move(pair.triangles);
    while (!triangles.empty()) {
      OpenMeshInterface<Mesh>& interface = result.emplace_back();
      interface.front = pair.sides[0], interface.back = pair.sides[1];
      if (!interfaces.bodies.empty()) interface.bodies = key;
      triangles = openmesh_detail::fill(interfaces.points, triangles, interface);
    }
  }
  return result;
}

/// Makes interfaces of the meshes. Vertices of the same origin become one point, in the order of their
/// numbers; each vertex that was made later becomes a point behind these. Triangles are in the order of their
/// origins' numbers and have their first orientation; those that were made later come last. Faces marked as
/// deleted, and points without faces, are left out. Meshes that were not changed thus give the triangles that
/// they were made of. Bodies are known where all meshes have them. `materials`: the names. A vertex that was
/// moved in one mesh has to be moved in all others that have a vertex of the same origin: the first one is
/// taken.
template <class Mesh>
InterfaceTriangles from_openmesh(const std::vector<OpenMeshInterface<Mesh>>& interfaces,
                                 std::vector<std::string> materials) {
  // A point is known by its number or, if it is new, by mesh and vertex.
  using Key = std::array<std::uint32_t, 3>;
  struct Face {
    OpenMeshOrigin origin;
    std::uint32_t part;
    std::array<Key, 3> points;
  };
  std::map<Key, std::pair<Vec3, std::uint32_t>> points;
  std::vector<Face> faces;
  for (std::uint32_t part = 0; part < interfaces.size(); ++part) {
    const auto& [front, back, bodies, mesh, vertex_origin, face_origin] = interfaces[part];
    for (const auto face : mesh.faces()) {
      if (openmesh_detail::is_deleted(mesh, face)) continue;
      Face found{mesh.property(face_origin, face), part, {}};
      std::size_t c = 0;
      for (const auto vertex : mesh.fv_range(face)) {
        const std::uint32_t number = mesh.property(vertex_origin, vertex).number;
        const bool is_new = number == OpenMeshOrigin::kNew;
        const Key key = is_new ? Key{number, part, static_cast<std::uint32_t>(vertex.idx())} : Key{number};
        const auto& p = mesh.point(vertex);
        points.try_emplace(key, Vec3{p[0], p[1], p[2]}, 0u);
        found.points[c++] = key;
      }
      faces.push_back(found);
    }
  }
  std::stable_sort(faces.begin(), faces.end(),
                   [](const Face& a, const Face& b) { return a.origin.number < b.origin.number; });
  InterfaceTriangles result;
  result.materials = std::move(materials);
  for (auto& [key, point] : points) {
    point.second = static_cast<std::uint32_t>(result.points.size());
    result.points.push_back(point.first);
  }
  const bool bodies_known =
      std::all_of(interfaces.begin(), interfaces.end(), [](const auto& i) { return i.bodies.has_value(); });
  for (const Face& face : faces) {
    const OpenMeshInterface<Mesh>& interface = interfaces[face.part];
    std::array<std::uint32_t, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) corners[c] = points.at(face.points[c]).second;
    if (face.origin.turned) std::swap(corners[1], corners[2]);
    const auto along = [&face](std::array<std::uint32_t, 2> pair) {
      if (face.origin.turned) std::swap(pair[0], pair[1]);
      return pair;
    };
    result.triangles.push_back(corners);
    result.sides.push_back(along({interface.front, interface.back}));
    if (bodies_known) result.bodies.push_back(along(*interface.bodies));
  }
  return result;
}

}  // namespace adamas
