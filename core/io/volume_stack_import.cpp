#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/png_image.h"
#include "core/io/tiff_pages.h"
#include "core/io/volume_import.h"

namespace adamas::io {

namespace {

constexpr std::string_view kTiff = "TIFF", kPng = "PNG";

struct PlaneKind {
  std::uint64_t width = 0, height = 0;
  StoredType type = StoredType::kUint8;
  bool operator==(const PlaneKind&) const = default;
};

/// Reads the pictures of a stack, in the child.
class StackReader {
 public:
  StackReader(const ReaderRequest& request, ByteSink& bytes)
      : paths_(request.paths.begin(), request.paths.end()), sink_(request, bytes) {
    volume_.spacing = request.spacing;
    volume_.origin = request.origin;
  }

  void run() {
    for (const auto& path : paths_) {
      const InputFormat* format = find_input_format(path);
      if (format != nullptr && format->name == kTiff) {
        read_tiff(path);
      } else if (format != nullptr && format->name == kPng) {
        read_png_plane(path);
      } else {
        fail("{}: expected a picture, TIFF or PNG, found another format", path.string());
      }
    }
  }

 private:
  void expect(const std::filesystem::path& path, const PlaneKind& kind, std::uint64_t planes) {
    if (volume_.dimensions[2] == 0) {
      kind_ = kind;
      volume_.dimensions = {kind.width, kind.height, planes};
      volume_.stored = kind.type;
      sink_.begin(volume_);
    } else if (kind != kind_) {
      fail("{}: expected {} x {} samples of {} as in {}, found {} x {} of {}", path.string(), kind_.width,
           kind_.height, stored_name(kind_.type), paths_.front().string(), kind.width, kind.height,
           stored_name(kind.type));
    }
  }

  void read_tiff(const std::filesystem::path& path) {
    TiffPages pages(path);
    const TiffLayout& layout = pages.layout();
    if (layout.samples != 1) {
      fail("{}: expected one value per sample, found {}", path.string(), layout.samples);
    }
    const std::size_t count = pages.count();
    if (paths_.size() > 1 && count != 1) fail("{}: expected one page, found {}", path.string(), count);
    expect(path, {layout.width, layout.height, find_stored_type(layout.type()).value()},
           paths_.size() > 1 ? paths_.size() : count);
    std::vector<std::byte> row(layout.row_bytes());
    do {
      for (std::uint32_t y = 0; y < layout.height; ++y) {
        pages.read_row(y, row);
        sink_.samples(row);
      }
    } while (pages.next_page());
  }

  void read_png_plane(const std::filesystem::path& path) {
    const PngImage image = read_png(path);
    expect(path, {image.width, image.height, image.bits == 16 ? StoredType::kUint16 : StoredType::kUint8},
           paths_.size());
    sink_.samples(image.samples);
  }

  std::vector<std::filesystem::path> paths_;
  ImportedVolume volume_;
  ImportSink sink_;
  PlaneKind kind_;
};

VolumeSource import_picture(const std::filesystem::path& path, const VolumeOptions& options,
                            Progress& progress) {
  return import_stack({path}, {1, 1, 1}, {}, options, progress);
}

bool is_tiff(std::string_view bytes) {
  // The last two signatures are of files larger than 4 GiB.
  return bytes.starts_with(std::string_view("II*\0", 4)) || bytes.starts_with(std::string_view("MM\0*", 4)) ||
         bytes.starts_with(std::string_view("II+\0", 4)) || bytes.starts_with(std::string_view("MM\0+", 4));
}

}  // namespace

void send_stack_volume(const ReaderRequest& request, ByteSink& sink) { StackReader(request, sink).run(); }

InputFormat tiff_format() {
  return {.name = kTiff,
          .endings = ".tif",
          .more_endings = ".tiff",
          .shown_by = is_tiff,
          .read_grid = read_grid_by_library,
          .find_volume = import_picture};
}

InputFormat png_format() {
  return {.name = kPng,
          .endings = ".png",
          .shown_by = [](std::string_view bytes) { return bytes.starts_with("\x89PNG\r\n\x1a\n"); },
          .read_grid = read_grid_by_library,
          .find_volume = import_picture};
}

VolumeSource import_stack(const std::vector<std::filesystem::path>& paths, const Vec3& spacing,
                          const Vec3& origin, const VolumeOptions& options, Progress& progress) {
  if (paths.empty()) fail("expected the pictures of a stack, found none");
  const std::string others = paths.size() > 1 ? fmt::format(" and {} others", paths.size() - 1) : "";
  ReaderRequest request{LibraryReader::kStackVolume, paths.front().string() + others};
  for (const auto& path : paths) {
    request.input_bytes += check_input_file(path);
    request.paths.push_back(path.string());
  }
  request.spacing = spacing;
  request.origin = origin;
  return import_volume(request, options, progress);
}

}  // namespace adamas::io
