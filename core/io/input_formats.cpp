#include "core/io/input_formats.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/io/file_handle.h"
#include "core/io/input_file.h"
#include "core/io/network_ply.h"
#include "core/io/volume_unpacking.h"

/// Every format, one a line, in the order in which they are listed and tried.
#define ADAMAS_INPUT_FORMATS(FORMAT) \
  FORMAT(vti_format)                 \
  FORMAT(vtr_format)                 \
  FORMAT(legacy_vtk_format)          \
  FORMAT(nrrd_format)                \
  FORMAT(meta_image_format)          \
  FORMAT(nifti_format)               \
  FORMAT(hdf5_format)                \
  FORMAT(tiff_format)                \
  FORMAT(png_format)                 \
  FORMAT(vtk_picture_format)         \
  FORMAT(vtu_format)                 \
  FORMAT(vtp_format)                 \
  FORMAT(network_format)             \
  FORMAT(surface_format)

namespace adamas::io {

#define ADAMAS_DECLARE(format) InputFormat format();
ADAMAS_INPUT_FORMATS(ADAMAS_DECLARE)
#undef ADAMAS_DECLARE

namespace {

/// Calls `use` with each of the endings in a text.
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
  const auto found = std::find_if(formats.begin(), formats.end(),
                                  [&](const InputFormat& format) { return format.has_ending(ending); });
  return found == formats.end() ? nullptr : &*found;
}

const InputFormat* find_input_format(const std::filesystem::path& path) {
  if (const InputFormat* format = find_format_by_name(path)) return format;
  std::array<char, 1024> bytes{};
  const std::size_t size = FileHandle::open(path)->read_some(0, std::as_writable_bytes(std::span(bytes)));
  const std::string_view beginning(bytes.data(), size);
  const auto formats = input_formats();
  const auto found = std::find_if(formats.begin(), formats.end(), [&](const InputFormat& format) {
    return format.shown_by != nullptr && format.shown_by(beginning);
  });
  return found == formats.end() ? nullptr : &*found;
}

InputKind input_kind(const std::filesystem::path& path) {
  const InputFormat* format = find_format_by_name(path);
  if (format == nullptr) return InputKind::kGrid;
  return is_network_ply(path) ? InputKind::kNetwork : format->kind;
}

const InputFormat& find_volume_format(const std::filesystem::path& path) {
  const InputFormat* format = find_input_format(path);
  if (format != nullptr && format->gives_volumes()) return *format;
  fail("{}: expected a volume ({}) or the size and type of bare samples (--dimensions, --type), found '{}'",
       path.string(), list_volume_endings("or"), file_extension(path));
}

std::string list_grid_endings(std::string_view last) {
  return list([](const InputFormat& format) { return format.gives_grids(); }, last);
}

std::string list_volume_endings(std::string_view last) {
  return list([](const InputFormat& format) { return format.gives_volumes(); }, last);
}

namespace {

/// Opens one time of a compressed file; the first call unpacks all times.
VolumeSource unpacked_time(const ImageHeader& header, const VolumeOptions& options, Progress& progress) {
  VolumeSource source = volume_of(header, options.array, options.time);
  std::shared_ptr<const FileHandle>& samples = options.all_times->samples;
  if (samples == nullptr) {
    // That of the last time throws where the bytes of all cannot be counted.
    VolumeSource all = volume_of(header, options.array, header.times - 1);
    all.skip_bytes -= (header.times - 1) * header.time_step;
    all.grid.dimensions[2] *= header.times;
    const VolumeSource unpacked = unpack_volume(std::move(all), options.scratch_folder, progress);
    samples = unpacked.scratch;
    source.remark = unpacked.remark;
  }
  source.scratch = samples;
  source.coding = SamplePacking::kRaw;
  source.header_bytes = options.time.value_or(0) * header.time_step;
  source.skip_bytes = 0;
  return source;
}

VolumeSource find_samples(const InputFormat& format, const std::filesystem::path& path,
                          const VolumeOptions& options, Progress& progress) {
  if (format.read_header == nullptr) return format.find_volume(path, options, progress);
  const ImageHeader header = format.read_header(path);
  const bool packed = header.times > 1 && header.arrays.front().source.packed();
  if (packed && options.all_times != nullptr) return unpacked_time(header, options, progress);
  return volume_of(header, options.array, options.time);
}

}  // namespace

VolumeSeries find_volume_series(const std::filesystem::path& path, const std::string& array) {
  const InputFormat* format = find_input_format(path);
  if (format == nullptr || format->find_series == nullptr) return {};
  return format->find_series(path, array);
}

VolumeReader open_volume(const std::filesystem::path& path, const VolumeOptions& options,
                         Progress& progress) {
  const InputFormat& format = find_volume_format(path);
  if (options.time && !format.several_times)
    fail("{}: expected NIfTI or HDF5, which may have several times, found {}", path.string(), format.name);
  VolumeSource source = find_samples(format, path, options, progress);
  if (options.keep_scale) source.keep_scale();
  if (source.packed()) source = unpack_volume(std::move(source), options.scratch_folder, progress);
  return VolumeReader(std::move(source));
}

VolumeReader open_raw_volume(const std::filesystem::path& path, const RawVolume& volume) {
  return VolumeReader(volume_of(raw_image(path, volume), {}, {}));
}

}  // namespace adamas::io
