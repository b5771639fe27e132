#include "viewer/gl/mesh_buffers.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <span>

#include "core/base/error.h"
#include "viewer/gl/range_allocator.h"

namespace adamas::viewer {

using namespace isosurface;

namespace {

/// The least size of a block: 8 MiB of vertices and as many of indices.
constexpr std::size_t kBlockVertices = std::size_t{1} << 18, kBlockIndices = std::size_t{1} << 21;
/// The number of pictures that a device may still be working on.
constexpr std::uint64_t kPicturesInFlight = 3;

constexpr GLbitfield kMapped = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;

/// Memory of the device into which the program writes.
class MappedBuffer {
 public:
  explicit MappedBuffer(std::size_t bytes) {
    glCreateBuffers(1, &name_);
    glNamedBufferStorage(name_, static_cast<GLsizeiptr>(bytes), nullptr, kMapped);
    bytes_ =
        static_cast<std::byte*>(glMapNamedBufferRange(name_, 0, static_cast<GLsizeiptr>(bytes), kMapped));
    if (bytes_ == nullptr) {
      glDeleteBuffers(1, &name_);
      fail("pictures by OpenGL: no {} bytes for meshes can be had: is the graphics memory full?", bytes);
    }
  }
  MappedBuffer(const MappedBuffer&) = delete;
  MappedBuffer& operator=(const MappedBuffer&) = delete;
  ~MappedBuffer() { glDeleteBuffers(1, &name_); }

  [[nodiscard]] GLuint name() const { return name_; }
  void write(std::size_t at, std::span<const std::byte> bytes) {
    if (!bytes.empty()) std::memcpy(bytes_ + at, bytes.data(), bytes.size());
  }

 private:
  GLuint name_ = 0;
  std::byte* bytes_ = nullptr;
};

struct Attribute {
  GLuint location;
  GLint count;
  GLenum type;
  std::size_t offset;
};
constexpr std::array<Attribute, 3> kOfVertices{{{0, 3, GL_FLOAT, offsetof(DrawnMesh::Vertex, place)},
                                                {1, 3, GL_FLOAT, offsetof(DrawnMesh::Vertex, normal)},
                                                {2, 2, GL_FLOAT, offsetof(DrawnMesh::Vertex, front_value)}}};
constexpr std::size_t kDescents = offsetof(EdgeEnds, descents);
// Shorts are in fours and twos, so that all begin at multiples of four bytes.
constexpr std::array<Attribute, 4> kOfEdges{{{0, 1, GL_UNSIGNED_INT, offsetof(EdgeEnds, points)},
                                             {1, 2, GL_FLOAT, offsetof(EdgeEnds, values)},
                                             {2, 4, GL_SHORT, kDescents},
                                             {4, 2, GL_SHORT, kDescents + 4 * sizeof(std::int16_t)}}};

void set_attributes(GLuint array, std::span<const Attribute> attributes) {
  for (const Attribute& each : attributes) {
    const auto offset = static_cast<GLuint>(each.offset);
    glEnableVertexArrayAttrib(array, each.location);
    if (each.type == GL_UNSIGNED_INT) {
      glVertexArrayAttribIFormat(array, each.location, each.count, each.type, offset);
    } else {
      glVertexArrayAttribFormat(array, each.location, each.count, each.type, GL_TRUE, offset);
    }
    glVertexArrayAttribBinding(array, each.location, 0);
  }
}

std::size_t vertex_count(const DrawnMesh& mesh) { return std::max(mesh.vertices.size(), mesh.ends.size()); }
std::span<const std::byte> vertex_bytes(const DrawnMesh& mesh) {
  return mesh.ends.empty() ? std::as_bytes(std::span(mesh.vertices)) : std::as_bytes(std::span(mesh.ends));
}

}  // namespace

struct MeshBuffers::Block {
  bool has_edges;
  std::size_t vertex_bytes;  ///< size of one vertex
  RangeAllocator vertices, indices;
  MappedBuffer vertex_buffer, index_buffer;
  GLuint array = 0;

