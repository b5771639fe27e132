#include "core/io/mesh_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>

#include "adamas/series.h"
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
          .endings = ".vts .pvtu .pvts .vtm .vth .vtkhdf .foam .exo .cgns .silo .pdb",
          .more_endings = ".vthb .e .ex2 .exii .g .gen"};
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
  if (request.reader == LibraryReader::kCellTimes) {
    sink.put(mesh_times_with_vtk(path));
  } else {
    sink.put(is_silo(path) ? read_silo_mesh(path) : read_mesh_with_vtk(path, request.time));
  }
}

}  // namespace adamas::io

std::vector<double> adamas::mesh_times(const std::filesystem::path& path) {
  using namespace io;
  check_input_file(path);
  if (kind_by_format(path) != InputKind::kCells) return {};
  return receive_from_child<std::vector<double>>(request_of(LibraryReader::kCellTimes, path));
}

namespace adamas::io {

MeshFile read_mesh_file(const std::filesystem::path& path, std::optional<std::uint64_t> time) {
  ReaderRequest request = request_of(LibraryReader::kCells, path);
  if (file_extension(path) == ".vtu")
    check_vtk_counts(read_xml_tags(supply_file(FileHandle::open(path), 0), path.string()), path);
  request.time = time;
  MeshFile file = receive_from_child<MeshFile>(request);
  check_sent(path.string(), file);
  show_names(file.arrays, file.material_names);
  for (std::string& block : file.blocks) block = visible_text(block);
  return file;
}

namespace {

/// Moves a flat mesh through `layers` places, each given by `move`; the last one is the first again if the
/// way is closed. Each cell becomes one between each two places.
template <class Move>
void sweep(MeshFile& file, std::uint32_t layers, bool closed, const Move& move) {
  const std::vector<Vec3> flat = std::exchange(file.points, {});
  const std::vector<std::uint32_t> points = std::exchange(file.face_points, {}),
                                   ends = std::exchange(file.face_ends, {});
  file.cell_ends.clear();
  // Points that stay at their places stay one.
  std::vector<std::vector<std::uint32_t>> numbers(layers);
  for (std::uint32_t layer = 0; layer < layers; ++layer) {
    for (std::uint32_t p = 0; p < flat.size(); ++p) {
      const Vec3 at = move(flat[p], layer);
      const bool stays = layer > 0 && at == file.points[numbers[0][p]];
      numbers[layer].push_back(stays ? numbers[0][p] : static_cast<std::uint32_t>(file.points.size()));
      if (!stays) file.points.push_back(at);
    }
  }
  std::vector<std::uint32_t> face;
  for (std::uint32_t layer = 0; layer + (closed ? 0 : 1) < layers; ++layer) {
    const auto &below = numbers[layer], &above = numbers[(layer + 1) % layers];
    std::size_t begin = 0;
    for (const std::uint32_t end : ends) {
      const std::span<const std::uint32_t> own = std::span(points).subspan(begin, end - begin);
      for (const auto* side : {&below, &above}) {
        face.clear();
        for (const std::uint32_t p : own) face.push_back((*side)[p]);
        append_face(face, file);
      }
      for (std::size_t i = 0; i < own.size(); ++i) {
        const std::uint32_t a = own[i], b = own[(i + 1) % own.size()];
        append_face(std::array{below[a], below[b], above[b], above[a]}, file);
      }
      end_cell(file);
      begin = end;
    }
  }
  const std::uint32_t copies = closed ? layers : layers - 1;
  const auto repeat = [](auto& values, std::uint32_t times) {
    const std::size_t count = values.size();
    values.reserve(count * times);
    for (std::uint32_t t = 1; t < times; ++t)
      values.insert(values.end(), values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
  };
  for (GridArray& array : file.arrays) {
    if (array.centering == Centering::kCells) {
      std::visit([&](auto& values) { repeat(values, copies); }, array.values);
      continue;
    }
    const auto components = static_cast<std::size_t>(array.components);
    const auto move_values = [&](auto& values) {
      const auto of_flat = std::exchange(values, {});
      values.resize(file.points.size() * components);
      for (const auto& own : numbers) {
        for (std::size_t p = 0; p < own.size(); ++p)
          std::copy_n(of_flat.begin() + static_cast<std::ptrdiff_t>(p * components), components,
                      values.begin() + static_cast<std::ptrdiff_t>(own[p] * components));
      }
    };
    std::visit(move_values, array.values);
  }
  repeat(file.block_of_cell, copies);
  file.flat = false;
}

}  // namespace

void extrude(MeshFile& file, double height) {
  sweep(file, 2, false, [height](const Vec3& p, std::uint32_t layer) {
    return p + Vec3{0, 0, layer * height};
  });
}

void revolve(const std::string& name, MeshFile& file) {
  constexpr std::uint32_t kSectors = 48;
  constexpr double kAngle = 2 * std::numbers::pi / kSectors;
  double most = 0;
  for (const Vec3& p : file.points) most = std::max(most, std::abs(p.x));
  for (Vec3& p : file.points) {
    if (p.x < -1e-9 * most) fail("{}: --axisymmetric: expected x of 0 or more, found {}", name, p.x);
    // Up to round-off, a point on the axis lies on it.
    if (p.x < 1e-9 * most) p.x = 0;
  }
  // A polygon of this radius has the area of the circle.
  const double radius = std::sqrt(kAngle / std::sin(kAngle));
  sweep(file, kSectors, true, [radius](const Vec3& p, std::uint32_t layer) {
    if (p.x == 0) return p;
    return Vec3{radius * p.x * std::cos(layer * kAngle), p.y, p.z + radius * p.x * std::sin(layer * kAngle)};
  });
}

}  // namespace adamas::io
