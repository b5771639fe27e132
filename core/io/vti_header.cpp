#include "core/io/vti_header.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/io/header_text.h"
#include "core/io/input_formats.h"
#include "core/io/vtk_checks.h"

namespace adamas {

namespace {

constexpr std::size_t kShown = 40;

class Parser {
 public:
  Parser(const std::vector<XmlTag>& tags, const std::filesystem::path& path) : tags_(tags), path_(path) {
    header_.kind = "VTK XML image";
    header_.name = path.string();
  }

  ImageHeader run() {
    for (const XmlTag& tag : tags_) {
      if (tag.name == "AppendedData") {
        find_appended(tag);
      } else if (tag.closing) {
        if (tag.name == parent_) parent_.clear();
      } else {
        open(tag);
      }
    }
    if (!has_image_) fail("{}: expected an image file of VTK, found none", header_.name);
    for (ImageArray& array : header_.arrays) note_missing(array);
    if (names_ && names_->source.header_bytes > 0 && form_.empty()) header_.material_names = names_->source;
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail_value(std::string_view what, std::string_view expected,
                               std::string_view found) const {
    fail("{}: {}: expected {}, found '{}'", header_.name, what, expected, printable(found, kShown));
  }

  /// Of what all arrays are in that come.
  void note_form(std::string_view what, std::string_view expected, std::string_view found) {
    if (form_.empty())
      form_ = fmt::format("{}: expected {}, found '{}'", what, expected, printable(found, kShown));
  }

  template <class T>
  std::vector<T> numbers(const XmlTag& tag, std::string_view attribute, std::size_t count) const {
    const auto values = parse_number_list<T>(tag.value(attribute));
    if (!values || values->size() != count) {
      fail_value(attribute, fmt::format("{} numbers", count), tag.value(attribute));
    }
    return *values;
  }

  void open(const XmlTag& tag) {
    if (tag.name == "VTKFile") read_file(tag);
    if (tag.name == "ImageData") read_image(tag);
    if (tag.name == "Piece" && has_image_) read_piece(tag);
    if (tag.name == "PointData" || tag.name == "CellData" || tag.name == "FieldData") parent_ = tag.name;
    if (tag.name == "PointData") header_.active = tag.value("Scalars");
    if ((tag.name == "DataArray" || tag.name == "Array") && has_image_ && !parent_.empty()) read_array(tag);
  }

  void read_file(const XmlTag& tag) {
    if (tag.value("type") != "ImageData") fail_value("VTKFile type", "ImageData", tag.value("type"));
    compressed_ = tag.has("compressor");
    if (compressed_ && tag.value("compressor") != "vtkZLibDataCompressor") {
      note_form("compressor", "vtkZLibDataCompressor or none", tag.value("compressor"));
    }
    const std::string_view order = tag.value("byte_order"), count = tag.value("header_type");
    if (tag.has("byte_order") && order != "LittleEndian" && order != "BigEndian") {
      fail_value("byte_order", "LittleEndian or BigEndian", order);
    }
    if (tag.has("header_type") && count != "UInt32" && count != "UInt64") {
      fail_value("header_type", "UInt32 or UInt64", count);
    }
    big_endian_ = order == "BigEndian";
    count_bytes_ = count == "UInt64" ? 8 : 4;
  }

  void read_image(const XmlTag& tag) {
    if (count_bytes_ == 0) fail("{}: expected a tag VTKFile first, found ImageData", header_.name);
    extent_ = numbers<std::int64_t>(tag, "WholeExtent", 6);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      constexpr std::int64_t kFarthest = std::int64_t{1} << 60;
      const std::int64_t from = extent_[2 * axis], to = extent_[2 * axis + 1];
      if (from > to || from < -kFarthest || to > kFarthest) {
        fail_value("WholeExtent", "x0 x1 y0 y1 z0 z1 with x0 <= x1 and so on", tag.value("WholeExtent"));
      }
      header_.dimensions[axis] = static_cast<std::uint64_t>(to - from) + 1;
      header_.first[axis] = from;
    }
    const auto vector = [&](const char* attribute) {
      const auto v = numbers<double>(tag, attribute, 3);
      return Vec3{v[0], v[1], v[2]};
    };
    if (tag.has("Spacing")) header_.spacing = vector("Spacing");
    if (tag.has("Origin")) header_.axes.origin = vector("Origin");
    if (tag.has("Direction")) {
      const auto m = numbers<double>(tag, "Direction", 9);
      for (std::size_t a = 0; a < 3; ++a) header_.axes.directions[a] = {m[a], m[3 + a], m[6 + a]};
    }
    for (int axis = 0; axis < 3; ++axis)
      header_.axes.directions[static_cast<std::size_t>(axis)] *= header_.spacing[axis];
    has_image_ = true;
  }

  void read_piece(const XmlTag& tag) {
    if (numbers<std::int64_t>(tag, "Extent", 6) != extent_)
      note_form("Piece Extent", "one piece of the whole extent", tag.value("Extent"));
    if (std::exchange(has_piece_, true)) note_form("Piece", "one piece", "several");
  }

  void read_array(const XmlTag& tag) {
    const std::string name(tag.value("Name"));
    const bool text = tag.value("type") == "String";
    if (parent_ == "FieldData") {
      if (text && name == "material_names" && !names_) names_ = array_of(tag);
      return;
    }
    const Centering centering = parent_ == "CellData" ? Centering::kCells : Centering::kPoints;
    // Arrays of further times have the same name.
    const bool known = std::any_of(header_.arrays.begin(), header_.arrays.end(), [&](const ImageArray& a) {
      return !name.empty() && a.name == name && a.centering == centering;
    });
    if (known || text || name == "vtkGhostType") return;
    ImageArray array = array_of(tag);
    array.centering = centering;
    array.source.grid.dimensions = header_.dimensions;
    if (centering == Centering::kCells) {
      // Where an axis has one point, it counts as a cell.
      for (std::uint64_t& n : array.source.grid.dimensions) n = std::max<std::uint64_t>(n - 1, 1);
    }
    header_.arrays.push_back(std::move(array));
  }

