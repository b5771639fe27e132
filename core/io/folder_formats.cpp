// What is known of DICOM and of OME-Zarr without their libraries.

#include <array>
#include <fstream>
#include <string_view>

#include "core/io/dicom_reader.h"
#include "core/io/input_formats.h"
#include "core/io/volume_import.h"
#include "core/io/zarr_reader.h"

namespace adamas::io {

namespace {

/// The bytes of a file of DICOM up to its mark, and behind it.
constexpr std::size_t kDicomHead = 132;

bool begins_as_dicom(std::string_view bytes) {
  return bytes.size() >= kDicomHead && bytes.substr(kDicomHead - 4, 4) == "DICM";
}

}  // namespace

bool is_dicom_file(const std::filesystem::path& path) {
  // Other files of a folder may be empty, unreadable or gone.
  std::array<char, kDicomHead> bytes{};
  std::ifstream stream(path, std::ios::binary);
  stream.read(bytes.data(), bytes.size());
  return stream.good() && begins_as_dicom({bytes.data(), bytes.size()});
}

bool is_dicom_folder(const std::filesystem::path& path) {
  std::error_code code;
  for (std::filesystem::directory_iterator at(path, code), end; !code && at != end; at.increment(code)) {
    if (at->is_regular_file(code) && is_dicom_file(at->path())) return true;
  }
  return false;
}

InputFormat dicom_format() {
  return {.name = kDicom,
          .endings = ".dcm",
          .more_endings = ".dicom .ima",
          .shown_by = begins_as_dicom,
          .read_grid = read_grid_by_library,
          .read_series = read_series_by_library,
          .find_volume = import_grid,
          .several_arrays = true,
          .is_folder = is_dicom_folder};
}

bool is_zarr_folder(const std::filesystem::path& path) {
  std::error_code code;
  for (const char* file : {".zattrs", ".zarray", ".zgroup", "zarr.json"}) {
    if (std::filesystem::exists(path / file, code)) return true;
  }
  return false;
}

InputFormat zarr_format() {
  return {.name = kZarr,
          .endings = ".zarr",
          .read_grid = read_grid_by_library,
          .find_volume = import_grid,
          .several_arrays = true,
          .several_times = true,
          .is_folder = is_zarr_folder};
}

}  // namespace adamas::io
