#include "core/io/mesh_file.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/file_handle.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/reader_program.h"
#include "core/io/sent_grids.h"
#include "core/io/vtk_checks.h"

namespace adamas::io {

template <>
inline constexpr auto kSentMembers<MeshFile> =
    std::tuple{&MeshFile::kind,      &MeshFile::points,         &MeshFile::face_points,
               &MeshFile::face_ends, &MeshFile::cell_ends,      &MeshFile::arrays,
               &MeshFile::blocks,    &MeshFile::material_names, &MeshFile::remark};

namespace {

/// Throws unless the sizes that the reader has set fit each other, before its arrays are indexed.
void check_sent(const std::string& name, const MeshFile& file) {
  const auto ascends = [](const std::vector<std::uint32_t>& ends, std::size_t last) {
    return std::ranges::is_sorted(ends) && (ends.empty() ? 0 : ends.back()) == last;
  };
  bool fits =
      ascends(file.face_ends, file.face_points.size()) && ascends(file.cell_ends, file.face_ends.size());
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
          .endings = ".vts .pvtu .pvts .vtm .foam .exo .cgns",
          .more_endings = ".e .ex2 .exii .g .gen"};
}

bool is_legacy_mesh(const std::filesystem::path& path) {
  if (file_extension(path) != ".vtk") return false;
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) return false;
  std::array<char, 1024> bytes{};
  const std::size_t size = FileHandle::open(path)->read_some(0, std::as_writable_bytes(std::span(bytes)));
  const std::string_view beginning(bytes.data(), size);
  return beginning.find("DATASET UNSTRUCTURED_GRID") != std::string_view::npos ||
         beginning.find("DATASET STRUCTURED_GRID") != std::string_view::npos;
}

void send_cells(const ReaderRequest& request, ByteSink& sink) {
  sink.put(read_mesh_with_vtk(request.paths.front()));
}

MeshFile read_mesh_file(const std::filesystem::path& path) {
  const ReaderRequest request = request_of(LibraryReader::kCells, path);
  if (file_extension(path) == ".vtu")
    check_vtk_counts(read_xml_tags(supply_file(FileHandle::open(path), 0), path.string()), path);
  MeshFile file = receive_from_child<MeshFile>(request);
  check_sent(path.string(), file);
  show_names(file.arrays, file.material_names);
  for (std::string& block : file.blocks) block = visible_text(block);
  return file;
}

}  // namespace adamas::io
