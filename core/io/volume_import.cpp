#include "core/io/volume_import.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "core/base/error.h"
#include "core/io/array_names.h"
#include "core/io/grid_axes.h"
#include "core/io/grid_file.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/volume_unpacking.h"
#include "core/io/vtk_checks.h"

namespace adamas::io {

namespace {

/// The volume as a source without its samples. Throws Error if a file of that size cannot hold them.
VolumeSource checked_source(const ReaderRequest& request, const ImportedVolume& volume) {
  const std::string& name = request.name;
  VolumeSource source;
  source.name = name;
  if (volume.stored > StoredType::kFloat64) fail("{}: expected a type of numbers, found none", name);
  source.set_stored(volume.stored);
  source.grid.dimensions = volume.dimensions;
  source.grid.spacing = volume.spacing;
  source.grid.origin = volume.origin;
  source.grid.directions = volume.directions;
  source.grid.check(name);
  if (source.sample_file_bytes() / kGreatestExpansion > request.input_bytes)
    fail("{}: expected {}, found a file of {}", name, source.size_text(), request.input_bytes);
  return source;
}

}  // namespace

void ImportSink::begin(const ImportedVolume& volume, const std::string& array, const std::string& remark) {
  checked_source(request_, volume);
  bytes_.put(volume);
  bytes_.put(array);
  bytes_.put(remark);
}

VolumeSource import_volume(const ReaderRequest& request, const VolumeOptions& options, Progress& progress) {
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 20;
  VolumeSource result;
  read_in_child(request, [&](ByteSource& bytes) {
    VolumeSource source = checked_source(request, bytes.get<ImportedVolume>());
    source.array = bytes.get<std::string>();
    source.remark = bytes.get<std::string>();
    SampleSink sink(source, FileHandle::scratch(options.scratch_folder), progress);
    std::vector<std::byte> piece;
    while (sink.found() < sink.expected()) {
      piece.resize(static_cast<std::size_t>(std::min(kPiece, sink.expected() - sink.found())));
      bytes.read(piece.data(), piece.size());
      sink.take(piece);
    }
    result = sink.finish();
  });
  return result;
}

namespace {

const GridArray& chosen_array(const std::string& name, const GridFile& file, const std::string& wanted) {
  const GridArray* found = nullptr;
  std::string names;
  std::vector<std::string> on_cells;
  for (const GridArray& array : file.arrays) {
    if (array.centering != Centering::kPoints) {
      on_cells.push_back(array.name);
      continue;
    }
    names += (names.empty() ? "'" : ", '") + array.name + "'";
    if (!wanted.empty() ? array.name != wanted : array.components != 1) continue;
    if (found != nullptr && wanted.empty()) fail("{}: expected the name of an array, found {}", name, names);
    found = &array;
  }
  if (found == nullptr) {
    fail("{}: expected an array {} on points, found {}", name,
         wanted.empty() ? "of one value per sample" : "'" + wanted + "'",
         names.empty() ? no_points_text(on_cells) : names);
  }
  if (found->components != 1) {
    fail("{}: array '{}': expected one value per sample, found {}", name, wanted, found->components);
  }
  return *found;
}

/// Sets spacing and origin of evenly spaced nodes; if the axes are aslant, nodes are positions along them.
void set_places(const std::string& name, const GridFile& file, ImportedVolume& volume) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto& nodes = file.nodes[static_cast<std::size_t>(axis)];
    volume.spacing[axis] = even_step(name, axis, nodes);
    volume.dimensions[static_cast<std::size_t>(axis)] = nodes.size();
    volume.origin[axis] = nodes.front();
  }
}

void set_directions(const GridAxes& axes, ImportedVolume& volume) {
  const Vec3 first = volume.origin;
  volume.origin = axes.origin;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3& step = axes.directions[static_cast<std::size_t>(axis)];
    volume.origin += first[axis] * step;
    volume.spacing[axis] *= norm(step);
    volume.directions[static_cast<std::size_t>(axis)] = normalized(step);
  }
}

