#include "core/io/input_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/io/file_handle.h"
#include "core/io/input_file.h"
#include "core/io/mesh_file.h"
#include "core/io/network_ply.h"

/// Every format, one per line, in the order in which they are listed and tried.
#define ADAMAS_INPUT_FORMATS(FORMAT) \
  FORMAT(vti_format)                 \
  FORMAT(vtr_format)                 \
  FORMAT(vtk_pieces_format)          \
  FORMAT(legacy_vtk_format)          \
  FORMAT(nrrd_format)                \
  FORMAT(meta_image_format)          \
  FORMAT(nifti_format)               \
  FORMAT(hdf5_format)                \
  FORMAT(dream3d_format)             \
  FORMAT(numpy_format)               \
  FORMAT(mrc_format)                 \
  FORMAT(dicom_format)               \
  FORMAT(zarr_format)                \
  FORMAT(tiff_format)                \
  FORMAT(png_format)                 \
  FORMAT(vtk_picture_format)         \
  FORMAT(vtu_format)                 \
  FORMAT(cells_format)               \
  FORMAT(vtkhdf_format)              \
  FORMAT(vtp_format)                 \
  FORMAT(network_format)             \
  FORMAT(surface_format)

namespace adamas::io {

#define ADAMAS_DECLARE(format) InputFormat format();
ADAMAS_INPUT_FORMATS(ADAMAS_DECLARE)
#undef ADAMAS_DECLARE

namespace {

/// Calls `use` with each extension in a text.
template <class Use>
void for_each_ending(std::string_view endings, const Use& use) {
  while (!endings.empty()) {
    const std::size_t end = std::min(endings.find(' '), endings.size());
    use(endings.substr(0, end));
    endings.remove_prefix(std::min(end + 1, endings.size()));
  }
}

template <class Wanted>
std::string list(const Wanted& wanted, std::string_view last) {
  std::vector<std::string_view> endings;
  for (const InputFormat& format : input_formats()) {
    if (wanted(format)) for_each_ending(format.endings, [&](std::string_view e) { endings.push_back(e); });
  }
  std::string text;
  for (std::size_t i = 0; i < endings.size(); ++i) {
    if (i > 0) text += i + 1 == endings.size() ? fmt::format(" {} ", last) : ", ";
    text += endings[i];
  }
  return text;
}

}  // namespace

bool InputFormat::has_ending(std::string_view ending) const {
  bool found = false;
  const auto look = [&](std::string_view one) { found = found || one == ending; };
  for_each_ending(endings, look);
  for_each_ending(more_endings, look);
  return found;
}

std::span<const InputFormat> input_formats() {
#define ADAMAS_CALL(format) format(),
  static const std::array kFormats{ADAMAS_INPUT_FORMATS(ADAMAS_CALL)};
#undef ADAMAS_CALL
  return kFormats;
}

const InputFormat* find_format_by_name(const std::filesystem::path& path) {
  const std::string ending = file_extension(path);
  const auto formats = input_formats();
  std::error_code unknown;
  const bool is_folder = std::filesystem::is_directory(path, unknown);
  const auto found = std::find_if(formats.begin(), formats.end(), [&](const InputFormat& format) {
    if (is_folder) return format.is_folder != nullptr && format.is_folder(path);
    return format.has_ending(ending);
  });
  return found == formats.end() ? nullptr : &*found;
}

const InputFormat* find_input_format(const std::filesystem::path& path) {
  if (const InputFormat* format = find_format_by_name(path)) return format;
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown)) return nullptr;
  std::array<char, 1024> bytes{};
  const std::size_t size = FileHandle::open(path)->read_some(0, std::as_writable_bytes(std::span(bytes)));
  const std::string_view beginning(bytes.data(), size);
  const auto formats = input_formats();
  const auto found = std::find_if(formats.begin(), formats.end(), [&](const InputFormat& format) {
    return format.shown_by != nullptr && format.shown_by(beginning);
  });
  return found == formats.end() ? nullptr : &*found;
}

std::string name_unread_format(const std::filesystem::path& path) {
  std::array<char, 256> bytes{};
  const std::size_t size = FileHandle::open(path)->read_some(0, std::as_writable_bytes(std::span(bytes)));
  const std::string_view beginning(bytes.data(), size);
  constexpr const char* kMeshio = "'meshio convert' makes a .vtu of it";
  if (beginning.starts_with("MFEM")) return "a mesh of MFEM, which can save .vtu itself";
  if (beginning.starts_with("$MeshFormat")) return fmt::format("a mesh of Gmsh: {}", kMeshio);
  if (beginning.starts_with("*HEADING") || beginning.starts_with("*Heading"))
    return fmt::format("a mesh of Abaqus: {}", kMeshio);
  if (beginning.starts_with("*KEYWORD")) return fmt::format("a mesh of LS-DYNA: {}", kMeshio);
  if (beginning.find("type: ensight") != std::string_view::npos ||
      beginning.find("type:\tensight") != std::string_view::npos)
    return "a case of EnSight: ParaView reads it and saves .vtu";
  if (beginning.starts_with("CDF")) return "netCDF: the ending of ExodusII has to be .exo, .e or .ex2";
  if (beginning.starts_with("#!TDV")) return "a file of Tecplot: ParaView reads it and saves .vtu";
  return "something else";
}

InputKind kind_by_format(const std::filesystem::path& path) {
  const InputFormat* format = find_format_by_name(path);
  if (format == nullptr) return is_mesh_by_header(path) ? InputKind::kCells : InputKind::kGrid;
  if (is_network_ply(path)) return InputKind::kNetwork;
  return is_mesh_by_header(path) ? InputKind::kCells : format->kind;
}

const InputFormat& find_volume_format(const std::filesystem::path& path) {
  const InputFormat* format = find_input_format(path);
  if (format != nullptr && format->gives_volumes()) return *format;
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown))
    fail("{}: expected a file, found a folder", path.string());
  fail("{}: expected a volume ({}) or the size and type of bare samples (--dimensions, --type), found '{}'",
       path.string(), list_volume_endings("or"), file_extension(path));
}

std::string list_grid_endings(std::string_view last) {
  return list([](const InputFormat& format) { return format.gives_grids(); }, last);
}

std::string list_mesh_endings(std::string_view last) {
  return list(
      [](const InputFormat& format) {
        return format.kind == InputKind::kCells || format.kind == InputKind::kMesh || format.may_be_cells;
      },
      last);
}

std::string list_volume_endings(std::string_view last) {
  return list([](const InputFormat& format) { return format.gives_volumes(); }, last);
}

VolumeSeries find_volume_series(const std::filesystem::path& path, const std::string& array) {
  const InputFormat* format = find_input_format(path);
  if (format == nullptr || format->find_series == nullptr) return {};
  return format->find_series(path, array);
}

VolumeSeries series_of(const ImageHeader& header, const std::string& array, StepTimes times) {
  if (header.times <= 1) return {};
  if (header.times > kMostVolumeSteps)
    fail("{}: expected at most {} times, found {}", header.name, kMostVolumeSteps, header.times);
  // A truncated file is reported before its first times are read.
  const VolumeSource last = volume_of(header, array, header.times - 1);
  if (!last.packed()) static_cast<void>(VolumeReader(last));
  VolumeSeries series{{}, times};
  for (std::uint64_t n = 0; n < header.times; ++n)
    series.steps.push_back({static_cast<double>(n) * header.time_spacing, {}, n});
  return series;
}

}  // namespace adamas::io
