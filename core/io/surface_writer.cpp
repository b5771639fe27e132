#include "core/io/surface_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/error.h"
#include "core/io/header_text.h"
#include "core/io/input_file.h"
#include "core/io/output_stream.h"
#include "core/io/surface_ply.h"
#include "core/io/xml_file.h"

namespace adamas::io {

namespace {

double greatest_coordinate(const std::vector<Vec3>& points) {
  double greatest = 0;
  for (const Vec3& p : points) {
    greatest = std::max({greatest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  return greatest;
}

/// The mean length of the triangles' edges; 0 if there is no triangle.
double mean_edge_length(const TriangleSurface& surface) {
  double sum = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3 &p = surface.points[a], &q = surface.points[b], &r = surface.points[c];
    sum += distance(p, q) + distance(q, r) + distance(r, p);
  }
  return surface.triangles.empty() ? 0 : sum / (3 * static_cast<double>(surface.triangles.size()));
}

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

/// Throws Error unless floats can hold all coordinates.
void check_single_range(const SurfaceOutput& out) {
  const double greatest = greatest_coordinate(out.surface.points);
  if (greatest > double{std::numeric_limits<float>::max()}) {
    fail("{}: expected coordinates that single precision can hold, found {}; .ply, .vtp and .obj hold it",
         out.name, greatest);
  }
}

template <class Real>
void write_ply_points(const SurfaceOutput& out, std::size_t point_bytes, SurfaceProgress& progress) {
  const TriangleSurface& surface = out.surface;
  const bool normals = !surface.normals.empty(), values = !surface.values.empty();
  write_records(out.stream, progress, surface.points.size(), point_bytes,
                [&](RecordCursor& cursor, std::size_t i) {
                  cursor.put_vector<Real>(surface.points[i]);
                  if (normals) cursor.put_vector<float>(surface.normals[i]);
                  if (values) cursor.put(surface.values[i]);
                });
}

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

void write_ply(const SurfaceOutput& out) {
  const TriangleSurface& surface = out.surface;
  SurfacePly layout{surface.points.size(), surface.triangles.size(), single_precision_suffices(surface),
                    !surface.normals.empty()};
  if (!surface.values.empty()) layout.value_name = surface.value_name;
  SurfaceProgress progress(out.progress, surface.points.size() + surface.triangles.size());
  out.stream.write(layout.header());
  layout.single ? write_ply_points<float>(out, layout.point_bytes(), progress)
                : write_ply_points<double>(out, layout.point_bytes(), progress);
  constexpr std::uint8_t kCorners = 3;
  write_records(out.stream, progress, surface.triangles.size(), sizeof(kCorners) + 3 * sizeof(std::uint32_t),
                [&](RecordCursor& cursor, std::size_t i) {
                  cursor.put(kCorners);
                  cursor.put(surface.triangles[i]);
                });
}

void write_stl(const SurfaceOutput& out) {
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

void write_obj(const SurfaceOutput& out) {
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

/// The tags of the arrays, in the order of the file, and the offset of each array's data.
class ArrayTags {
 public:
  /// The tag of the next array, of `bytes` bytes.
  std::string tag(const char* type, const std::string& name, std::size_t components, std::size_t bytes) {
    const std::size_t offset = offset_;
    offset_ += sizeof(std::uint64_t) + bytes;
    return fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
        "offset=\"{}\"/>\n",
        type, name, components, offset);
  }

 private:
  std::size_t offset_ = 0;
};

struct VtpTypes {
  bool single;      ///< whether coordinates are floats
  bool short_ints;  ///< whether indices and offsets have 32 bits
};

std::string vtp_header(const TriangleSurface& surface, VtpTypes types) {
  const std::size_t points = surface.points.size(), triangles = surface.triangles.size();
  const bool normals = !surface.normals.empty(), values = !surface.values.empty();
  const char* real = types.single ? "Float32" : "Float64";
  const char* integer = types.short_ints ? "Int32" : "Int64";
  const std::size_t integer_bytes = types.short_ints ? 4 : 8;
  const std::string value_name = xml_attribute(surface.value_name);
  ArrayTags arrays;
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "  <PolyData>\n"
      "    <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n"
      "      <Points>\n",
      points, triangles);
  text += arrays.tag(real, "Points", 3, 3 * points * (types.single ? sizeof(float) : sizeof(double)));
  text += fmt::format("      </Points>\n      <PointData{}{}>\n", normals ? " Normals=\"Normals\"" : "",
                      values ? " Scalars=\"" + value_name + "\"" : "");
  if (normals) text += arrays.tag("Float32", "Normals", 3, 3 * points * sizeof(float));
  if (values) text += arrays.tag("Float32", value_name, 1, points * sizeof(float));
  text += "      </PointData>\n      <CellData/>\n      <Polys>\n";
  text += arrays.tag(integer, "connectivity", 1, 3 * triangles * integer_bytes);
  text += arrays.tag(integer, "offsets", 1, triangles * integer_bytes);
  text += "      </Polys>\n    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n   _";
  return text;
}

/// Writes an array: its length in bytes, then `count` records.
template <class Fill>
void write_array(OutputStream& stream, SurfaceProgress& progress, std::size_t count, std::size_t size,
                 Fill&& fill) {
  stream.put(std::uint64_t{count * size});
  write_records(stream, progress, count, size, fill);
}

template <class Real>
void write_vectors(OutputStream& stream, SurfaceProgress& progress, const std::vector<Vec3>& vectors) {
  write_array(stream, progress, vectors.size(), 3 * sizeof(Real),
              [&vectors](RecordCursor& cursor, std::size_t i) { cursor.put_vector<Real>(vectors[i]); });
}

template <class Integer>
void write_triangles(OutputStream& stream, SurfaceProgress& progress, const TriangleSurface& surface) {
  write_array(stream, progress, surface.triangles.size(), 3 * sizeof(Integer),
              [&surface](RecordCursor& cursor, std::size_t i) {
                for (const std::uint32_t point : surface.triangles[i])
                  cursor.put(static_cast<Integer>(point));
              });
  write_array(stream, progress, surface.triangles.size(), sizeof(Integer),
              [](RecordCursor& cursor, std::size_t i) { cursor.put(static_cast<Integer>(3 * (i + 1))); });
}

void write_vtp(const SurfaceOutput& out) {
  const TriangleSurface& surface = out.surface;
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  const VtpTypes types{single_precision_suffices(surface),
                       surface.points.size() <= kMost && surface.triangles.size() <= kMost / 3};
  SurfaceProgress progress(out.progress, surface.points.size() + surface.normals.size() +
                                             surface.values.size() + 2 * surface.triangles.size());
  out.stream.write(vtp_header(surface, types));
  types.single ? write_vectors<float>(out.stream, progress, surface.points)
               : write_vectors<double>(out.stream, progress, surface.points);
  if (!surface.normals.empty()) write_vectors<float>(out.stream, progress, surface.normals);
  if (!surface.values.empty()) {
    write_array(out.stream, progress, surface.values.size(), sizeof(float),
                [&surface](RecordCursor& cursor, std::size_t i) { cursor.put(surface.values[i]); });
  }
  types.short_ints ? write_triangles<std::int32_t>(out.stream, progress, surface)
                   : write_triangles<std::int64_t>(out.stream, progress, surface);
  out.stream.write("\n  </AppendedData>\n</VTKFile>\n");
}

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
struct GltfPart {
  std::size_t bytes;
  int target;
  std::string accessor;  ///< JSON of count, type and bounds
};

/// The layout of the buffer, and the JSON that describes it.
class GltfLayout {
 public:
  explicit GltfLayout(const SurfaceOutput& out) : surface_(out.surface), progress_(out.progress) {
    box_ = box_of(surface_.points);
    if (!surface_.triangles.empty() && !single_precision_suffices(surface_)) offset_ = box_.center();
    for (const Vec3& n : surface_.normals) {
      if (squared_norm(n) > 0) continue;
      normals_ = whole_normals(surface_);
      break;
    }
    if (surface_.triangles.empty()) return;
    list_parts();
    for (const GltfPart& part : parts_) bytes_ += part.bytes;
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
  std::vector<Vec3> normals_;    ///< replaced normals; empty if the surface's own can be used
  std::vector<GltfPart> parts_;  ///< the indices are the last part
  std::string attributes_;
  std::size_t bytes_ = 0;
};

/// A point as text, rounded to exactly the floats of the buffer.
std::string float_text(const Vec3& v) {
  const auto number = [](double x) {
    // g++ 12 may leave out the rounding of several numbers at once.
    const volatile float rounded = static_cast<float>(x);
    return double{rounded};
  };
  return fmt::format("{},{},{}", number(v.x), number(v.y), number(v.z));
}

void GltfLayout::list_parts() {
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
      fmt::format(",\"min\":[{}],\"max\":[{}]", float_text(box_.min - offset_),
                  float_text(box_.max - offset_)));
  if (!surface_.normals.empty()) add("NORMAL", "VEC3", 3, "");
  if (!surface_.values.empty()) add("_VALUE", "SCALAR", 1, "");
  parts_.push_back(
      {corners * sizeof(std::uint32_t), kIndexData,
       fmt::format("\"componentType\":{},\"count\":{},\"type\":\"SCALAR\"", kUnsignedInt, corners)});
}

std::array<std::string, 2> GltfLayout::json(const char* uri) const {
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

void check_gltf_size(const SurfaceOutput& out, std::size_t bytes) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (bytes > kMost) {
    fail("{}: expected at most {} bytes of glTF, found {}; .ply and .vtp hold more", out.name, kMost, bytes);
  }
  // glTF does not allow the greatest index as a point.
  if (out.surface.points.size() > kMost) {
    fail("{}: expected at most {} points, found {}", out.name, kMost, out.surface.points.size());
  }
}

void write_glb(const SurfaceOutput& out) {
  check_single_range(out);
  const GltfLayout layout(out);
  const auto [begin, end] = layout.json("");
  std::string text = begin + end;
  text.append((4 - text.size() % 4) % 4, ' ');
  constexpr std::size_t kHeader = 3 * sizeof(std::uint32_t), kChunk = 2 * sizeof(std::uint32_t);
  // All parts consist of four-byte numbers, so the buffer needs no padding.
  const std::size_t size =
      kHeader + kChunk + text.size() + (layout.bytes() == 0 ? 0 : kChunk + layout.bytes());
  check_gltf_size(out, size);
  out.stream.put(std::array{kMagic, kVersion, static_cast<std::uint32_t>(size)});
  out.stream.put(std::array{static_cast<std::uint32_t>(text.size()), kJsonChunk});
  out.stream.write(text);
  if (layout.bytes() == 0) return;
  out.stream.put(std::array{static_cast<std::uint32_t>(layout.bytes()), kBinaryChunk});
  layout.write_buffer(out.stream);
}

void write_gltf(const SurfaceOutput& out) {
  check_single_range(out);
  const GltfLayout layout(out);
  check_gltf_size(out, layout.bytes());
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

struct Format {
  const char* extension;
  SurfaceFormat format;
  void (*write)(const SurfaceOutput& out);
};

constexpr Format kFormats[] = {
    {".ply", SurfaceFormat::kPly, write_ply}, {".stl", SurfaceFormat::kStl, write_stl},
    {".obj", SurfaceFormat::kObj, write_obj}, {".vtp", SurfaceFormat::kVtp, write_vtp},
    {".glb", SurfaceFormat::kGlb, write_glb}, {".gltf", SurfaceFormat::kGltf, write_gltf}};

/// The format by the extension; null for others.
const Format* find_format(const std::filesystem::path& path) {
  const auto* const found = std::ranges::find(kFormats, file_extension(path),
                                              [](const Format& f) { return std::string_view(f.extension); });
  return found == std::end(kFormats) ? nullptr : found;
}

}  // namespace

std::optional<SurfaceFormat> surface_format(const std::filesystem::path& path) {
  const Format* const found = find_format(path);
  return found == nullptr ? std::nullopt : std::optional(found->format);
}

bool single_precision_suffices(const TriangleSurface& surface) {
  using Limits = std::numeric_limits<float>;
  const double greatest = greatest_coordinate(surface.points);
  if (greatest == 0) return true;
  if (greatest > double{Limits::max()}) return false;
  const double length = mean_edge_length(surface);
  return length >= double{Limits::min()} && greatest <= 4096 * length;
}

void write_surface(const std::filesystem::path& path, const TriangleSurface& surface, Progress& progress) {
  const std::string name = path.string();
  const Format* const format = find_format(path);
  if (format == nullptr)
    fail("{}: expected .ply, .stl, .obj, .vtp, .glb or .gltf for a surface, found '{}'", name,
         file_extension(path));
  surface.check(name);
  OutputStream stream(path);
  format->write({name, surface, stream, progress});
  stream.finish();
}

}  // namespace adamas::io
