#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/header_text.h"
#include "core/io/image_header.h"
#include "core/io/xml_file.h"

namespace adamas::io {

/// Reads the tags of an XML file of VTK that give the places and forms of its arrays.
class VtkXmlArrays {
 public:
  VtkXmlArrays(std::string name, std::filesystem::path file)
      : name_(std::move(name)), file_(std::move(file)) {}

  [[noreturn]] void fail_value(std::string_view what, std::string_view expected,
                               std::string_view found) const;
  template <class T>
  std::vector<T> numbers(const XmlTag& tag, std::string_view attribute, std::size_t count) const {
    const auto values = parse_number_list<T>(tag.value(attribute));
    if (!values || values->size() != count)
      fail_value(attribute, fmt::format("{} numbers", count), tag.value(attribute));
    return *values;
  }

  /// Reads the tag VTKFile, whose attributes hold for all arrays.
  void read_file_tag(const XmlTag& tag);
  [[nodiscard]] bool has_file_tag() const { return count_bytes_ != 0; }
  /// The array of a tag, without its grid. The place of an appended array is not known yet.
  [[nodiscard]] ImageArray array_of(const XmlTag& tag) const;
  /// Sets the place of an appended array by the tag AppendedData.
  void find_appended(const XmlTag& tag, VolumeSource& source) const;

 private:
  void read_scale(const XmlTag& tag, VolumeSource& source) const;

  std::string name_;
  std::filesystem::path file_;
  std::size_t count_bytes_ = 0;
  bool compressed_ = false, big_endian_ = false;
};

/// The end of a message about a value of a header.
std::string expected_value(std::string_view what, std::string_view expected, std::string_view found);

}  // namespace adamas::io