/// The type of the array in the file if its numbers still have it, else float.
StoredType kept_type(const GridArray& array) {
  const auto type = find_stored_type(array.type);
  if (type == StoredType::kFloat64) return *type;
  return array.integral() && type ? *type : StoredType::kFloat32;
}

void send(const GridArray& array, StoredType type, ImportSink& sink) {
  constexpr std::size_t kPiece = std::size_t{1} << 16;
  visit_stored_type(type, [&]<class Stored>(Stored) {
    std::visit(
        [&](const auto& values) {
          std::vector<Stored> piece;
          for (std::size_t begin = 0; begin < values.size(); begin += kPiece) {
            const std::size_t end = std::min(begin + kPiece, values.size());
            piece.clear();
            for (std::size_t i = begin; i < end; ++i) piece.push_back(static_cast<Stored>(values[i]));
            sink.samples(std::as_bytes(std::span(piece)));
          }
        },
        array.values);
  });
}

GridFile read_checked_legacy(const std::filesystem::path& path) {
  check_legacy_vtk(path);
  return read_grid_by_library(path);
}

GridFile read_checked_picture(const std::filesystem::path& path) {
  std::string remark = check_picture(path);
  GridFile file = read_grid_by_library(path);
  file.remark = std::move(remark);
  return file;
}

VolumeSource import_checked_picture(const std::filesystem::path& path, const VolumeOptions& options,
                                    Progress& progress) {
  std::string remark = check_picture(path);
  VolumeSource source = import_grid(path, options, progress);
  if (!remark.empty()) source.remark = std::move(remark);
  return source;
}

}  // namespace

void send_grid_volume(const ReaderRequest& request, ByteSink& sink) {
  const std::string& name = request.name;
  const std::filesystem::path path = request.paths.front();
  const GridFile file = read_grid_in_process(path, request.array);
  // Of a folder of DICOM, the name is that of a series.
  const GridArray& array =
      chosen_array(name, file, std::filesystem::is_directory(path) ? std::string() : request.array);
  ImportedVolume volume;
  set_places(name, file, volume);
  if (file.aslant) set_directions(*file.aslant, volume);
  volume.stored = kept_type(array);
  const auto& n = volume.dimensions;
  if (array.size() != n[0] * n[1] * n[2]) {
    fail("{}: array '{}': expected {} values, found {}", name, array.name, n[0] * n[1] * n[2], array.size());
  }
  const bool wide = volume.stored == StoredType::kFloat32 && array.type != "float32";
  ImportSink import(request, sink);
  import.begin(volume, array.name, wide ? array.type + " samples are read as float32" : "");
  send(array, volume.stored, import);
}

InputFormat legacy_vtk_format() {
  return {.name = "legacy VTK",
          .endings = ".vtk",
          .shown_by = [](std::string_view bytes) { return bytes.starts_with("# vtk DataFile"); },
          .read_grid = read_checked_legacy,
          .find_volume = import_grid,
          .several_arrays = true,
          .may_be_cells = true};
}

InputFormat vtkhdf_format() {
  return {.name = "VTKHDF",
          .endings = ".vtkhdf",
          .read_grid = read_grid_by_library,
          .find_volume = import_grid,
          .several_arrays = true,
          .may_be_cells = true};
}

InputFormat vtk_pieces_format() {
  return {.name = "VTK XML grid in pieces",
          .endings = ".pvti .pvtr",
          .read_grid = read_grid_by_library,
          .find_volume = import_grid,
          .several_arrays = true};
}

InputFormat vtk_picture_format() {
  return {.name = "picture that VTK reads",
          .endings = ".slc",
          .more_endings = ".bmp .pgm .pnm .ppm .jpg .jpeg .tga .pic",
          .read_grid = read_checked_picture,
          .find_volume = import_checked_picture,
          .several_arrays = true};
}

VolumeSource import_grid(const std::filesystem::path& path, const VolumeOptions& options,
                         Progress& progress) {
  ReaderRequest request = request_of(LibraryReader::kGridVolume, path);
  request.array = options.array;
  if (file_extension(path) == ".vtk") check_legacy_vtk(path);
  return import_volume(request, options, progress);
}

}  // namespace adamas::io
