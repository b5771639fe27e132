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
  Parser(std::string_view text, const std::filesystem::path& path, std::string array)
      : text_(text), name_(path.string()), array_(std::move(array)), tags_(text, name_) {
    source_.name = name_;
    source_.file = path;
  }

  VolumeSource run() {
    bool on_points = false;
    while (const auto tag = tags_.next()) {
      if (tag->name == "PointData") {
        on_points = !tag->closing && !tag->empty;
        if (!tag->closing) scalars_ = tag->value("Scalars");
      }
      if (tag->closing) continue;
      if (tag->name == "VTKFile") read_file(*tag);
      if (tag->name == "ImageData") read_image(*tag);
      if (tag->name == "Piece" && has_image_) read_piece(*tag);
      if (tag->name == "DataArray" && on_points) arrays_.push_back(*tag);
      if (tag->name != "AppendedData") continue;
      if (!has_image_) break;
      read_array(chosen_array());
      find_samples(*tag);
      return source_;
    }
    fail("{}: expected an image file of VTK with appended raw data, found none", name_);
  }

 private:
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
    if (tag.has("compressor"))
      fail_value("compressor", "samples that are not compressed", tag.value("compressor"));
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

  [[nodiscard]] const XmlTag& chosen_array() const {
    const std::string wanted = array_.empty() ? std::string(scalars_) : xml_attribute(array_);
    std::string names;
    for (const XmlTag& tag : arrays_) {
      if (!wanted.empty() && tag.value("Name") == wanted) return tag;
      names += (names.empty() ? "'" : ", '") + printable(tag.value("Name"), kShown) + "'";
    }
    if (array_.empty() && arrays_.size() == 1) return arrays_[0];
    if (arrays_.empty()) fail("{}: expected an array on points, found none", name_);
    if (array_.empty()) fail("{}: expected one array on points or the name of one, found {}", name_, names);
    fail("{}: expected an array '{}' on points, found {}", name_, array_, names);
  }

  void read_array(const XmlTag& tag) {
    const auto type = find_stored_type(tag.value("type"), TypeNames::kVtk);
    if (!type) fail_value("DataArray type", "a type of numbers", tag.value("type"));
    source_.set_stored(*type);
    if (tag.has("NumberOfComponents") && tag.value("NumberOfComponents") != "1") {
      fail_value("NumberOfComponents", "one value per sample", tag.value("NumberOfComponents"));
    }
    if (tag.value("format") != "appended") {
      fail_value("DataArray format", "appended raw data", tag.value("format"));
    }
    source_.skip_bytes = numbers<std::uint64_t>(tag, "offset", 1).front();
  }

  /// They begin behind the underscore that follows the tag.
  void find_samples(const XmlTag& tag) {
    if (tag.value("encoding") != "raw") {
      fail_value("AppendedData encoding", "raw", tag.value("encoding"));
    }
    const std::size_t at = text_.find_first_not_of(" \t\r\n", tags_.position());
    if (tag.empty || at == std::string_view::npos || text_[at] != '_') {
      fail("{}: expected '_' before the appended data, found none", name_);
    }
    source_.header_bytes = at + 1;
  }

  std::string_view text_;
  std::string name_, array_;
  XmlTags tags_;
  VolumeSource source_;
  std::vector<std::int64_t> extent_;
  bool has_image_ = false;
  std::string_view scalars_;
  std::vector<XmlTag> arrays_;
};

}  // namespace

VolumeSource vti_source(std::string_view text, const std::filesystem::path& path, const std::string& array) {
  return Parser(text, path, array).run();
}

}  // namespace adamas
