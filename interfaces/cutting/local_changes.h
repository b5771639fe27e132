#pragma once

#include <cstdint>
#include <vector>

#include "interfaces/cutting/interface_target.h"
#include "interfaces/cutting/labelled_mesh.h"

namespace adamas::interfaces {

/// Cells in the place of others, and the least quality among them.
struct LocalChange {
  std::vector<std::uint32_t> removed;
  std::vector<LabelledMesh::Cell> added;  ///< a new vertex has the next number that the mesh will give
  double quality = 0;
  bool has_vertex = false;
  Vec3 point;  ///< of the new vertex, and its walls
  std::uint8_t walls = 0;
};

/// The least quality of cells.
double least_quality(const LabelledMesh& mesh, std::span<const std::uint32_t> cells);

/// The least quality round a vertex if it were at p; no better than `bound` where it is not above that.
double quality_at(const LabelledMesh& mesh, std::uint32_t v, const Vec3& p, double bound);

/// Length of the longest edge at a vertex.
double longest_edge(const LabelledMesh& mesh, std::uint32_t v);

/// Whether the face of a cell opposite to its vertex v lies on the box or between two bodies.
bool is_feature(const LabelledMesh& mesh, std::uint32_t cell, std::uint32_t v);

/// Works out changes that leave the least quality of what they replace greater than it was (or than a bound),
/// that keep the topology of all bodies, of the interfaces between them, of the lines where these meet, and
/// of all of them on the box, and that leave the interfaces within the target's tolerance. Each returns
/// whether there is such a change.
///
/// Moves vertex a into its neighbour b: not from an interface into a body, nor from a line into an interface
/// (edge contraction with the link conditions of Dey, Edelsbrunner, Guha and Nekhayev 1999).
bool collapse_edge(const LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t a, std::uint32_t b,
                   double bound, LocalChange& change);
/// Fills the ring round an edge without it, by the best of all triangulations of the ring (Shewchuk 2002,
/// after Klincsek 1980). An edge of an interface gives way to one that crosses it on the other side of two of
/// its triangles.
bool remove_edge(const LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t a, std::uint32_t b,
                 LocalChange& change);
/// Three cells round a new edge in the place of the two at a face, opposite to vertex v of a cell.
bool remove_face(const LabelledMesh& mesh, std::uint32_t cell, std::uint32_t v, LocalChange& change);

/// Divides the cells round an edge at a new vertex on it, at its middle or beside one of the vertices round
/// it.
bool split_edge(const LabelledMesh& mesh, std::uint32_t a, std::uint32_t b, LocalChange& change);

/// Whether a cell may be given to another body, one beyond one of its faces: so that any union of bodies, and
/// what is outside of it, keeps its topology (simple points of images of several labels: Bazin and Pham
/// 2007).
bool may_change_body(const LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t cell,
                     BodyId body);

/// Moves a vertex where the least quality round it is greater: along what it lies on or, where that does not
/// help, off it within the tolerance. Returns whether it did.
bool smooth_vertex(LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t v);

/// Moves vertices where bodies meet to the closest place where they should meet, as far as the cells round
/// them allow.
void snap_vertices(LabelledMesh& mesh, const InterfaceTarget& target);

}  // namespace adamas::interfaces
