#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/byte_supply.h"
#include "core/io/input_file.h"

namespace adamas::io {

/// A tag of an XML file. <name/> counts as two tags, an opening and a closing one.
struct XmlTag {
  std::string name;
  bool closing = false;                                        ///< </name>
  std::map<std::string, std::string, std::less<>> attributes;  ///< in UTF-8, with references resolved
  std::uint64_t end = 0;                                       ///< the position in the file after the tag
  /// The position where the text between this tag and its closing tag begins; blanks and the text of inner
  /// elements do not count. Empty if there is no text. For a tag AppendedData it is the position after the
  /// underscore.
  std::optional<std::uint64_t> text;

  [[nodiscard]] bool has(std::string_view attribute) const { return attributes.contains(attribute); }
  /// The value of an attribute; empty if there is none.
  [[nodiscard]] std::string_view value(std::string_view attribute) const;
};

/// Reads the tags of an XML file, in order; texts of any length between them take no memory. What follows an
/// opening tag AppendedData is no XML and is not read. Throws Error with `name` if the file is not
/// well-formed, if its characters are no superset of ASCII, if it has a document type, whose entities could
/// stand for texts of any length, and if its tags together have more than `most` bytes.
std::vector<XmlTag> read_xml_tags(const ByteSupply& bytes, const std::string& name,
                                  std::uint64_t most = kLongestHeader);

/// Whether xml_attribute(text) represents the text without loss.
bool fits_xml(std::string_view text);

/// Encodes a name as the value of an XML attribute: markup and control characters as references, bytes that
/// are not UTF-8 taken as Latin-1, characters that XML does not allow as '?'. (VTK's writers put names into
/// files as they are.)
std::string xml_attribute(const std::string& name);

}  // namespace adamas::io
