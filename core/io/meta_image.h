#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "core/io/image_header.h"

namespace adamas::io {

/// The lines "Key = value" of a MetaImage header, without blanks round the values.
struct MetaImageFields {
  std::map<std::string, std::string> values;
  std::size_t header_bytes = 0;  ///< the size up to the end of the line ElementDataFile, which is the last

  [[nodiscard]] bool has(const std::string& key) const { return values.contains(key); }
  /// The value of a key; empty if it is missing.
  [[nodiscard]] std::string value(const std::string& key) const;
  /// Whether a value begins with "true", in any case.
  [[nodiscard]] bool is_true(const std::string& key) const;
  /// Whether ElementDataFile says that the data follow the header.
  [[nodiscard]] bool is_local() const;
};

/// Reads the fields of a header. Throws Error with `name` unless the text begins with one.
MetaImageFields parse_meta_image_fields(std::string_view text, const std::string& name);

/// Reads the header at the beginning of the file `path` as that of an image; sizes of files are not checked.
/// Throws Error, with the path, unless it has one to three axes.
ImageHeader meta_image(std::string_view text, const std::filesystem::path& path);

}  // namespace adamas::io
