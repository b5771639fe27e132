#include "core/io/vtk_xml_array.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/error.h"

namespace adamas::io {

namespace {

/// The names of all components; empty if one is missing.
std::vector<std::string> component_names(const XmlTag& tag, std::size_t components) {
  std::vector<std::string> names;
  while (names.size() < components) {
    const std::string_view name = tag.value(fmt::format("ComponentName{}", names.size()));
    if (name.empty()) return {};
    names.emplace_back(name);
  }
  return names;
}

}  // namespace

void VtkXmlArrays::fail_value(std::string_view what, std::string_view expected,
                              std::string_view found) const {
  fail("{}: {}", name_, expected_value(what, expected, found));
}

void VtkXmlArrays::read_file_tag(const XmlTag& tag) {
  compressed_ = tag.has("compressor");
  const std::string_view order = tag.value("byte_order"), count = tag.value("header_type");
  if (tag.has("byte_order") && order != "LittleEndian" && order != "BigEndian")
    fail_value("byte_order", "LittleEndian or BigEndian", order);
  if (tag.has("header_type") && count != "UInt32" && count != "UInt64")
    fail_value("header_type", "UInt32 or UInt64", count);
  big_endian_ = order == "BigEndian";
  count_bytes_ = count == "UInt64" ? 8 : 4;
}

/// Reads the scale of an array as write_point_arrays writes it.
void VtkXmlArrays::read_scale(const XmlTag& tag, VolumeSource& source) const {
  const double slope = numbers<double>(tag, "slope", 1).front(),
               intercept = numbers<double>(tag, "intercept", 1).front();
  if (!(slope > 0) || !std::isfinite(slope)) fail_value("slope", "a number above 0", tag.value("slope"));
  if (!std::isfinite(intercept)) fail_value("intercept", "a finite number", tag.value("intercept"));
  source.slope = slope;
  source.intercept = intercept;
  if (source.scaled()) source.grid.type = SampleType::kFloat32;
}

ImageArray VtkXmlArrays::array_of(const XmlTag& tag) const {
  ImageArray array;
  array.name = tag.value("Name");
  VolumeSource& source = array.source;
  source.name = name_;
  source.file = file_;
  source.big_endian = big_endian_;
  source.count_bytes = count_bytes_;
  const std::string_view format = tag.value("format");
  const bool text = tag.value("type") == "String";
  // In a text file, characters are written as signed numbers.
  const auto type = text ? (format == "ascii" ? StoredType::kInt8 : StoredType::kUint8)
                         : find_stored_type(tag.value("type"), TypeNames::kVtk);
  if (!type) {
    array.other_form = true;
    array.missing = expected_value("DataArray type", "a type of numbers", tag.value("type"));
  }
  source.set_stored(type.value_or(StoredType::kUint8));
  if (tag.has("slope") || tag.has("intercept")) read_scale(tag, source);
  if (tag.has("NumberOfComponents"))
    source.components = numbers<std::size_t>(tag, "NumberOfComponents", 1).front();
  array.component_names = component_names(tag, source.components);
  if (compressed_ && format != "ascii") source.coding = SamplePacking::kVtkBlocks;
  if (format == "ascii") source.coding = SamplePacking::kText;
  if (format == "appended") {
    source.skip_bytes = numbers<std::uint64_t>(tag, "offset", 1).front();
    return array;
  }
  if (format != "ascii" && format != "binary" && array.missing.empty())
    array.missing = expected_value("DataArray format", "appended, binary or ascii", format);
  source.base64 = format == "binary";
  source.before_tag = true;
  source.trailing = TrailingBytes::kRefused;
  source.header_bytes = tag.text.value_or(0);
  return array;
}

void VtkXmlArrays::find_appended(const XmlTag& tag, VolumeSource& source) const {
  const std::string_view encoding = tag.value("encoding");
  if (encoding != "raw" && encoding != "base64")
    fail_value("AppendedData encoding", "raw or base64", encoding);
  if (!tag.text) fail("{}: expected '_' before the appended data, found none", name_);
  if (source.before_tag) return;
  source.base64 = source.before_tag = encoding == "base64";
  // Arrays begin after the underscore that follows the tag.
  source.header_bytes = *tag.text;
}

std::string expected_value(std::string_view what, std::string_view expected, std::string_view found) {
  constexpr std::size_t kShown = 40;
  return fmt::format("{}: expected {}, found '{}'", what, expected, printable(found, kShown));
}

}  // namespace adamas::io
