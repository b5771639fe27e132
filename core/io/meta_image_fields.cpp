#include "core/io/meta_image_fields.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"

namespace adamas {

namespace {

constexpr std::string_view kBlanks = " \t\r\f\v";

}  // namespace

std::string MetaImageFields::value(const std::string& key) const {
  const auto found = values.find(key);
  return found == values.end() ? "" : found->second;
}

bool MetaImageFields::is_true(const std::string& key) const {
  const std::string text = value(key);
  return !text.empty() && (text[0] == 'T' || text[0] == 't');
}

bool MetaImageFields::is_local() const {
  const std::string file = value("ElementDataFile");
  return file == "LOCAL" || file == "Local" || file == "local";
}

MetaImageFields parse_meta_image_fields(std::string_view text, const std::string& name) {
  constexpr std::size_t kLines = 1000;
  MetaImageFields fields;
  for (std::size_t i = 0; i < kLines && fields.header_bytes < text.size(); ++i) {
    const std::size_t begin = fields.header_bytes;
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    fields.header_bytes = std::min(end + 1, text.size());
    const std::size_t equal = line.find('=');
    if (equal == std::string_view::npos) continue;
    const std::string key(trimmed(line.substr(0, equal), kBlanks));
    fields.values[key] = trimmed(line.substr(equal + 1), kBlanks);
    if (key == "ElementDataFile") return fields;
  }
  fail("{}: expected a MetaImage header with ElementDataFile, found none", name);
}

}  // namespace adamas