  static void set_form(ImageArray& array, std::string_view what, std::string_view expected,
                       std::string_view found) {
    array.other_form = true;
    array.missing = fmt::format("{}: expected {}, found '{}'", what, expected, printable(found, kShown));
  }

  /// As write_point_arrays writes it.
  void read_scale(const XmlTag& tag, VolumeSource& source) const {
    const double slope = numbers<double>(tag, "slope", 1).front(),
                 intercept = numbers<double>(tag, "intercept", 1).front();
    if (!(slope > 0) || !std::isfinite(slope)) fail_value("slope", "a number above 0", tag.value("slope"));
    if (!std::isfinite(intercept)) fail_value("intercept", "a finite number", tag.value("intercept"));
    source.slope = slope;
    source.intercept = intercept;
    if (source.scaled()) source.grid.type = SampleType::kFloat32;
  }

  ImageArray array_of(const XmlTag& tag) {
    ImageArray array;
    array.name = tag.value("Name");
    VolumeSource& source = array.source;
    source.name = header_.name;
    source.file = path_;
    source.big_endian = big_endian_;
    source.count_bytes = count_bytes_;
    const bool text = tag.value("type") == "String";
    // As text, characters are numbers with signs.
    const auto type = text ? (tag.value("format") == "ascii" ? StoredType::kInt8 : StoredType::kUint8)
                           : find_stored_type(tag.value("type"), TypeNames::kVtk);
    if (!type) set_form(array, "DataArray type", "a type of numbers", tag.value("type"));
    source.set_stored(type.value_or(StoredType::kUint8));
    if (tag.has("slope") || tag.has("intercept")) read_scale(tag, source);
    if (tag.has("NumberOfComponents"))
      source.components = numbers<std::size_t>(tag, "NumberOfComponents", 1).front();
    const std::string_view format = tag.value("format");
    if (compressed_ && format != "ascii") source.coding = SamplePacking::kVtkBlocks;
    if (format == "ascii") source.coding = SamplePacking::kText;
    if (format == "appended") {
      source.skip_bytes = numbers<std::uint64_t>(tag, "offset", 1).front();
      return array;
    }
    if (format != "ascii" && format != "binary" && array.missing.empty())
      array.missing = fmt::format("DataArray format: expected appended, binary or ascii, found '{}'",
                                  printable(format, kShown));
    source.base64 = format == "binary";
    source.before_tag = true;
    source.header_bytes = tag.text.value_or(0);
    return array;
  }

  /// Appended arrays begin behind the underscore that follows the tag.
  void find_appended(const XmlTag& tag) {
    const std::string_view encoding = tag.value("encoding");
    if (encoding != "raw" && encoding != "base64") {
      fail_value("AppendedData encoding", "raw or base64", encoding);
    }
    if (!tag.text) fail("{}: expected '_' before the appended data, found none", header_.name);
    const auto find = [&](ImageArray& array) {
      VolumeSource& source = array.source;
      if (source.before_tag) return;
      source.base64 = source.before_tag = encoding == "base64";
      source.header_bytes = *tag.text;
    };
    std::for_each(header_.arrays.begin(), header_.arrays.end(), find);
    if (names_) find(*names_);
  }

  void note_missing(ImageArray& array) const {
    if (!form_.empty()) {
      array.missing = form_;
      array.other_form = true;
    }
    // No values are at the beginning of a file.
    if (!array.missing.empty() || array.source.header_bytes > 0) return;
    array.missing = array.source.before_tag ? fmt::format("expected values of the array '{}', found none",
                                                          printable(array.name, kShown))
                                            : "expected appended data, found the file's end";
  }

  const std::vector<XmlTag>& tags_;
  const std::filesystem::path& path_;
  ImageHeader header_;
  std::string form_;    ///< why nothing can be read here, as ImageArray::missing
  std::string parent_;  ///< PointData, CellData or FieldData, while it is open
  std::vector<std::int64_t> extent_;
  std::optional<ImageArray> names_;  ///< the texts material_names
  std::size_t count_bytes_ = 0;
  bool has_image_ = false, has_piece_ = false, compressed_ = false, big_endian_ = false;
};

std::vector<XmlTag> read_tags(const std::filesystem::path& path) {
  return read_xml_tags(supply_file(FileHandle::open(path), 0), path.string());
}

/// What other forms of such files hold is left to VTK.
GridFile read_grid(const std::filesystem::path& path) {
  const std::vector<XmlTag> tags = read_tags(path);
  check_vtk_xml(tags, path);
  const ImageHeader header = vti_header(tags, path);
  const bool other = std::any_of(header.arrays.begin(), header.arrays.end(),
                                 [](const ImageArray& array) { return array.other_form; });
  return other ? read_grid_by_library(path) : grid_of(header, path);
}

bool is_vti(std::string_view bytes) {
  return bytes.starts_with("<") && bytes.find("<VTKFile") != std::string_view::npos &&
         bytes.find("ImageData") != std::string_view::npos;
}

}  // namespace

InputFormat vti_format() {
  return {.name = "VTK XML image",
          .endings = ".vti",
          .shown_by = is_vti,
          .read_header = [](const std::filesystem::path& path) { return vti_header(read_tags(path), path); },
          .read_grid = read_grid,
          .several_arrays = true};
}

ImageHeader vti_header(const std::vector<XmlTag>& tags, const std::filesystem::path& path) {
  return Parser(tags, path).run();
}

}  // namespace adamas
