#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/nifti_header.h"
#include "core/io/volume_format.h"
#include "core/io/volume_import.h"
#include "core/io/volume_reader.h"
#include "core/io/volume_unpacking.h"

namespace adamas {

namespace {

/// The header of a pair, of whichever of its files.
std::filesystem::path nifti_path(const std::filesystem::path& path) {
  if (!file_extension(path).starts_with(".img")) return path;
  const std::filesystem::path header = path.parent_path() / (file_stem(path) + ".hdr");
  std::filesystem::path packed = header;
  packed += ".gz";
  return !std::filesystem::exists(header) && std::filesystem::exists(packed) ? packed : header;
}

VolumeSource find_source(const std::filesystem::path& path, const VolumeOptions& options,
                         Progress& progress) {
  const VolumeFormat format = find_volume_format(path);
  if (options.time && format != VolumeFormat::kNifti)
    fail("{}: expected NIfTI, which may have several times, found another format", path.string());
  switch (format) {
    case VolumeFormat::kNrrd:
      return nrrd_source(read_beginning(path), path);
    case VolumeFormat::kMetaImage:
      return meta_image_source(read_beginning(path), path);
    case VolumeFormat::kVti: {
      const std::string name = path.string();
      return vti_source(read_xml_skeleton(supply_file(FileHandle::open(path), 0), name), path, options.array);
    }
    case VolumeFormat::kNifti: {
      const std::filesystem::path header = nifti_path(path);
      return nifti_source(read_nifti_header(header), header, options.time);
    }
    case VolumeFormat::kHdf5:
      return import_hdf5(path, options, progress);
    case VolumeFormat::kTiff:
    case VolumeFormat::kPng:
      return import_stack({path}, {1, 1, 1}, {}, options, progress);
    case VolumeFormat::kOtherGrid:
      return import_grid(path, options, progress);
  }
  return {};
}

}  // namespace

VolumeReader open_volume(const std::filesystem::path& path, const VolumeOptions& options,
                         Progress& progress) {
  VolumeSource source = find_source(path, options, progress);
  if (source.packed()) source = unpack_volume(std::move(source), options.scratch_folder, progress);
  return VolumeReader(std::move(source));
}

VolumeReader open_raw_volume(const std::filesystem::path& path, const RawVolume& volume) {
  VolumeSource source;
  source.name = path.string();
  source.file = path;
  source.skip_bytes = volume.header_bytes;
  source.exact = true;
  source.set_stored(volume.type);
  source.big_endian = volume.big_endian;
  source.grid.dimensions = volume.dimensions;
  source.grid.spacing = volume.spacing;
  source.grid.origin = volume.origin;
  return VolumeReader(std::move(source));
}

}  // namespace adamas
