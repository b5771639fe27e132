// Surfaces as .ply, .stl and .obj.

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/io/header_text.h"
#include "core/io/surface_formats.h"
#include "core/io/surface_writer.h"

namespace adamas::io {

namespace {

std::string ply_header(const TriangleSurface& surface, bool single) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment adamas\n";
  if (!surface.values.empty()) text += "comment value is " + printable(surface.value_name, 200) + "\n";
  text += fmt::format("element vertex {}\n", surface.points.size());
  for (const char axis : {'x', 'y', 'z'}) {
    text += fmt::format("property {} {}\n", single ? "float" : "double", axis);
  }
  if (!surface.normals.empty()) text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!surface.values.empty()) text += "property float value\n";
  text += fmt::format("element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
                      surface.triangles.size());
  return text;
}

template <class Real>
void write_ply_points(const SurfaceOutput& out, SurfaceProgress& progress) {
  const TriangleSurface& surface = out.surface;
  const bool normals = !surface.normals.empty(), values = !surface.values.empty();
  const std::size_t size =
      3 * sizeof(Real) + (normals ? 3 * sizeof(float) : 0) + (values ? sizeof(float) : 0);
  write_records(out.stream, progress, surface.points.size(), size, [&](RecordCursor& cursor, std::size_t i) {
    cursor.put_vector<Real>(surface.points[i]);
    if (normals) cursor.put_vector<float>(surface.normals[i]);
    if (values) cursor.put(surface.values[i]);
  });
}

/// Text that is written in large blocks.
class TextBlock {
 public:
  explicit TextBlock(OutputStream& stream) : stream_(stream) {}
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    if (text_.size() > kBlock) flush();
  }
  void flush() {
    stream_.write(text_.data(), text_.size());
    text_.clear();
  }

 private:
  static constexpr std::size_t kBlock = std::size_t{1} << 20;
  OutputStream& stream_;
  fmt::memory_buffer text_;
};

/// Calls `line(i)` for i in [0, count), and reports progress now and then.
template <class Line>
void for_each_line(SurfaceProgress& progress, std::size_t count, Line&& line) {
  constexpr std::size_t kLines = std::size_t{1} << 16;
  for (std::size_t begin = 0; begin < count; begin += kLines) {
    const std::size_t end = std::min(count, begin + kLines);
    for (std::size_t i = begin; i < end; ++i) line(i);
    progress.add(end - begin);
  }
}

/// The fewest digits that identify a number of type Real.
template <class Real>
void add_vectors(TextBlock& text, SurfaceProgress& progress, const char* keyword,
                 const std::vector<Vec3>& vectors) {
  for_each_line(progress, vectors.size(), [&](std::size_t i) {
    const Vec3& v = vectors[i];
    text.add("{} {} {} {}\n", keyword, static_cast<Real>(v.x), static_cast<Real>(v.y),
             static_cast<Real>(v.z));
  });
}

}  // namespace

void write_surface_ply(const SurfaceOutput& out) {
  const TriangleSurface& surface = out.surface;
  const bool single = single_precision_suffices(surface);
  SurfaceProgress progress(out.progress, surface.points.size() + surface.triangles.size());
  out.stream.write(ply_header(surface, single));
  single ? write_ply_points<float>(out, progress) : write_ply_points<double>(out, progress);
  constexpr std::uint8_t kCorners = 3;
  write_records(out.stream, progress, surface.triangles.size(), sizeof(kCorners) + 3 * sizeof(std::uint32_t),
                [&](RecordCursor& cursor, std::size_t i) {
                  cursor.put(kCorners);
                  cursor.put(surface.triangles[i]);
                });
}

void write_surface_stl(const SurfaceOutput& out) {
  const TriangleSurface& surface = out.surface;
  constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (surface.triangles.size() > kMost) {
    fail("{}: expected at most {} triangles in a .stl, found {}", out.name, kMost, surface.triangles.size());
  }
  check_single_range(out);
  // The header must not begin with "solid": readers would take the file for text.
  std::array<char, 80> header{"adamas, binary STL"};
  out.stream.put(header);
  out.stream.put(static_cast<std::uint32_t>(surface.triangles.size()));
  SurfaceProgress progress(out.progress, surface.triangles.size());
  constexpr std::size_t kSize = 12 * sizeof(float) + sizeof(std::uint16_t);
  write_records(out.stream, progress, surface.triangles.size(), kSize,
                [&](RecordCursor& cursor, std::size_t i) {
                  const auto [p, q, r] = surface.triangles[i];
                  const Vec3 &a = surface.points[p], &b = surface.points[q], &c = surface.points[r];
                  cursor.put_vector<float>(normalized(cross(b - a, c - a)));
                  for (const Vec3* corner : {&a, &b, &c}) cursor.put_vector<float>(*corner);
                  cursor.put(std::uint16_t{0});
                });
}

void write_surface_obj(const SurfaceOutput& out) {
  const TriangleSurface& surface = out.surface;
  SurfaceProgress progress(out.progress,
                           surface.points.size() + surface.normals.size() + surface.triangles.size());
  TextBlock text(out.stream);
  text.add("# adamas\n");
  if (single_precision_suffices(surface)) {
    add_vectors<float>(text, progress, "v", surface.points);
  } else {
    add_vectors<double>(text, progress, "v", surface.points);
  }
  add_vectors<float>(text, progress, "vn", surface.normals);
  // Points count from 1, so 64 bits are needed if there are 2^32 of them.
  for_each_line(progress, surface.triangles.size(), [&](std::size_t i) {
    const auto& [p, q, r] = surface.triangles[i];
    const std::size_t a = std::size_t{p} + 1, b = std::size_t{q} + 1, c = std::size_t{r} + 1;
    if (surface.normals.empty()) {
      text.add("f {} {} {}\n", a, b, c);
    } else {
      text.add("f {}//{} {}//{} {}//{}\n", a, a, b, b, c, c);
    }
  });
  text.flush();
}

}  // namespace adamas::io
