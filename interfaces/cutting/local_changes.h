#pragma once

#include <cstdint>
#include <vector>

#include "interfaces/cutting/interface_target.h"
#include "interfaces/cutting/labelled_mesh.h"

namespace adamas::interfaces {

/// A replacement of cells by others, with the least quality of the new ones.
struct LocalChange {
  std::vector<std::uint32_t> removed;
  std::vector<LabelledMesh::Cell> added;  ///< a new vertex has the mesh's next number
  double quality = 0;
  bool has_vertex = false;
  Vec3 point;  ///< the place of the new vertex
  std::uint8_t walls = 0;
};

/// Returns the least quality of cells.
double least_quality(const LabelledMesh& mesh, std::span<const std::uint32_t> cells);

/// Returns the least quality of the cells round a vertex if it were at p, or some number not above `bound` if
/// the least quality is not above it.
double quality_at(const LabelledMesh& mesh, std::uint32_t v, const Vec3& p, double bound);

/// Returns the length of the longest edge at a vertex.
double longest_edge(const LabelledMesh& mesh, std::uint32_t v);

/// Returns whether the face of a cell opposite to its vertex v lies on the box or between two bodies.
bool is_feature(const LabelledMesh& mesh, std::uint32_t cell, std::uint32_t v);

/// The functions collapse_edge(), remove_edge(), remove_face() and split_edge() find changes that raise the
/// least quality of the cells that they replace (or raise it above a bound), that keep the topology of all
/// bodies, of the interfaces between them, of the lines where these meet, and of all of them on the box, and
/// that leave the interfaces within the target's tolerance. Each returns whether there is such a change.
/// collapse_edge() moves vertex a into its neighbour b, but neither from an interface into a body nor from a
/// line into an interface (edge contraction with the link conditions of Dey, Edelsbrunner, Guha and Nekhayev
/// 1999).
bool collapse_edge(const LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t a, std::uint32_t b,
                   double bound, LocalChange& change);
/// Removes an edge and fills the ring round it by the best of all triangulations of the ring (Shewchuk 2002,
/// after Klincsek 1980). An edge of an interface is flipped: the other diagonal of its two triangles replaces
/// it.
bool remove_edge(const LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t a, std::uint32_t b,
                 LocalChange& change);
/// Replaces the two cells at the face opposite to vertex v of a cell by three cells round a new edge.
bool remove_face(const LabelledMesh& mesh, std::uint32_t cell, std::uint32_t v, LocalChange& change);

/// Divides the cells round an edge at a new vertex on it, at its middle or beside one of the vertices round
/// it.
bool split_edge(const LabelledMesh& mesh, std::uint32_t a, std::uint32_t b, LocalChange& change);

/// Returns whether a cell may be given to another body beyond one of its faces: every union of bodies and its
/// complement must keep their topology (simple points of images of several labels: Bazin and Pham 2007).
bool may_change_body(const LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t cell,
                     BodyId body);

/// Moves a vertex to a place where the least quality round it is greater: along the interface or line on
/// which it lies or, if that does not help, off it within the tolerance. Returns whether it moved.
bool smooth_vertex(LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t v);

}  // namespace adamas::interfaces
