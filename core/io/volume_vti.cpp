#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/io/number_list.h"
#include "core/io/printable.h"
#include "core/io/volume_source.h"
#include "core/io/xml_tags.h"
#include "core/io/xml_text.h"

namespace adamas {

namespace {

constexpr std::size_t kShown = 40;

class Parser {
 public:
  Parser(const XmlSkeleton& skeleton, const std::filesystem::path& path, std::string array)
      : skeleton_(skeleton),
        text_(skeleton.text),
        name_(path.string()),
        array_(std::move(array)),
        tags_(text_, name_) {
    source_.name = name_;
    source_.file = path;
  }

  VolumeSource run() {
    bool on_points = false;
    while (const auto tag = tags_.next()) {
      if (tag->name == "PointData") {
        on_points = !tag->closing && !tag->empty;
        if (!tag->closing) scalars_ = tag->value("Scalars");
        points_end_ = tag->closing || tag->empty;
      }
      if (on_points) follow_array(*tag);
      if (tag->closing) continue;
      if (tag->name == "VTKFile") read_file(*tag);
      if (tag->name == "ImageData") read_image(*tag);
      if (tag->name == "Piece" && has_image_) read_piece(*tag);
      if (tag->name != "AppendedData") continue;
      if (!has_image_) break;
      read_array(chosen_array());
      if (inline_) break;
      find_appended(*tag);
      return source_;
    }
    if (!has_image_) fail("{}: expected an image file of VTK, found none", name_);
    if (!points_end_) fail("{}: expected whole PointData, found a part or none", name_);
    const Array& array = chosen_array();
    read_array(array);
    find_inline(array);
    return source_;
  }

 private:
  struct Array {
    XmlTag tag;
    std::optional<std::size_t> begin;  ///< of the text in it, of that which is no further tag's
    bool whole = false;
  };

  [[noreturn]] void fail_value(std::string_view what, std::string_view expected,
                               std::string_view found) const {
    fail("{}: {}: expected {}, found '{}'", name_, what, expected, printable(found, kShown));
  }

  template <class T>
  std::vector<T> numbers(const XmlTag& tag, std::string_view attribute, std::size_t count) const {
    const auto values = parse_number_list<T>(tag.value(attribute));
    if (!values || values->size() != count) {
      fail_value(attribute, fmt::format("{} numbers", count), tag.value(attribute));
    }
    return *values;
  }

  void read_file(const XmlTag& tag) {
    if (tag.value("type") != "ImageData") fail_value("VTKFile type", "ImageData", tag.value("type"));
    compressed_ = tag.has("compressor");
    if (compressed_ && tag.value("compressor") != "vtkZLibDataCompressor") {
      fail_value("compressor", "vtkZLibDataCompressor or none", tag.value("compressor"));
    }
    const std::string_view order = tag.value("byte_order"), count = tag.value("header_type");
    if (order != "LittleEndian" && order != "BigEndian") {
      fail_value("byte_order", "LittleEndian or BigEndian", order);
    }
    if (tag.has("header_type") && count != "UInt32" && count != "UInt64") {
      fail_value("header_type", "UInt32 or UInt64", count);
    }
    source_.big_endian = order == "BigEndian";
    source_.count_bytes = count == "UInt64" ? 8 : 4;
  }

  void read_image(const XmlTag& tag) {
    if (source_.count_bytes == 0) fail("{}: expected a tag VTKFile first, found ImageData", name_);
    extent_ = numbers<std::int64_t>(tag, "WholeExtent", 6);
    Vec3 first;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      constexpr std::int64_t kFarthest = std::int64_t{1} << 60;
      const std::int64_t from = extent_[2 * axis], to = extent_[2 * axis + 1];
      if (from > to || from < -kFarthest || to > kFarthest) {
        fail_value("WholeExtent", "x0 x1 y0 y1 z0 z1 with x0 <= x1 and so on", tag.value("WholeExtent"));
      }
      source_.grid.dimensions[axis] = static_cast<std::uint64_t>(to - from) + 1;
      first[static_cast<int>(axis)] = static_cast<double>(from);
    }
    GridAxes axes;
    if (tag.has("Spacing")) source_.grid.spacing = to_vector(numbers<double>(tag, "Spacing", 3));
    if (tag.has("Origin")) axes.origin = to_vector(numbers<double>(tag, "Origin", 3));
    source_.grid.check(name_);
    if (tag.has("Direction")) {
      const auto matrix = numbers<double>(tag, "Direction", 9);
      for (std::size_t a = 0; a < 3; ++a) axes.directions[a] = {matrix[a], matrix[3 + a], matrix[6 + a]};
    }
    for (int axis = 0; axis < 3; ++axis) {
      Vec3& direction = axes.directions[static_cast<std::size_t>(axis)];
      direction *= source_.grid.spacing[axis];
      axes.origin += first[axis] * direction;
    }
    source_.set_axes(axes);
    has_image_ = true;
  }

