#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace adamas {

/// A tag of an XML text; the values of attributes stand as they are written, with references in them.
struct XmlTag {
  std::string_view name;
  bool closing = false;  ///< </name>
  bool empty = false;    ///< <name/>
  std::map<std::string_view, std::string_view> attributes;

  [[nodiscard]] bool has(std::string_view attribute) const { return attributes.contains(attribute); }
  /// Empty where there is none.
  [[nodiscard]] std::string_view value(std::string_view attribute) const;
};

/// Walks over the tags of a text; what is between them, comments and declarations are passed over.
class XmlTags {
 public:
  XmlTags(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  /// Nothing at the end of the text. Throws Error with `name` where a tag is broken off or malformed.
  std::optional<XmlTag> next();
  /// Behind the last tag.
  [[nodiscard]] std::size_t position() const { return at_; }

 private:
  [[nodiscard]] bool skip_other();
  [[nodiscard]] std::string_view word();
  void skip_blanks();
  [[noreturn]] void malformed(std::size_t begin) const;

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

}  // namespace adamas
