// Surfaces as glTF 2.0: .glb, or .gltf with its buffer in base64.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/error.h"
#include "core/io/output_stream.h"
#include "core/io/surface_formats.h"
#include "core/io/surface_writer.h"

namespace adamas::io {

namespace {

/// Chunks of a .glb, and the words of its header.
constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
/// Targets of the views of a buffer, and types of components.
constexpr int kPointData = 34962, kIndexData = 34963, kFloat = 5126, kUnsignedInt = 5125;

Box3 box_of(const std::vector<Vec3>& points) {
  Box3 box;
  for (const Vec3& p : points) box.extend(p);
  return box;
}

/// The normals, with zero ones, which glTF does not allow, replaced by those of the triangles round the
/// point, or else by z.
std::vector<Vec3> whole_normals(const TriangleSurface& surface) {
  std::vector<Vec3> sums(surface.points.size());
  for (const auto& corners : surface.triangles) {
    const Vec3& a = surface.points[corners[0]];
    const Vec3 normal = cross(surface.points[corners[1]] - a, surface.points[corners[2]] - a);
    for (const std::uint32_t corner : corners) sums[corner] += normal;
  }
  std::vector<Vec3> normals = surface.normals;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (squared_norm(normals[i]) > 0) continue;
    const double scale = std::max({std::abs(sums[i].x), std::abs(sums[i].y), std::abs(sums[i].z)});
    normals[i] = scale > 0 && std::isfinite(scale) ? normalized((1 / scale) * sums[i]) : Vec3{0, 0, 1};
  }
  return normals;
}

/// A view of the buffer, and its accessor.
struct Part {
  std::size_t bytes;
  int target;
  std::string accessor;  ///< JSON of count, type and bounds
};

/// The layout of the buffer, and the JSON that describes it.
class Layout {
 public:
  explicit Layout(const SurfaceOutput& out) : surface_(out.surface), progress_(out.progress) {
    box_ = box_of(surface_.points);
    if (!surface_.triangles.empty() && !single_precision_suffices(surface_)) offset_ = box_.center();
    for (const Vec3& n : surface_.normals) {
      if (squared_norm(n) > 0) continue;
      normals_ = whole_normals(surface_);
      break;
    }
    if (surface_.triangles.empty()) return;
    list_parts();
    for (const Part& part : parts_) bytes_ += part.bytes;
  }

  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  /// The document up to the last member of the buffer, `uri`, and the rest of the document.
  [[nodiscard]] std::array<std::string, 2> json(const char* uri) const;

  template <class Stream>
  void write_buffer(Stream& stream) const {
    if (bytes_ == 0) return;
    SurfaceProgress progress(progress_, surface_.points.size() + surface_.normals.size() +
                                            surface_.values.size() + surface_.triangles.size());
    write_records(stream, progress, surface_.points.size(), 3 * sizeof(float),
                  [this](RecordCursor& to, std::size_t i) { to.put_vector<float>(placed(i)); });
    const std::vector<Vec3>& normals = normals_.empty() ? surface_.normals : normals_;
    write_records(stream, progress, normals.size(), 3 * sizeof(float),
                  [&normals](RecordCursor& to, std::size_t i) { to.put_vector<float>(normals[i]); });
    write_records(stream, progress, surface_.values.size(), sizeof(float),
                  [this](RecordCursor& to, std::size_t i) { to.put(surface_.values[i]); });
    write_records(stream, progress, surface_.triangles.size(), 3 * sizeof(std::uint32_t),
                  [this](RecordCursor& to, std::size_t i) { to.put(surface_.triangles[i]); });
  }

 private:
  [[nodiscard]] Vec3 placed(std::size_t i) const { return surface_.points[i] - offset_; }
  void list_parts();

