#include "core/io/meta_image.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/header_text.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/referred_files.h"

namespace adamas::io {

namespace {

constexpr std::size_t kShown = 40;
constexpr std::string_view kBlanks = " \t\r\f\v";

class Parser {
 public:
  Parser(std::string_view text, const std::filesystem::path& path)
      : path_(path), fields_(parse_meta_image_fields(text, path.string())) {
    image_.kind = "MetaImage";
    image_.name = source_.name = path.string();
    image_.centers.emplace();
    source_.trailing = TrailingBytes::kRefused;
  }

  ImageHeader run() {
    set_type();
    set_sizes();
    set_data_file();
    set_places();
    if (source_.file != path_) source_.name += ": " + source_.file.string();
    image_.arrays.push_back({.name = {}, .centering = Centering::kPoints, .source = std::move(source_)});
    return std::move(image_);
  }

 private:
  [[noreturn]] void fail_field(const std::string& key, std::string_view expected) const {
    fail("{}: {}: expected {}, found '{}'", image_.name, key, expected,
         printable(fields_.value(key), kShown));
  }

  void set_type() {
    if (fields_.is_true("CompressedData")) source_.coding = SamplePacking::kDeflate;
    if (fields_.has("BinaryData") && !fields_.is_true("BinaryData")) {
      if (source_.packed()) fail_field("BinaryData", "binary samples where they are compressed");
      source_.coding = SamplePacking::kText;
    }
    const char* channels = "ElementNumberOfChannels";
    if (fields_.has(channels)) {
      const auto count = parse_number_list<std::uint32_t>(fields_.value(channels));
      if (!count || count->size() != 1 || count->front() == 0) fail_field(channels, "a number from 1 on");
      source_.components = count->front();
    }
    std::string type = fields_.value("ElementType");
    if (type.ends_with("_ARRAY")) type.resize(type.size() - 6);
    const auto stored = find_stored_type(type, TypeNames::kMetaImage);
    if (!stored) fail_field("ElementType", "a type of numbers");
    source_.set_stored(*stored);
    source_.big_endian = fields_.is_true("BinaryDataByteOrderMSB") || fields_.is_true("ElementByteOrderMSB");
  }

  void set_sizes() {
    const auto sizes = parse_number_list<std::uint64_t>(fields_.value("DimSize"));
    if (!sizes || sizes->empty() || sizes->size() > 3) fail_field("DimSize", "one to three sizes");
    axes_ = sizes->size();
    if (fields_.has("NDims") && fields_.value("NDims") != std::to_string(axes_)) {
      fail_field("NDims", fmt::format("{} as there are sizes in DimSize", axes_));
    }
    std::copy(sizes->begin(), sizes->end(), image_.dimensions.begin());
    source_.grid.dimensions = image_.dimensions;
    source_.grid.check(image_.name);
  }

  void set_data_file() {
    const std::string file = fields_.value("ElementDataFile");
    source_.file = path_;
    if (file.starts_with("LIST") || file.find('%') != std::string::npos) {
      set_data_files();
    } else if (fields_.is_local()) {
      source_.header_bytes = fields_.header_bytes;
    } else {
      if (file.empty()) fail_field("ElementDataFile", "a file of samples");
      source_.file = path_.parent_path() / file;
    }
    if (fields_.has("HeaderSize")) set_skip();
  }

  /// Sets several data files, each with a part of the planes.
  void set_data_files() {
    if (source_.packed()) fail_field("ElementDataFile", "one file where samples are compressed or text");
    auto files = files_in_header(path_);
    if (files.empty()) fail_field("ElementDataFile", "the names of files of samples");
    source_.file = files.front();
    source_.more_files.assign(files.begin() + 1, files.end());
  }

  void set_skip() {
    const auto skip = parse_number_list<std::int64_t>(fields_.value("HeaderSize"));
    if (!skip || skip->size() != 1 || skip->front() < -1) fail_field("HeaderSize", "a number of bytes");
    source_.at_end = skip->front() < 0;
    if (!source_.packed()) {
      if (!source_.at_end) source_.skip_bytes = static_cast<std::uint64_t>(skip->front());
      return;
    }
    if (!source_.more_files.empty() && skip->front() != 0)
      fail_field("HeaderSize", "0 where samples are in several files");
    if (source_.at_end) fail_field("HeaderSize", "a number of bytes where samples are compressed or text");
    // The number of bytes to skip may count the file's own header too.
    source_.header_bytes += static_cast<std::uint64_t>(skip->front());
  }

