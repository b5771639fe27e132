#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "viewer/contents/drawn_mesh.h"

namespace adamas::viewer {

/// The memory of a graphics device for meshes: large blocks that stay mapped, in which meshes get parts. All
/// members use the current OpenGL context.
class MeshBuffers {
 public:
  MeshBuffers();
  ~MeshBuffers();
  MeshBuffers(const MeshBuffers&) = delete;
  MeshBuffers& operator=(const MeshBuffers&) = delete;

  /// The place of a mesh in a block.
  struct Place {
    std::size_t block;
    std::uint32_t first_vertex, first_index, index_count;
  };
  /// Returns the place of a mesh, after copying it if necessary. Throws Error if there is no memory for it.
  const Place& place(const SharedMesh& mesh);
  /// Begins a picture. Meshes that were in none of the last few pictures are freed as soon as the device no
  /// longer reads them.
  void begin_picture();
  /// Ends a picture, after the last command that reads meshes.
  void end_picture();

  /// The vertex array of a block. Attributes 0 to 2 are place, normal and values; for ends of edges, 0 to 2
  /// and 4 are the parts of EdgeEnds.
  [[nodiscard]] std::uint32_t vertex_array(std::size_t block) const;
  /// Whether the meshes of a block have ends of edges.
  [[nodiscard]] bool has_edges(std::size_t block) const;
  /// The buffer of a block's indices.
  [[nodiscard]] std::uint32_t index_buffer(std::size_t block) const;
  [[nodiscard]] std::size_t blocks() const { return blocks_.size(); }
  /// The number of bytes that were copied so far.
  [[nodiscard]] std::uint64_t copied_bytes() const { return copied_bytes_; }

 private:
  struct Block;
  struct Known {
    SharedMesh mesh;  ///< held so that no other mesh gets its address
    Place place;
    std::uint64_t last_picture;
  };

  Place copied(const DrawnMesh& mesh);
  /// Copies a mesh into a block. Returns nothing if the block has no room.
  std::optional<Place> copied_into(std::size_t block, const DrawnMesh& mesh);

  std::vector<std::unique_ptr<Block>> blocks_;
  std::unordered_map<const DrawnMesh*, Known> known_;
  std::uint64_t picture_ = 0;
  std::vector<void*> fences_;  ///< one for each of the last pictures
  std::uint64_t copied_bytes_ = 0;
};

}  // namespace adamas::viewer
