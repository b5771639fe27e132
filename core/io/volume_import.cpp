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
  source.slope = volume.slope;
  source.intercept = volume.intercept;
  if (source.scaled()) source.grid.type = SampleType::kFloat32;
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
  request.time = options.time;
  if (file_extension(path) == ".vtk") check_legacy_vtk(path);
  return import_volume(request, options, progress);
}

}  // namespace adamas::io
