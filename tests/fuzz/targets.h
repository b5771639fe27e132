#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/io/decompression.h"
#include "core/io/grid_file.h"
#include "core/io/labelled_network.h"
#include "core/io/meta_image.h"
#include "core/io/mrc_header.h"
#include "core/io/network_ply.h"
#include "core/io/nifti_header.h"
#include "core/io/nrrd_header.h"
#include "core/io/spy_dump.h"
#include "core/io/surface_ply.h"
#include "core/io/volume_reader.h"
#include "core/io/vti_header.h"
#include "core/io/vtk_checks.h"
#include "interfaces/reference_client/program_messages.h"
#include "tests/fuzz/require.h"
#include "tests/support/text_supply.h"

/// What the fuzz targets, and the tests that replay the corpus, do with any bytes. Each function lets Error
/// through at bad input; anything else that it throws is a fault.
namespace adamas::fuzz {

using namespace interfaces;
using namespace io;

inline void network_text(std::string_view bytes) {
  const InterfaceMesh mesh = to_interface_mesh(parse_labelled_network(bytes, "fuzz"), {}, "fuzz");
  for (const InterfaceTriangle& t : mesh.triangles) {
    for (const auto corner : t.points) require(corner < mesh.points.size(), "corner out of range");
  }
}

inline void network_ply(std::string_view bytes) {
  const InterfaceMesh mesh = parse_network_ply(std::string(bytes), "fuzz");
  for (const InterfaceTriangle& t : mesh.triangles) {
    for (const auto corner : t.points) require(corner < mesh.points.size(), "corner out of range");
    for (const MaterialId side : {t.front, t.back})
      require(side.value < mesh.materials.size(), "material out of range");
  }
}

inline void surface_ply(std::string_view bytes) {
  const TriangleSurface surface = parse_surface_ply(std::string(bytes), "fuzz");
  for (const auto& triangle : surface.triangles) {
    for (const auto corner : triangle) require(corner < surface.points.size(), "corner out of range");
  }
  require(surface.normals.empty() || surface.normals.size() == surface.points.size(),
          "other normals than points");
  require(surface.values.empty() || surface.values.size() == surface.points.size(),
          "other values than points");
}

inline void region_names(std::string_view bytes) {
  const RegionTable table = parse_region_table(bytes, "fuzz");
  for (const auto& [label, name] : table.names) require(!name.empty(), "empty name");
  for (const auto& [label, colour] : table.colours)
    require(table.names.contains(label), "a colour of nothing");
}

inline void nrrd_header(std::string_view bytes) {
  const NrrdHeader header = parse_nrrd_header(bytes, "fuzz");
  require(header.header_bytes <= bytes.size(), "header longer than the text");
  require(header.components * header.sizes[0] * header.sizes[1] * header.sizes[2] > 0, "no values");
}

inline void inflate(std::string_view bytes) {
  std::size_t received = 0;
  const std::uint64_t size =
      inflate_stream(test::supply_text(bytes), "fuzz", [&received](std::string_view piece) {
        received += piece.size();
        return true;
      });
  require(size == received, "another size than the pieces'");
}

inline void bunzip(std::string_view bytes) {
  std::uint64_t received = 0;
  const std::uint64_t size =
      bunzip_stream(test::supply_text(bytes), "fuzz", [&received](std::string_view piece) {
        received += piece.size();
        return true;
      });
  require(size == received, "another size than the pieces'");
  require(size <= bytes.size() * kGreatestBunzip, "more than bzip2 can pack");
}

/// A whole message is written again as it was read.
inline void mesher_reply(std::string_view bytes) {
  const std::vector<char> given(bytes.begin(), bytes.end());
  const auto reply = decode<MesherReply>(given);
  if (!reply) fail("expected a message, found other bytes");
  require(encode(*reply) == given, "another message");
}

/// Puts the bytes into a file, for functions that read files.
class TemporaryFile {
 public:
  TemporaryFile(std::string_view bytes, const char* extension) {
    std::string pattern = (std::filesystem::temp_directory_path() / "adamas-fuzz-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = pattern;
    path_ = folder_ / (std::string("a") + extension);
    std::ofstream(path_, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  ~TemporaryFile() {
    std::error_code code;
    std::filesystem::remove_all(folder_, code);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path folder_, path_;
};

inline void legacy_vtk(std::string_view bytes) {
  const TemporaryFile file(bytes, ".vtk");
  check_legacy_vtk(file.path());
}

/// The bytes are a whole MetaImage with its samples, which is read as a grid.
inline void meta_image(std::string_view bytes) {
  const TemporaryFile file(bytes, ".mha");
  const GridFile grid = read_grid_file(file.path());
  require(grid.arrays.size() == 1, "no array");
}

inline void image(const ImageHeader& header) {
  const auto last = header.times > 1 ? std::optional(header.times - 1) : std::nullopt;
  const VolumeSource source = volume_of(header, "", last);
  source.grid.check("fuzz");
  require(source.sample_file_bytes() >= source.grid.samples(), "more samples than bytes");
}

inline void nrrd_volume(std::string_view bytes) { image(nrrd_image(bytes, "fuzz.nrrd")); }

inline void meta_image_volume(std::string_view bytes) { image(adamas::io::meta_image(bytes, "fuzz.mha")); }

inline void vti_volume(std::string_view bytes) {
  const std::vector<XmlTag> tags = read_xml_tags(test::supply_text(bytes), "fuzz");
  std::uint64_t before = 0;
  for (const XmlTag& tag : tags) {
    require(before <= tag.end && tag.end <= bytes.size(), "a tag at no place behind the one before");
    require(!tag.text || (tag.end <= *tag.text && *tag.text <= bytes.size()), "a text before its tag");
    before = tag.end;
  }
  const ImageHeader header = vti_header(tags, "fuzz.vti");
  image(header);
  for (const ImageArray& array : header.arrays)
    require(array.source.header_bytes <= bytes.size(), "header longer than the text");
}

inline void nifti_volume(std::string_view bytes) { image(nifti_image(bytes, "fuzz.nii")); }

inline void mrc_volume(std::string_view bytes) {
  const ImageHeader header = mrc_image(bytes, "fuzz.mrc");
  image(header);
  require(header.times >= 1 && header.arrays.at(0).source.header_bytes >= 1024, "samples in the header");
}

/// The bytes are a whole array of NumPy, or an archive of some, which is read as a grid.
inline void numpy_array(std::string_view bytes) {
  const TemporaryFile file(bytes, ".npz");
  require(!read_grid_file(file.path()).arrays.empty(), "no array");
}

/// The bytes are a whole dump of CTH of one processor.
inline void spy_dump(std::string_view bytes) {
  const TemporaryFile file(bytes, ".0");
  const MeshFile mesh = read_spy_dump(file.path());
  for (const GridArray& array : mesh.arrays)
    require(array.size() == mesh.cell_ends.size(), "other values than cells");
  for (const std::uint32_t point : mesh.face_points)
    require(point < mesh.points.size(), "corner out of range");
}

/// The bytes are a whole .vti, which is read as a grid and as a volume. Encoded or compressed arrays are
/// unpacked.
inline void packed_vti(std::string_view bytes) {
  const TemporaryFile file(bytes, ".vti");
  try {
    const ImageHeader header = vti_header(read_xml_tags(test::supply_text(bytes), "fuzz"), file.path());
    if (!header.arrays.empty()) {
      const GridFile grid = grid_of(header, file.path());
      require(grid.arrays.size() == header.arrays.size(), "arrays from nowhere");
    }
  } catch (const Error&) {
    // The volume has one array, which may be whole where others are not.
  }
  VolumeReader reader = open_volume(file.path());
  require(reader.grid().bytes() <= (bytes.size() + 1) * 8 * kGreatestInflation, "samples from nowhere");
  std::vector<std::byte> plane(reader.grid().plane_bytes());
  for (std::uint64_t k = 0; k < reader.grid().dimensions[2]; ++k) reader.read_plane(k, plane);
}

}  // namespace adamas::fuzz
