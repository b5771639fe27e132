// What the reader process sends of grids and of cells. The libraries that read them are linked for it alone.

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/io/array_names.h"
#include "core/io/dicom_reader.h"
#include "core/io/dream3d_reader.h"
#include "core/io/grid_axes.h"
#include "core/io/grid_file.h"
#include "core/io/input_formats.h"
#include "core/io/mesh_file.h"
#include "core/io/reader_program.h"
#include "core/io/sent_grids.h"
#include "core/io/spy_dump.h"
#include "core/io/volume_import.h"
#include "core/io/zarr_reader.h"

namespace adamas::io {

GridFile read_grid_in_process(const std::filesystem::path& path, const std::string& series,
                              std::optional<std::uint64_t> time) {
  const InputFormat* format = find_input_format(path);
  if (format != nullptr && format->name == kDicom) return read_dicom(path, series);
  if (format != nullptr && format->name == kZarr) return read_zarr(path, time);
  if (format != nullptr && format->name == kDream3d) return read_dream3d(path);
  return read_grid_with_vtk(path);
}

void send_grid(const ReaderRequest& request, ByteSink& sink) {
  const std::filesystem::path path = request.paths.front();
  if (request.reader == LibraryReader::kHdf5Grid) return sink.put(read_hdf5_grid(path));
  sink.put(request.arrays.empty() ? read_grid_in_process(path, request.array, request.time)
                                  : read_dicom_series(path, request.arrays));
}

void send_dicom_series(const ReaderRequest& request, ByteSink& sink) {
  sink.put(list_dicom_series(request.paths.front()));
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
  return !array.has_fractions() && type ? *type : StoredType::kFloat32;
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

}  // namespace

void send_grid_volume(const ReaderRequest& request, ByteSink& sink) {
  const std::string& name = request.name;
  const std::filesystem::path path = request.paths.front();
  const GridFile file = read_grid_in_process(path, request.array, request.time);
  // Of a folder of DICOM, the name is that of a series.
  const GridArray& array = chosen_array(name, file, is_dicom_folder(path) ? std::string() : request.array);
  ImportedVolume volume;
  set_places(name, file, volume);
  if (file.aslant) set_directions(*file.aslant, volume);
  volume.stored = kept_type(array);
  volume.slope = array.slope;
  volume.intercept = array.intercept;
  const auto& n = volume.dimensions;
  if (array.size() != n[0] * n[1] * n[2]) {
    fail("{}: array '{}': expected {} values, found {}", name, array.name, n[0] * n[1] * n[2], array.size());
  }
  const bool wide = volume.stored == StoredType::kFloat32 && array.type != "float32";
  ImportSink import(request, sink);
  import.begin(volume, array.name, wide ? array.type + " samples are read as float32" : "");
  send(array, volume.stored, import);
}

void send_cells(const ReaderRequest& request, ByteSink& sink) {
  const std::filesystem::path path = request.paths.front();
  const bool times = request.reader == LibraryReader::kCellTimes;
  if (is_spy_dump(path))
    return times ? sink.put(spy_dump_times(path)) : sink.put(read_spy_dump(path, request.time));
  const Hdf5Origin origin = hdf5_origin(path);
  if (times) return sink.put(origin == Hdf5Origin::kMesh ? hdf5_mesh_times(path) : mesh_times_with_vtk(path));
  switch (origin) {
    case Hdf5Origin::kSilo:
      return sink.put(read_silo_mesh(path));
    case Hdf5Origin::kMesh:
      return sink.put(read_hdf5_mesh(path, request.time));
    case Hdf5Origin::kVtk:
    case Hdf5Origin::kNone:
      return sink.put(read_mesh_with_vtk(path, request.time));
  }
}

}  // namespace adamas::io