  const TriangleSurface& surface_;
  Progress& progress_;
  Box3 box_;
  Vec3 offset_;
  std::vector<Vec3> normals_;  ///< replaced normals; empty if the surface's own can be used
  std::vector<Part> parts_;    ///< the indices are the last part
  std::string attributes_;
  std::size_t bytes_ = 0;
};

/// A point as text, rounded to exactly the floats of the buffer.
std::string single(const Vec3& v) {
  const auto number = [](double x) {
    // g++ 12 may leave out the rounding of several numbers at once.
    const volatile float rounded = static_cast<float>(x);
    return double{rounded};
  };
  return fmt::format("{},{},{}", number(v.x), number(v.y), number(v.z));
}

void Layout::list_parts() {
  const std::size_t points = surface_.points.size(), corners = 3 * surface_.triangles.size();
  const auto add = [&](const char* attribute, const char* type, std::size_t components,
                       const std::string& more) {
    attributes_ += fmt::format("{}\"{}\":{}", parts_.empty() ? "" : ",", attribute, parts_.size());
    parts_.push_back(
        {points * components * sizeof(float), kPointData,
         fmt::format("\"componentType\":{},\"count\":{},\"type\":\"{}\"{}", kFloat, points, type, more)});
  };
  // Rounding keeps the order, so that these are the bounds of the rounded points too.
  add("POSITION", "VEC3", 3,
      fmt::format(",\"min\":[{}],\"max\":[{}]", single(box_.min - offset_), single(box_.max - offset_)));
  if (!surface_.normals.empty()) add("NORMAL", "VEC3", 3, "");
  if (!surface_.values.empty()) add("_VALUE", "SCALAR", 1, "");
  parts_.push_back(
      {corners * sizeof(std::uint32_t), kIndexData,
       fmt::format("\"componentType\":{},\"count\":{},\"type\":\"SCALAR\"", kUnsignedInt, corners)});
}

std::array<std::string, 2> Layout::json(const char* uri) const {
  const std::string begin = "{\"asset\":{\"version\":\"2.0\",\"generator\":\"adamas\"},\"scene\":0,";
  // glTF allows no empty buffers, views and accessors.
  if (bytes_ == 0) return {begin + "\"scenes\":[{}]}", ""};
  std::string text = begin + "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0";
  if (squared_norm(offset_) > 0) {
    text += fmt::format(",\"translation\":[{},{},{}]", offset_.x, offset_.y, offset_.z);
  }
  text += fmt::format(
      "}}],\"meshes\":[{{\"primitives\":[{{\"attributes\":{{{}}},\"indices\":{},\"material\":0}}]}}],"
      "\"materials\":[{{\"doubleSided\":true,\"pbrMetallicRoughness\":{{\"baseColorFactor\":"
      "[0.8,0.8,0.8,1],\"metallicFactor\":0,\"roughnessFactor\":0.6}}}}],\"accessors\":[",
      attributes_, parts_.size() - 1);
  std::string views;
  std::size_t at = 0;
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const char* comma = p == 0 ? "" : ",";
    text += fmt::format("{}{{\"bufferView\":{},{}}}", comma, p, parts_[p].accessor);
    views += fmt::format("{}{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{},\"target\":{}}}", comma, at,
                         parts_[p].bytes, parts_[p].target);
    at += parts_[p].bytes;
  }
  text += fmt::format("],\"bufferViews\":[{}],\"buffers\":[{{\"byteLength\":{}{}", views, bytes_, uri);
  return {text, "}]}"};
}

void check_size(const SurfaceOutput& out, std::size_t bytes) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (bytes > kMost) {
    fail("{}: expected at most {} bytes of glTF, found {}; .ply and .vtp hold more", out.name, kMost, bytes);
  }
  // glTF does not allow the greatest index as a point.
  if (out.surface.points.size() > kMost) {
    fail("{}: expected at most {} points, found {}", out.name, kMost, out.surface.points.size());
  }
}

}  // namespace

void write_surface_glb(const SurfaceOutput& out) {
  check_single_range(out);
  const Layout layout(out);
  const auto [begin, end] = layout.json("");
  std::string text = begin + end;
  text.append((4 - text.size() % 4) % 4, ' ');
  constexpr std::size_t kHeader = 3 * sizeof(std::uint32_t), kChunk = 2 * sizeof(std::uint32_t);
  // All parts consist of four-byte numbers, so the buffer needs no padding.
  const std::size_t size =
      kHeader + kChunk + text.size() + (layout.bytes() == 0 ? 0 : kChunk + layout.bytes());
  check_size(out, size);
  out.stream.put(std::array{kMagic, kVersion, static_cast<std::uint32_t>(size)});
  out.stream.put(std::array{static_cast<std::uint32_t>(text.size()), kJsonChunk});
  out.stream.write(text);
  if (layout.bytes() == 0) return;
  out.stream.put(std::array{static_cast<std::uint32_t>(layout.bytes()), kBinaryChunk});
  layout.write_buffer(out.stream);
}

void write_surface_gltf(const SurfaceOutput& out) {
  check_single_range(out);
  const Layout layout(out);
  check_size(out, layout.bytes());
  const auto [begin, end] = layout.json(",\"uri\":\"data:application/octet-stream;base64,");
  out.stream.write(begin);
  if (layout.bytes() > 0) {
    Base64Stream encoded(out.stream);
    layout.write_buffer(encoded);
    encoded.finish();
    out.stream.write("\"");
    out.stream.write(end);
  }
  out.stream.write("\n");
}

}  // namespace adamas::io
