#include "core/base/error.h"
#include "core/io/meta_image_check.h"
#include "core/io/meta_image_fields.h"
#include "core/io/number_list.h"
#include "core/io/printable.h"
#include "core/io/volume_source.h"

namespace adamas {

namespace {

constexpr std::size_t kShown = 40;

class Parser {
 public:
  Parser(std::string_view text, const std::filesystem::path& path)
      : path_(path), fields_(parse_meta_image_fields(text, path.string())) {
    source_.name = path.string();
  }

  VolumeSource run() {
    refuse_other_kinds();
    set_sizes();
    set_data_file();
    set_places();
    return source_;
  }

 private:
  [[noreturn]] void fail_field(const std::string& key, std::string_view expected) const {
    fail("{}: {}: expected {}, found '{}'", source_.name, key, expected,
         printable(fields_.value(key), kShown));
  }

  void refuse_other_kinds() {
    if (fields_.is_true("CompressedData")) source_.coding = SamplePacking::kDeflate;
    if (fields_.has("BinaryData") && !fields_.is_true("BinaryData")) {
      if (source_.packed()) fail_field("BinaryData", "binary samples where they are compressed");
      source_.coding = SamplePacking::kText;
    }
    const char* channels = "ElementNumberOfChannels";
    if (fields_.has(channels) && fields_.value(channels) != "1") fail_field(channels, "one value per sample");
    const auto type = find_stored_type(fields_.value("ElementType"), TypeNames::kMetaImage);
    if (!type) fail_field("ElementType", "a type of numbers");
    source_.set_stored(*type);
    source_.big_endian = fields_.is_true("BinaryDataByteOrderMSB") || fields_.is_true("ElementByteOrderMSB");
  }

  void set_sizes() {
    const auto sizes = parse_number_list<std::uint64_t>(fields_.value("DimSize"));
    if (!sizes || sizes->size() < 2 || sizes->size() > 3) fail_field("DimSize", "two or three sizes");
    axes_ = sizes->size();
    if (fields_.has("NDims") && fields_.value("NDims") != std::to_string(axes_)) {
      fail_field("NDims", fmt::format("{} as there are sizes", axes_));
    }
    source_.grid.dimensions = {(*sizes)[0], (*sizes)[1], axes_ == 3 ? (*sizes)[2] : 1};
    source_.grid.check(source_.name);
  }

  void set_data_file() {
    const std::string file = fields_.value("ElementDataFile");
    if (file.empty() || file.starts_with("LIST") || file.find('%') != std::string::npos) {
      fail_field("ElementDataFile", "one file of samples");
    }
    source_.file = path_;
    if (fields_.is_local()) {
      source_.header_bytes = fields_.header_bytes;
    } else {
      source_.file = path_.parent_path() / file;
    }
    if (!fields_.has("HeaderSize")) return;
    const auto skip = parse_number_list<std::int64_t>(fields_.value("HeaderSize"));
    if (!skip || skip->size() != 1 || skip->front() < -1) fail_field("HeaderSize", "a number of bytes");
    source_.at_end = skip->front() < 0;
    if (!source_.packed()) {
      if (!source_.at_end) source_.skip_bytes = static_cast<std::uint64_t>(skip->front());
      return;
    }
    if (source_.at_end) fail_field("HeaderSize", "a number of bytes where samples are compressed or text");
    // Its own header may count as well as one before it.
    source_.header_bytes += static_cast<std::uint64_t>(skip->front());
  }

  /// A number per axis under the first of the keys that is there, else `otherwise`.
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

  void set_places() {
    source_.grid.spacing = vector({"ElementSpacing", "ElementSize"}, 1);
    source_.grid.check(source_.name);
    GridAxes axes;
    if (const auto directions = meta_image_directions(fields_, source_.name)) axes.directions = *directions;
    axes.origin = vector({"Offset", "Position", "Origin"}, 0);
    for (int axis = 0; axis < 3; ++axis) {
      axes.directions[static_cast<std::size_t>(axis)] *= source_.grid.spacing[axis];
    }
    source_.grid.space = meta_image_space(fields_);
    source_.set_axes(axes);
    if (source_.file != path_) source_.name += ": " + source_.file.string();
  }

  const std::filesystem::path& path_;
  MetaImageFields fields_;
  VolumeSource source_;
  std::size_t axes_ = 0;
};

}  // namespace

VolumeSource meta_image_source(std::string_view text, const std::filesystem::path& path) {
  return Parser(text, path).run();
}

}  // namespace adamas
