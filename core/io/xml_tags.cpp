#include "core/io/xml_tags.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/io/printable.h"

namespace adamas {

namespace {

constexpr std::string_view kBlanks = " \t\r\n";

}  // namespace

std::string_view XmlTag::value(std::string_view attribute) const {
  const auto found = attributes.find(attribute);
  return found == attributes.end() ? std::string_view() : found->second;
}

void XmlTags::malformed(std::size_t begin) const {
  fail("{}: expected a whole XML tag, found '{}'", name_, printable(text_.substr(begin), 40));
}

void XmlTags::skip_blanks() { at_ = std::min(text_.find_first_not_of(kBlanks, at_), text_.size()); }

std::string_view XmlTags::word() {
  const std::size_t begin = at_;
  at_ = std::min(text_.find_first_of(" \t\r\n=/<>\"'", at_), text_.size());
  return text_.substr(begin, at_ - begin);
}

/// A comment or a declaration at the present place.
bool XmlTags::skip_other() {
  const std::string_view rest = text_.substr(at_);
  const std::string_view end = rest.starts_with("<!--") ? "-->"
                               : rest.starts_with("<?") ? "?>"
                               : rest.starts_with("<!") ? ">"
                                                        : "";
  if (end.empty()) return false;
  const std::size_t found = text_.find(end, at_);
  if (found == std::string_view::npos) malformed(at_);
  at_ = found + end.size();
  return true;
}

std::optional<XmlTag> XmlTags::next() {
  do {
    at_ = text_.find('<', at_);
    if (at_ == std::string_view::npos) {
      at_ = text_.size();
      return {};
    }
  } while (skip_other());
  const std::size_t begin = at_++;
  XmlTag tag;
  if (at_ < text_.size() && text_[at_] == '/') tag.closing = true, ++at_;
  tag.name = word();
  while (true) {
    skip_blanks();
    if (at_ < text_.size() && text_[at_] == '/' && !tag.empty) {
      tag.empty = true, ++at_;
    } else if (at_ < text_.size() && text_[at_] == '>' && !tag.name.empty()) {
      ++at_;
      return tag;
    } else {
      const std::string_view key = word();
      skip_blanks();
      if (key.empty() || tag.empty || at_ >= text_.size() || text_[at_++] != '=') malformed(begin);
      skip_blanks();
      if (at_ >= text_.size() || (text_[at_] != '"' && text_[at_] != '\'')) malformed(begin);
      const std::size_t end = text_.find(text_[at_], at_ + 1);
      if (end == std::string_view::npos) malformed(begin);
      tag.attributes[key] = text_.substr(at_ + 1, end - at_ - 1);
      at_ = end + 1;
    }
  }
}

}  // namespace adamas
