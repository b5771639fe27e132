#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/volume.h"
#include "core/io/output_stream.h"

namespace adamas::io {

/// The file of the samples whose header is to be `path`: for .nhdr and .mhd the .raw file of the same name
/// beside it; otherwise empty, since samples follow the header.
std::filesystem::path volume_data_file(const std::filesystem::path& path);

struct VolumeWriterOptions {
  std::string array = "values";     ///< the name of the samples in a .vti
  std::filesystem::path data_file;  ///< the file of the samples; empty: volume_data_file(path)
  std::string data_name;            ///< the name of that file in the header; empty: its own name
  /// The type of the numbers that planes have; none: that of the grid's samples.
  std::optional<StoredType> numbers{};
};

/// A line on what a file does not keep of a grid's axes, origin and space; empty if it keeps all. The files
/// of a .pvd are .vti.
std::string lost_places(const std::filesystem::path& path, const VolumeGrid& grid);

/// Whether a file of that format can state a scale of samples (VolumeGrid::slope).
bool keeps_scale(const std::filesystem::path& path);
/// Whether values are written instead of samples, as float32, since the format states no scale.
bool writes_values(const std::filesystem::path& path, const VolumeGrid& grid);

/// Writes a volume plane by plane, uncompressed: .vti (appended raw), .nrrd, .nhdr, .mha, .mhd, .nii, or
/// .raw, which is only samples; or compressed: .nii.gz. Equal samples give equal bytes, least byte first.
/// NIfTI and MetaImage have coordinates in RAS and LPS: those of another known space are converted. If
/// samples have a scale that the file cannot state, their values are written, as float32. Files get their
/// names at finish().
class VolumeWriter {
 public:
  /// Begins the files. Throws Error if the grid is invalid (VolumeGrid::check), the extension is unknown, a
  /// header cannot hold the data file's name, or the disk has not enough room.
  VolumeWriter(const std::filesystem::path& path, const VolumeGrid& of_planes,
               const VolumeWriterOptions& options = {});

  /// Takes the numbers of the next plane, in the machine's byte order. Throws Error if it cannot be
  /// written.
  void write_plane(std::span<const std::byte> numbers);
  /// Ends the files, after the last plane. Throws Error if they are not complete.
  void finish();

 private:
  VolumeGrid grid_;     ///< grid of the planes that are passed in
  StoredType numbers_;  ///< the type of their numbers
  bool writes_values_ = false;
  std::vector<float> values_;  ///< the values of a plane
  std::uint64_t planes_ = 0;
  /// The header's file; it also takes the samples if there is no other file.
  std::unique_ptr<OutputStream> header_;
  std::unique_ptr<OutputStream> data_;
  std::unique_ptr<GzipStream> gzip_;  ///< compresses into header_ if the file is compressed
  std::string end_;                   ///< the end of the header's file, after the samples
};

/// One of several arrays that share a grid.
struct PointArray {
  std::string name;
  /// A value is slope * sample + intercept. The readers of this project apply it; other programs show
  /// samples.
  double slope = 1, intercept = 0;
  /// The samples of plane k, in the form of VolumeWriter::write_plane; called for each plane in ascending
  /// order.
  std::function<std::span<const std::byte>(std::uint64_t k)> plane;
};

/// Writes a .vti with arrays at the grid's points, all with the grid's type; the grid's own scale is ignored.
/// Equal samples give equal bytes. Throws Error as VolumeWriter does.
void write_point_arrays(const std::filesystem::path& path, const VolumeGrid& grid,
                        const std::vector<PointArray>& arrays);

}  // namespace adamas::io