  Block(bool is_of_edges, std::size_t vertex_count, std::size_t index_count)
      : has_edges(is_of_edges),
        vertex_bytes(is_of_edges ? sizeof(EdgeEnds) : sizeof(DrawnMesh::Vertex)),
        vertices(vertex_count),
        indices(index_count),
        vertex_buffer(vertex_count * vertex_bytes),
        index_buffer(index_count * sizeof(std::uint32_t)) {
    glCreateVertexArrays(1, &array);
    if (has_edges) {
      set_attributes(array, kOfEdges);
    } else {
      set_attributes(array, kOfVertices);
    }
    glVertexArrayVertexBuffer(array, 0, vertex_buffer.name(), 0, static_cast<GLsizei>(vertex_bytes));
  }
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
  ~Block() { glDeleteVertexArrays(1, &array); }
};

MeshBuffers::MeshBuffers() = default;

MeshBuffers::~MeshBuffers() {
  for (void* const fence : fences_) glDeleteSync(static_cast<GLsync>(fence));
}

std::uint32_t MeshBuffers::vertex_array(std::size_t block) const { return blocks_[block]->array; }

bool MeshBuffers::has_edges(std::size_t block) const { return blocks_[block]->has_edges; }

std::uint32_t MeshBuffers::index_buffer(std::size_t block) const {
  return blocks_[block]->index_buffer.name();
}

const MeshBuffers::Place& MeshBuffers::place(const SharedMesh& mesh) {
  auto found = known_.find(mesh.get());
  if (found == known_.end()) found = known_.emplace(mesh.get(), Known{mesh, copied(*mesh), picture_}).first;
  found->second.last_picture = picture_;
  return found->second.place;
}

MeshBuffers::Place MeshBuffers::copied(const DrawnMesh& mesh) {
  for (std::size_t n = 0; n < blocks_.size(); ++n) {
    if (const std::optional<Place> place = copied_into(n, mesh)) return *place;
  }
  blocks_.push_back(std::make_unique<Block>(!mesh.ends.empty(), std::max(kBlockVertices, vertex_count(mesh)),
                                            std::max(kBlockIndices, mesh.indices.size())));
  return *copied_into(blocks_.size() - 1, mesh);
}

std::optional<MeshBuffers::Place> MeshBuffers::copied_into(std::size_t block, const DrawnMesh& mesh) {
  Block& into = *blocks_[block];
  if (into.has_edges == mesh.ends.empty()) return std::nullopt;
  const auto vertices = into.vertices.take(vertex_count(mesh));
  if (!vertices) return std::nullopt;
  const auto indices = into.indices.take(mesh.indices.size());
  if (!indices) {
    into.vertices.give_back(*vertices, vertex_count(mesh));
    return std::nullopt;
  }
  const std::span<const std::byte> index_bytes = std::as_bytes(std::span(mesh.indices));
  into.vertex_buffer.write(*vertices * into.vertex_bytes, vertex_bytes(mesh));
  into.index_buffer.write(*indices * sizeof(std::uint32_t), index_bytes);
  copied_bytes_ += vertex_bytes(mesh).size() + index_bytes.size();
  return Place{block, static_cast<std::uint32_t>(*vertices), static_cast<std::uint32_t>(*indices),
               static_cast<std::uint32_t>(mesh.indices.size())};
}

void MeshBuffers::begin_picture() {
  ++picture_;
  if (fences_.size() >= kPicturesInFlight) {
    constexpr GLuint64 kLong = 10'000'000'000;  // nanoseconds
    const auto oldest = static_cast<GLsync>(fences_.front());
    glClientWaitSync(oldest, GL_SYNC_FLUSH_COMMANDS_BIT, kLong);
    glDeleteSync(oldest);
    fences_.erase(fences_.begin());
  }
  std::erase_if(known_, [&](const auto& entry) {
    const Known& known = entry.second;
    if (known.last_picture + kPicturesInFlight >= picture_) return false;
    Block& block = *blocks_[known.place.block];
    block.vertices.give_back(known.place.first_vertex, vertex_count(*known.mesh));
    block.indices.give_back(known.place.first_index, known.mesh->indices.size());
    return true;
  });
  // Empty blocks at the end are removed; others keep their numbers.
  const auto is_empty = [](const Block& block) {
    return block.vertices.free_size() == block.vertices.size() &&
           block.indices.free_size() == block.indices.size();
  };
  while (blocks_.size() > 1 && is_empty(*blocks_.back())) blocks_.pop_back();
}

void MeshBuffers::end_picture() { fences_.push_back(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)); }

}  // namespace adamas::viewer