  /// The numbers, one per axis, of the first key that the header has, else `otherwise`.
  Vec3 vector(std::initializer_list<const char*> keys, double otherwise) const {
    Vec3 result{otherwise, otherwise, otherwise};
    for (const char* key : keys) {
      if (!fields_.has(key)) continue;
      const auto numbers = parse_number_list<double>(fields_.value(key));
      if (!numbers || numbers->size() != axes_) fail_field(key, fmt::format("{} numbers", axes_));
      for (std::size_t i = 0; i < axes_; ++i) result[static_cast<int>(i)] = (*numbers)[i];
      break;
    }
    return result;
  }

  /// Sets the directions of the array's axes if the header states any.
  void set_directions() {
    for (const char* key : {"Orientation", "Rotation", "TransformMatrix"}) {
      if (!fields_.has(key)) continue;
      const auto numbers = parse_number_list<double>(fields_.value(key));
      const std::size_t count = numbers ? numbers->size() : 0;
      if (count != 1 && count != 4 && count != 9) fail_field(key, "four or nine numbers");
      const std::size_t dimension = count == 9 ? 3 : count == 4 ? 2 : 1;
      for (std::size_t i = 0; i < count; ++i)
        image_.axes.directions[i / dimension][static_cast<int>(i % dimension)] = (*numbers)[i];
      return;
    }
  }

  void set_places() {
    image_.spacing = vector({"ElementSpacing", "ElementSize"}, 1);
    VolumeGrid straight = source_.grid;
    straight.spacing = image_.spacing;
    straight.check(image_.name);
    set_directions();
    image_.axes.origin = vector({"Offset", "Position", "Origin"}, 0);
    for (int axis = 0; axis < 3; ++axis)
      image_.axes.directions[static_cast<std::size_t>(axis)] *= image_.spacing[axis];
    // Coordinates are those of ITK if the header states the orientation of its axes in a body.
    const std::string text = fields_.value("AnatomicalOrientation");
    const bool known = text.size() == 3 && text.find_first_not_of("RLAPISrlapis") == std::string::npos;
    if (known) image_.space = "LPS";
  }

  const std::filesystem::path& path_;
  MetaImageFields fields_;
  ImageHeader image_;
  VolumeSource source_;
  std::size_t axes_ = 0;
};

}  // namespace

std::string MetaImageFields::value(const std::string& key) const {
  const auto found = values.find(key);
  return found == values.end() ? "" : found->second;
}

bool MetaImageFields::is_true(const std::string& key) const {
  const std::string text = value(key);
  return !text.empty() && (text[0] == 'T' || text[0] == 't');
}

bool MetaImageFields::is_local() const {
  const std::string file = value("ElementDataFile");
  return file == "LOCAL" || file == "Local" || file == "local";
}

MetaImageFields parse_meta_image_fields(std::string_view text, const std::string& name) {
  constexpr std::size_t kLines = 1000;
  MetaImageFields fields;
  for (std::size_t i = 0; i < kLines && fields.header_bytes < text.size(); ++i) {
    const std::size_t begin = fields.header_bytes;
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    fields.header_bytes = std::min(end + 1, text.size());
    const std::size_t equal = line.find('=');
    if (equal == std::string_view::npos) continue;
    const std::string key(trimmed(line.substr(0, equal), kBlanks));
    fields.values[key] = trimmed(line.substr(equal + 1), kBlanks);
    if (key == "ElementDataFile") return fields;
  }
  fail("{}: expected a MetaImage header with ElementDataFile, found none", name);
}

InputFormat meta_image_format() {
  return {
      .name = "MetaImage",
      .endings = ".mha .mhd",
      .shown_by =
          [](std::string_view bytes) {
            return bytes.starts_with("ObjectType") || bytes.starts_with("NDims");
          },
      .read_header = [](const std::filesystem::path& path) { return meta_image(read_beginning(path), path); },
      .referred_files = files_in_header};
}

ImageHeader meta_image(std::string_view text, const std::filesystem::path& path) {
  return Parser(text, path).run();
}

}  // namespace adamas::io
