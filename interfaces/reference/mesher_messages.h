#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/vec3.h"
#include "interfaces/reference/message.h"

namespace adamas::interfaces {

enum class MesherKind : std::uint32_t { kTetGen, kTetGenDiagnosis, kMesh3, kMesh3Labels };

/// Criteria of CGAL's Mesh_3, in units of length and degrees; 0 stands for none.
struct Mesh3Criteria {
  double facet_angle = 25;
  double facet_distance = 0;
  double edge_size = 0;
  double radius_edge_ratio = 3;
  std::uint64_t optimise = 0;  ///< 1: perturb and exude, for better angles
};

/// Labels in boxes that fill the domain: box (i, j, k), x fastest, lies between walls i and i + 1 of x, and
/// so on.
struct LabelImage {
  std::vector<double> walls_x, walls_y, walls_z;  ///< ascending
  std::vector<std::uint16_t> labels;
};

/// What the separate program is asked: triangles on shared points, each of a patch, whose sides are regions
/// (0: outside).
struct MesherRequest {
  MesherKind kind = MesherKind::kTetGen;
  std::string switches;  ///< of TetGen
  Mesh3Criteria criteria;
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> triangle_patches;
  std::vector<std::array<std::uint32_t, 2>> patch_regions;  ///< in front (where normals point to) and behind
  LabelImage image;  ///< instead of triangles; regions are labels and 1 more

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

/// What it answers. Its tetrahedra have regions, or patches of triangles between them. One that was decoded
/// is whole, but its numbers of points and patches are not checked.
struct MesherReply {
  std::string failure;  ///< empty where there is a mesh
  double seconds = 0;   ///< in the library
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

}  // namespace adamas::interfaces
