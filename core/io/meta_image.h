#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "core/io/image_header.h"

namespace adamas::io {

/// The lines "Key = value" of a MetaImage header, blanks round the values apart.
struct MetaImageFields {
  std::map<std::string, std::string> values;
  std::size_t header_bytes = 0;  ///< up to the end of the line ElementDataFile, which is the last

  [[nodiscard]] bool has(const std::string& key) const { return values.contains(key); }
  /// The value of a key; empty where it is missing.
  [[nodiscard]] std::string value(const std::string& key) const;
  /// Whether a value is "True", in any spelling that begins so.
  [[nodiscard]] bool is_true(const std::string& key) const;
  /// Whether ElementDataFile says that the data follow the header.
  [[nodiscard]] bool is_local() const;
};

/// Reads the fields of a header. Throws Error with `name` where the text does not begin with one.
MetaImageFields parse_meta_image_fields(std::string_view text, const std::string& name);

/// The header that begins the file `path` as that of an image; sizes of files are not looked at. Throws
/// Error, with the path, where it is none of one to three axes.
ImageHeader meta_image(std::string_view text, const std::filesystem::path& path);

}  // namespace adamas::io
