#include "core/io/volume_format.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/io/file_handle.h"
#include "core/io/input_file.h"

namespace adamas {

namespace {

struct Extension {
  std::string_view text;
  VolumeFormat format;
};

constexpr Extension kExtensions[] = {{".nrrd", VolumeFormat::kNrrd},     {".nhdr", VolumeFormat::kNrrd},
                                     {".mha", VolumeFormat::kMetaImage}, {".mhd", VolumeFormat::kMetaImage},
                                     {".vti", VolumeFormat::kVti},       {".nii", VolumeFormat::kNifti},
                                     {".nii.gz", VolumeFormat::kNifti},  {".hdr", VolumeFormat::kNifti},
                                     {".hdr.gz", VolumeFormat::kNifti},  {".img", VolumeFormat::kNifti},
                                     {".img.gz", VolumeFormat::kNifti},  {".h5", VolumeFormat::kHdf5},
                                     {".hdf5", VolumeFormat::kHdf5},     {".he5", VolumeFormat::kHdf5},
                                     {".tif", VolumeFormat::kTiff},      {".tiff", VolumeFormat::kTiff},
                                     {".png", VolumeFormat::kPng},       {".vtk", VolumeFormat::kOtherGrid},
                                     {".vtr", VolumeFormat::kOtherGrid}, {".slc", VolumeFormat::kOtherGrid},
                                     {".mnc", VolumeFormat::kOtherGrid}, {".dcm", VolumeFormat::kOtherGrid},
                                     {".pgm", VolumeFormat::kOtherGrid}, {".bmp", VolumeFormat::kOtherGrid}};

/// By the bytes at a place of the file.
struct Magic {
  std::size_t at;
  std::string_view bytes;
  VolumeFormat format;
};

constexpr Magic kMagics[] = {{0, "NRRD0", VolumeFormat::kNrrd},
                             {0, "ObjectType", VolumeFormat::kMetaImage},
                             {0, "NDims", VolumeFormat::kMetaImage},
                             {344, {"n+1\0", 4}, VolumeFormat::kNifti},
                             {4, {"n+2\0", 4}, VolumeFormat::kNifti},
                             {0, "\x89HDF\r\n\x1a\n", VolumeFormat::kHdf5},
                             {0, {"II*\0", 4}, VolumeFormat::kTiff},
                             {0, {"MM\0*", 4}, VolumeFormat::kTiff},
                             {0, {"II+\0", 4}, VolumeFormat::kTiff},
                             {0, {"MM\0+", 4}, VolumeFormat::kTiff},
                             {0, "\x89PNG\r\n\x1a\n", VolumeFormat::kPng},
                             {0, "# vtk DataFile", VolumeFormat::kOtherGrid}};

std::optional<VolumeFormat> format_of_bytes(std::string_view begin) {
  for (const Magic& magic : kMagics) {
    if (begin.size() > magic.at && begin.substr(magic.at).starts_with(magic.bytes)) return magic.format;
  }
  if (begin.starts_with("<") && begin.find("<VTKFile") != std::string_view::npos &&
      begin.find("ImageData") != std::string_view::npos) {
    return VolumeFormat::kVti;
  }
  return {};
}

}  // namespace

VolumeFormat find_volume_format(const std::filesystem::path& path) {
  const std::string extension = file_extension(path);
  const auto* found = std::find_if(std::begin(kExtensions), std::end(kExtensions),
                                   [&](const Extension& e) { return e.text == extension; });
  if (found != std::end(kExtensions)) return found->format;
  std::array<char, 1024> bytes{};
  const std::size_t size = FileHandle::open(path)->read_some(0, std::as_writable_bytes(std::span(bytes)));
  if (const auto format = format_of_bytes({bytes.data(), size})) return *format;
  fail(
      "{}: expected a volume (.nrrd, .nhdr, .mha, .mhd, .vti, .nii, .hdr, .h5, .tif, .png, .vtk, .vtr, .slc) "
      "or the size and type of bare samples, found '{}'",
      path.string(), extension);
}

}  // namespace adamas
