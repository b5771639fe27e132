#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "interfaces/reference_client/message.h"

// The requests to the separate program adamas-reference, and its replies. Decoded replies are complete, but
// the numbers in them are not checked.

namespace adamas::interfaces {

enum class MesherKind : std::uint32_t { kTetGen, kTetGenDiagnosis, kMesh3, kMesh3Labels };

/// The criteria of CGAL's Mesh_3, in units of length and degrees; 0 stands for no criterion.
struct Mesh3Criteria {
  double facet_angle = 25;
  double facet_distance = 0;
  double edge_size = 0;
  double radius_edge_ratio = 3;
  std::uint64_t optimise = 0;  ///< 1: the mesh is perturbed and exuded, for better angles
};

/// Labels in boxes that fill the domain: box (i, j, k), x fastest, lies between walls i and i + 1 of x, and
/// so on.
struct LabelImage {
  std::vector<double> walls_x, walls_y, walls_z;  ///< ascending
  std::vector<std::uint16_t> labels;
};

/// A request for a mesh of tetrahedra: triangles on shared points, each of a patch, whose sides are regions
/// (0: outside).
struct MesherRequest {
  MesherKind kind = MesherKind::kTetGen;
  std::string switches;  ///< the switches of TetGen
  Mesh3Criteria criteria;
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> triangle_patches;
  /// the regions in front, to which normals point, and behind
  std::vector<std::array<std::uint32_t, 2>> patch_regions;
  LabelImage image;  ///< used instead of triangles; regions are labels + 1

  static constexpr std::array<char, 8> kMark{'a', 'd', 'a', 'm', 'e', 's', 'h', '2'};
  template <class Request, class Visit>
  static void members(Request& request, Visit& visit) {
    visit(request.kind), visit(request.switches), visit(request.criteria);
    visit(request.points), visit(request.triangles), visit(request.triangle_patches);
    visit(request.patch_regions);
    visit(request.image.walls_x), visit(request.image.walls_y), visit(request.image.walls_z);
    visit(request.image.labels);
  }
};

/// A mesh. Its tetrahedra have regions, or there are triangles of the patches between them.
struct MesherReply {
  std::string failure;  ///< empty if there is a mesh
  double seconds = 0;   ///< the time in the library
  std::uint64_t peak_memory_bytes = 0;
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  std::vector<std::uint32_t> regions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> triangle_patches;

  static constexpr std::array<char, 8> kMark{'a', 'd', 'a', 'm', 'r', 'e', 'p', '1'};
  template <class Reply, class Visit>
  static void members(Reply& reply, Visit& visit) {
    visit(reply.failure), visit(reply.seconds), visit(reply.peak_memory_bytes), visit(reply.points);
    visit(reply.tetrahedra), visit(reply.regions), visit(reply.triangles), visit(reply.triangle_patches);
  }
};

/// A request for constrained Delaunay triangulations, one of each plane: of all its points, with its segments
/// as edges.
struct PlanarRequest {
  std::vector<std::array<double, 2>> points;           ///< the points of all planes, one plane after another
  std::vector<std::array<std::uint32_t, 2>> segments;  ///< indices of points
  /// The index, by plane, at which those of the next plane begin.
  std::vector<std::uint32_t> point_ends, segment_ends;

  static constexpr std::array<char, 8> kMark{'a', 'd', 'a', 'm', 'p', 'l', 'a', '1'};
  template <class Request, class Visit>
  static void members(Request& request, Visit& visit) {
    visit(request.points), visit(request.segments), visit(request.point_ends), visit(request.segment_ends);
  }
};

/// The triangulations of the planes.
struct PlanarReply {
  std::string failure;                                  ///< empty if there are triangles
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of points, counterclockwise
  std::vector<std::uint32_t> triangle_ends;  ///< by plane: the index at which those of the next plane begin

  static constexpr std::array<char, 8> kMark{'a', 'd', 'a', 'm', 'p', 'l', 't', '1'};
  template <class Reply, class Visit>
  static void members(Reply& reply, Visit& visit) {
    visit(reply.failure), visit(reply.triangles), visit(reply.triangle_ends);
  }
};

/// A request for the two-sided Hausdorff distance between the parts of two sets of triangles in a box.
struct DistanceRequest {
  /// One set of triangles on shared points.
  struct Triangles {
    std::vector<Vec3> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
  };
  std::array<Triangles, 2> sets;
  double bound = 0;  ///< the greatest difference between the lower and the upper bound, in units of length
  Vec3 box_min, box_max;

  static constexpr std::array<char, 8> kMark{'a', 'd', 'a', 'm', 'd', 'i', 's', '1'};
  template <class Request, class Visit>
  static void members(Request& request, Visit& visit) {
    for (auto& set : request.sets) visit(set.points), visit(set.triangles);
    visit(request.bound), visit(request.box_min), visit(request.box_max);
  }
};

/// The lower and the upper bound of the distance; both are infinite if only one of the sets is empty.
struct DistanceReply {
  std::string failure;  ///< empty if there are bounds
  double lower = 0, upper = 0;

  static constexpr std::array<char, 8> kMark{'a', 'd', 'a', 'm', 'd', 'i', 't', '1'};
  template <class Reply, class Visit>
  static void members(Reply& reply, Visit& visit) {
    visit(reply.failure), visit(reply.lower), visit(reply.upper);
  }
};

}  // namespace adamas::interfaces
