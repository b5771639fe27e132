// Surfaces as .vtp: the XML format of VTK with its data appended, uncompressed.

#include <fmt/format.h>

#include <cstdint>
#include <limits>

#include "core/io/surface_formats.h"
#include "core/io/surface_writer.h"
#include "core/io/xml_file.h"

namespace adamas::io {

namespace {

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

struct Types {
  bool single;      ///< whether coordinates are floats
  bool short_ints;  ///< whether indices and offsets have 32 bits
};

std::string header(const TriangleSurface& surface, Types types) {
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

}  // namespace

void write_surface_vtp(const SurfaceOutput& out) {
  const TriangleSurface& surface = out.surface;
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  const Types types{single_precision_suffices(surface),
                    surface.points.size() <= kMost && surface.triangles.size() <= kMost / 3};
  SurfaceProgress progress(out.progress, surface.points.size() + surface.normals.size() +
                                             surface.values.size() + 2 * surface.triangles.size());
  out.stream.write(header(surface, types));
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

}  // namespace adamas::io
