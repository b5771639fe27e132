#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/meshes.h"
#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/io/output_stream.h"

namespace adamas::io {

// These are shared by the formats of write_surface, each of which writes into an open file and leaves it
// open.

static_assert(std::endian::native == std::endian::little, "records are written as they are in memory");

/// Reports the progress of one file by the number of records written.
class SurfaceProgress {
 public:
  SurfaceProgress(Progress& progress, std::size_t total) : progress_(progress), total_(total) {}
  void add(std::size_t records) {
    done_ += records;
    progress_.step("writing the surface", static_cast<double>(done_) / static_cast<double>(total_));
  }

 private:
  Progress& progress_;
  std::size_t total_, done_ = 0;
};

/// The file that is being written and the surface that goes into it; the name is for messages.
struct SurfaceOutput {
  const std::string& name;
  const TriangleSurface& surface;
  OutputStream& stream;
  Progress& progress;
};

void write_surface_ply(const SurfaceOutput& out);
void write_surface_stl(const SurfaceOutput& out);
void write_surface_obj(const SurfaceOutput& out);
void write_surface_vtp(const SurfaceOutput& out);
void write_surface_glb(const SurfaceOutput& out);
void write_surface_gltf(const SurfaceOutput& out);

/// Throws Error unless floats can hold all coordinates.
void check_single_range(const SurfaceOutput& out);

/// Puts values into memory one after the other.
class RecordCursor {
 public:
  explicit RecordCursor(char* at) : at_(at) {}
  template <class T>
  void put(const T& value) {
    std::memcpy(at_, &value, sizeof(T));
    at_ += sizeof(T);
  }
  /// Appends the components, converted to T.
  template <class T>
  void put_vector(const Vec3& v) {
    put(static_cast<T>(v.x));
    put(static_cast<T>(v.y));
    put(static_cast<T>(v.z));
  }

 private:
  char* at_;
};

/// Writes `count` records of `size` bytes in large blocks; `fill(cursor, i)` puts record i.
template <class Stream, class Fill>
void write_records(Stream& stream, SurfaceProgress& progress, std::size_t count, std::size_t size,
                   Fill&& fill) {
  constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
  const std::size_t most = std::max<std::size_t>(1, kBlockBytes / size);
  std::vector<char> block(std::min(count, most) * size);
  for (std::size_t begin = 0; begin < count; begin += most) {
    const std::size_t end = std::min(count, begin + most);
    RecordCursor cursor(block.data());
    for (std::size_t i = begin; i < end; ++i) fill(cursor, i);
    stream.write(block.data(), (end - begin) * size);
    progress.add(end - begin);
  }
}

}  // namespace adamas::io