  static Vec3 to_vector(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

  void read_piece(const XmlTag& tag) {
    if (numbers<std::int64_t>(tag, "Extent", 6) != extent_) {
      fail_value("Piece Extent", "one piece of the whole extent", tag.value("Extent"));
    }
  }

  /// Notes arrays and where the text in them begins.
  void follow_array(const XmlTag& tag) {
    if (tag.name == "DataArray" && !tag.closing) {
      arrays_.push_back({tag, {}, tag.empty});
    } else if (arrays_.empty() || arrays_.back().whole) {
      return;
    }
    Array& array = arrays_.back();
    if (tag.name == "DataArray" && tag.closing) array.whole = true;
    const bool own = tag.name == "DataArray" || (tag.name == "InformationKey" && (tag.closing || tag.empty));
    if (array.whole || array.begin || !own) return;
    const std::size_t at = text_.find_first_not_of(" \t\r\n", tags_.position());
    // Blanks may be all that is kept of it.
    if (at == std::string_view::npos || text_[at] != '<' || at - tags_.position() >= 64) {
      array.begin = tags_.position();
    }
  }

  [[nodiscard]] const Array& chosen_array() const {
    const std::string wanted = array_.empty() ? std::string(scalars_) : xml_attribute(array_);
    std::string names;
    for (const Array& array : arrays_) {
      const std::string_view name = array.tag.value("Name");
      if (!wanted.empty() && name == wanted) return array;
      names += (names.empty() ? "'" : ", '") + printable(name, kShown) + "'";
    }
    if (array_.empty() && arrays_.size() == 1) return arrays_[0];
    if (arrays_.empty()) fail("{}: expected an array on points, found none", name_);
    if (array_.empty()) fail("{}: expected one array on points or the name of one, found {}", name_, names);
    fail("{}: expected an array '{}' on points, found {}", name_, array_, names);
  }

  void read_array(const Array& array) {
    const XmlTag& tag = array.tag;
    const auto type = find_stored_type(tag.value("type"), TypeNames::kVtk);
    if (!type) fail_value("DataArray type", "a type of numbers", tag.value("type"));
    source_.set_stored(*type);
    if (tag.has("NumberOfComponents") && tag.value("NumberOfComponents") != "1") {
      fail_value("NumberOfComponents", "one value per sample", tag.value("NumberOfComponents"));
    }
    const std::string_view format = tag.value("format");
    inline_ = format != "appended";
    source_.base64 = source_.before_tag = format == "binary";
    if (format == "ascii") {
      source_.coding = SamplePacking::kText;
      source_.before_tag = true;
      return;
    }
    if (compressed_) source_.coding = SamplePacking::kVtkBlocks;
    if (format == "binary") return;
    if (format != "appended") fail_value("DataArray format", "appended, binary or ascii", format);
    source_.skip_bytes = numbers<std::uint64_t>(tag, "offset", 1).front();
  }

  void find_inline(const Array& array) {
    if (!inline_) fail("{}: expected appended data, found the file's end", name_);
    const std::string name = printable(array.tag.value("Name"), kShown);
    if (!array.begin || !array.whole) fail("{}: expected a whole array '{}', found a part", name_, name);
    source_.header_bytes = skeleton_.file_position(*array.begin);
  }

  /// They begin behind the underscore that follows the tag.
  void find_appended(const XmlTag& tag) {
    const std::string_view encoding = tag.value("encoding");
    if (encoding != "raw" && encoding != "base64") {
      fail_value("AppendedData encoding", "raw or base64", encoding);
    }
    source_.base64 = source_.before_tag = encoding == "base64";
    const std::size_t at = text_.find_first_not_of(" \t\r\n", tags_.position());
    if (tag.empty || at == std::string_view::npos || text_[at] != '_') {
      fail("{}: expected '_' before the appended data, found none", name_);
    }
    source_.header_bytes = skeleton_.file_position(at + 1);
  }

  const XmlSkeleton& skeleton_;
  std::string_view text_;
  std::string name_, array_;
  XmlTags tags_;
  VolumeSource source_;
  std::vector<std::int64_t> extent_;
  bool has_image_ = false, compressed_ = false, inline_ = false, points_end_ = false;
  std::string_view scalars_;
  std::vector<Array> arrays_;
};

}  // namespace

VolumeSource vti_source(const XmlSkeleton& skeleton, const std::filesystem::path& path,
                        const std::string& array) {
  return Parser(skeleton, path, array).run();
}

}  // namespace adamas
