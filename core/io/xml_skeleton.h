#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/io/byte_supply.h"

namespace adamas {

/// The tags of an XML file without the long texts between them, so that a file of any size is parsed in
/// little memory.
struct XmlSkeleton {
  std::string text;  ///< tags, and the beginnings of what is between them
  /// Places in `text`, ascending, and in the file where the same bytes are.
  std::vector<std::pair<std::size_t, std::uint64_t>> places{{0, 0}};

  /// Where the byte `at` of the text is in the file.
  [[nodiscard]] std::uint64_t file_position(std::size_t at) const;
};

/// Reads up to the end of the file, or to the beginning of what follows the tag AppendedData, which is no
/// XML. Throws Error with `name` where the tags are longer than any header.
XmlSkeleton read_xml_skeleton(const ByteSupply& bytes, const std::string& name);

}  // namespace adamas
