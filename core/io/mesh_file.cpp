#include "core/io/mesh_file.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/data/unstructured_mesh.h"
#include "core/io/file_handle.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/mesh_builder.h"
#include "core/io/reader_program.h"
#include "core/io/sent_grids.h"
#include "core/io/vtk_checks.h"

namespace adamas::io {

template <>
inline constexpr auto kSentMembers<MeshFile> =
    std::tuple{&MeshFile::kind,      &MeshFile::points, &MeshFile::face_points,  &MeshFile::face_ends,
               &MeshFile::cell_ends, &MeshFile::arrays, &MeshFile::blocks,       &MeshFile::material_names,
               &MeshFile::remark,    &MeshFile::flat,   &MeshFile::block_of_cell};

namespace {

/// Throws unless the sizes that the reader has set fit each other, before its arrays are indexed.
void check_sent(const std::string& name, const MeshFile& file) {
  const auto ascends = [](const std::vector<std::uint32_t>& ends, std::size_t last, std::size_t least) {
    std::size_t before = 0;
    for (const std::uint32_t end : ends) {
      if (end < before + least) return false;
      before = end;
    }
    return before == last;
  };
  bool fits = ascends(file.face_ends, file.face_points.size(), 3) &&
              ascends(file.cell_ends, file.face_ends.size(), 1) &&
              (!file.flat || file.cell_ends.size() == file.face_ends.size()) &&
              (file.blocks.empty() || file.block_of_cell.size() == file.cell_ends.size());
  for (const std::int32_t block : file.block_of_cell)
    fits = fits && block >= 0 && static_cast<std::size_t>(block) < file.blocks.size();
  for (const GridArray& array : file.arrays) {
    const std::size_t items =
        array.centering == Centering::kCells ? file.cell_ends.size() : file.points.size();
    fits = fits && array.components > 0 && array.size() == items * static_cast<std::size_t>(array.components);
  }
  if (!fits) fail("{}: expected arrays that fit the mesh, found others", name);
}

}  // namespace

InputFormat cells_format() {
  return {.name = "cells of a mesh",
          .kind = InputKind::kCells,
          .endings = ".vts .pvtu .pvts .vtm .vtkhdf .foam .exo .cgns .silo .pdb",
          .more_endings = ".e .ex2 .exii .g .gen"};
}

namespace {

/// Returns whether a file is one of Silo, by its ending or, for that of HDF5, by a name that Silo writes,
/// which stands near the beginning or the end of a file.
bool is_silo(const std::filesystem::path& path) {
  const std::string extension = file_extension(path);
  if (extension == ".silo" || extension == ".pdb") return true;
  if (extension != ".h5" && extension != ".hdf5") return false;
  constexpr std::size_t kSearched = 4 << 20;
  std::string bytes(kSearched, '\0');
  const auto file = FileHandle::open(path);
  const auto found_at = [&](std::uint64_t offset) {
    const std::size_t size = file->read_some(offset, std::as_writable_bytes(std::span(bytes)));
    return std::string_view(bytes).substr(0, size).find("_silolibinfo") != std::string_view::npos;
  };
  const std::uint64_t size = std::filesystem::file_size(path);
  return found_at(0) || (size > kSearched && found_at(size - kSearched));
}

bool is_legacy_mesh(const std::filesystem::path& path) {
  std::array<char, 1024> bytes{};
  const std::size_t size = FileHandle::open(path)->read_some(0, std::as_writable_bytes(std::span(bytes)));
  const std::string_view beginning(bytes.data(), size);
  return beginning.find("DATASET UNSTRUCTURED_GRID") != std::string_view::npos ||
         beginning.find("DATASET STRUCTURED_GRID") != std::string_view::npos;
}

/// Returns whether the name that resampled meshes have is missing at the beginning of a file, where adamas
/// writes it.
bool is_foreign_vtu(const std::filesystem::path& path) {
  std::string bytes(std::size_t{1} << 20, '\0');
  const std::size_t size = FileHandle::open(path)->read_some(0, std::as_writable_bytes(std::span(bytes)));
  return std::string_view(bytes).substr(0, size).find(fmt::format("Name=\"{}\"", kResampledVersion)) ==
         std::string_view::npos;
}

}  // namespace

bool is_mesh_by_header(const std::filesystem::path& path) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) return false;
  const std::string extension = file_extension(path);
  if (extension == ".vtk") return is_legacy_mesh(path);
  return extension == ".vtu" ? is_foreign_vtu(path) : is_silo(path);
}

void send_cells(const ReaderRequest& request, ByteSink& sink) {
  const std::filesystem::path path = request.paths.front();
  sink.put(is_silo(path) ? read_silo_mesh(path) : read_mesh_with_vtk(path));
}

MeshFile read_mesh_file(const std::filesystem::path& path) {
  ReaderRequest request = request_of(LibraryReader::kCells, path);
  if (file_extension(path) == ".vtu")
    check_vtk_counts(read_xml_tags(supply_file(FileHandle::open(path), 0), path.string()), path);
  // Such a file stands for others beside it.
  const std::string extension = file_extension(path);
  for (const char* whole : {".pvtu", ".pvts", ".vtm", ".silo", ".pdb"}) {
    if (extension == whole) request.input_bytes = size_of_folder(path.parent_path());
  }
  MeshFile file = receive_from_child<MeshFile>(request);
  check_sent(path.string(), file);
  show_names(file.arrays, file.material_names);
  for (std::string& block : file.blocks) block = visible_text(block);
  return file;
}

void extrude(MeshFile& file, double height) {
  const auto count = static_cast<std::uint32_t>(file.points.size());
  for (std::uint32_t p = 0; p < count; ++p) file.points.push_back(file.points[p] + Vec3{0, 0, height});
  const std::vector<std::uint32_t> points = std::exchange(file.face_points, {}),
                                   ends = std::exchange(file.face_ends, {});
  std::vector<std::uint32_t> face;
  std::size_t begin = 0;
  file.cell_ends.clear();
  for (const std::uint32_t end : ends) {
    const std::span<const std::uint32_t> own = std::span(points).subspan(begin, end - begin);
    append_face(own, file);
    face.clear();
    for (const std::uint32_t p : own) face.push_back(p + count);
    append_face(face, file);
    for (std::size_t i = 0; i < own.size(); ++i) {
      const std::uint32_t a = own[i], b = own[(i + 1) % own.size()];
      append_face(std::array{a, b, b + count, a + count}, file);
    }
    end_cell(file);
    begin = end;
  }
  for (GridArray& array : file.arrays) {
    if (array.centering == Centering::kCells) continue;
    std::visit([](auto& values) { values.insert(values.end(), values.begin(), values.end()); }, array.values);
  }
  file.flat = false;
}

}  // namespace adamas::io
