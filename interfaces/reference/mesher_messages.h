#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/vec3.h"
#include "interfaces/reference/message.h"

namespace adamas {

enum class MesherKind : std::uint32_t { kTetGen, kTetGenDiagnosis, kMesh3 };

/// Criteria of CGAL's Mesh_3, in units of length and degrees; 0 stands for none.
struct Mesh3Criteria {
  double facet_angle = 25;
  double facet_distance = 0;
  double edge_size = 0;
  double radius_edge_ratio = 3;
  std::uint64_t optimise = 0;  ///< 1: perturb and exude, for better angles
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
};

/// What it answers. Its tetrahedra have regions, or patches of triangles between them.
struct MesherReply {
  std::string failure;  ///< empty where there is a mesh
  double seconds = 0;   ///< in the library
  std::uint64_t peak_memory_bytes = 0;
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  std::vector<std::uint32_t> regions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> triangle_patches;
};

inline constexpr std::array<char, 8> kRequestMark{'a', 'd', 'a', 'm', 'e', 's', 'h', '1'};
inline constexpr std::array<char, 8> kReplyMark{'a', 'd', 'a', 'm', 'r', 'e', 'p', '1'};

inline std::vector<char> encode(const MesherRequest& request) {
  MessageWriter writer;
  writer.put(kRequestMark);
  writer.put(request.kind);
  writer.put(request.switches);
  writer.put(request.criteria);
  writer.put(request.points);
  writer.put(request.triangles);
  writer.put(request.triangle_patches);
  writer.put(request.patch_regions);
  return writer.bytes();
}

inline std::vector<char> encode(const MesherReply& reply) {
  MessageWriter writer;
  writer.put(kReplyMark);
  writer.put(reply.failure);
  writer.put(reply.seconds);
  writer.put(reply.peak_memory_bytes);
  writer.put(reply.points);
  writer.put(reply.tetrahedra);
  writer.put(reply.regions);
  writer.put(reply.triangles);
  writer.put(reply.triangle_patches);
  return writer.bytes();
}

/// None for bytes that are no whole request.
inline std::optional<MesherRequest> decode_request(std::vector<char> bytes) {
  MessageReader reader(std::move(bytes));
  if (reader.get<std::array<char, 8>>() != kRequestMark) return std::nullopt;
  MesherRequest request;
  request.kind = reader.get<MesherKind>();
  request.switches = reader.get_text();
  request.criteria = reader.get<Mesh3Criteria>();
  request.points = reader.get_list<Vec3>();
  request.triangles = reader.get_list<std::array<std::uint32_t, 3>>();
  request.triangle_patches = reader.get_list<std::uint32_t>();
  request.patch_regions = reader.get_list<std::array<std::uint32_t, 2>>();
  if (!reader.complete()) return std::nullopt;
  return request;
}

/// None for bytes that are no whole reply; numbers of points and patches are not checked.
inline std::optional<MesherReply> decode_reply(std::vector<char> bytes) {
  MessageReader reader(std::move(bytes));
  if (reader.get<std::array<char, 8>>() != kReplyMark) return std::nullopt;
  MesherReply reply;
  reply.failure = reader.get_text();
  reply.seconds = reader.get<double>();
  reply.peak_memory_bytes = reader.get<std::uint64_t>();
  reply.points = reader.get_list<Vec3>();
  reply.tetrahedra = reader.get_list<std::array<std::uint32_t, 4>>();
  reply.regions = reader.get_list<std::uint32_t>();
  reply.triangles = reader.get_list<std::array<std::uint32_t, 3>>();
  reply.triangle_patches = reader.get_list<std::uint32_t>();
  if (!reader.complete()) return std::nullopt;
  return reply;
}

}  // namespace adamas
