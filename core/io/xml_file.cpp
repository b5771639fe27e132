#include "core/io/xml_file.h"

#include <expat.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/input_file.h"

namespace adamas::io {

namespace {

constexpr std::string_view kAppendedData = "AppendedData", kBlanks = " \t\r\n";

/// Collects the tags that expat reports. The handlers must not throw, since expat is C: they note the error
/// and stop it.
class TagReader {
 public:
  TagReader(const std::string& name, std::uint64_t most)
      : name_(name), most_(most), parser_(XML_ParserCreate(nullptr), XML_ParserFree) {
    if (!parser_) fail("{}: expected memory for reading XML, found none", name_);
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), open_tag, close_tag);
    XML_SetCharacterDataHandler(parser_.get(), note_text);
    XML_SetStartDoctypeDeclHandler(parser_.get(), refuse_document_type);
  }

  /// Returns false when nothing more is needed. An empty piece is the end of the file.
  bool add(std::string_view piece) {
    if (added_ == 0) check_characters(piece);
    added_ += piece.size();
    const auto status =
        XML_Parse(parser_.get(), piece.data(), static_cast<int>(piece.size()), piece.empty() ? 1 : 0);
    if (!fault_.empty()) fail("{}: {}", name_, fault_);
    if (appended_) return false;
    if (status != XML_STATUS_OK) {
      fail("{}: line {}: expected well-formed XML, found an error: {}", name_,
           XML_GetCurrentLineNumber(parser_.get()), XML_ErrorString(XML_GetErrorCode(parser_.get())));
    }
    // The limit also holds for the bytes that expat keeps until it sees the end of a tag.
    if (added_ - std::min<std::uint64_t>(position(), added_) > most_) fail("{}: {}", name_, too_long());
    return !piece.empty();
  }

  /// Searches for the underscore before appended data, in the last piece that was added and in the next ones.
  void find_appended_data(std::string_view piece, const ByteSupply& bytes) {
    if (!appended_) return;
    std::uint64_t at = tags_.back().end;
    piece.remove_prefix(static_cast<std::size_t>(at - (added_ - piece.size())));
    if (piece.empty()) piece = bytes();
    for (; !piece.empty(); piece = bytes()) {
      const std::size_t blanks = std::min(piece.find_first_not_of(kBlanks), piece.size());
      at += blanks;
      if (blanks == piece.size()) continue;
      if (piece[blanks] == '_') tags_.back().text = at + 1;
      return;
    }
  }

  [[nodiscard]] std::vector<XmlTag> take() { return std::move(tags_); }

 private:
  [[nodiscard]] std::string too_long() const {
    return fmt::format("expected tags of less than {} bytes, found more", most_);
  }

  /// Refuses UTF-16, which expat would read, since its texts are no bytes of numbers.
  void check_characters(std::string_view piece) const {
    const std::string_view begin = piece.substr(0, 2);
    if (begin == "\xff\xfe" || begin == "\xfe\xff" || begin.find('\0') != std::string_view::npos)
      fail("{}: expected XML of one byte per character or in UTF-8, found something else", name_);
  }

  [[nodiscard]] std::uint64_t position() const {
    return static_cast<std::uint64_t>(XML_GetCurrentByteIndex(parser_.get()));
  }

  void stop(std::string fault) {
    if (fault_.empty()) fault_ = std::move(fault);
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  void add_tag(XmlTag tag) {
    const auto bytes = static_cast<std::uint64_t>(XML_GetCurrentByteCount(parser_.get()));
    tag.end = position() + bytes;
    tag_bytes_ += bytes;
    if (tag_bytes_ > most_) stop(too_long());
    tags_.push_back(std::move(tag));
  }

  static void XMLCALL open_tag(void* user, const XML_Char* name, const XML_Char** attributes) {
    auto& self = *static_cast<TagReader*>(user);
    XmlTag tag;
    tag.name = name;
    for (; *attributes != nullptr; attributes += 2) tag.attributes[attributes[0]] = attributes[1];
    self.appended_ = tag.name == kAppendedData;
    self.add_tag(std::move(tag));
    self.open_.push_back(self.tags_.size() - 1);
    if (self.appended_) XML_StopParser(self.parser_.get(), XML_FALSE);
  }

  static void XMLCALL close_tag(void* user, const XML_Char* name) {
    auto& self = *static_cast<TagReader*>(user);
    if (self.appended_) return;
    XmlTag tag;
    tag.name = name;
    tag.closing = true;
    self.add_tag(std::move(tag));
    self.open_.pop_back();
  }

  static void XMLCALL note_text(void* user, const XML_Char* text, int size) {
    auto& self = *static_cast<TagReader*>(user);
    if (self.open_.empty() || self.tags_[self.open_.back()].text) return;
    const std::size_t begin =
        std::string_view(text, static_cast<std::size_t>(size)).find_first_not_of(kBlanks);
    if (begin != std::string_view::npos) self.tags_[self.open_.back()].text = self.position() + begin;
  }

  static void XMLCALL refuse_document_type(void* user, const XML_Char*, const XML_Char*, const XML_Char*,
                                           int) {
    static_cast<TagReader*>(user)->stop("expected XML without a document type, found one");
  }

  const std::string& name_;
  std::uint64_t most_;
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  std::vector<XmlTag> tags_;
  std::vector<std::size_t> open_;  ///< indices of the tags of open elements
  std::string fault_;
  std::uint64_t added_ = 0, tag_bytes_ = 0;
  bool appended_ = false;
};

std::string escaped(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\t':
    case '\n':
    case '\r':
      return "&#" + std::to_string(static_cast<int>(c)) + ";";
    default:
      return c >= 0 && c < ' ' ? "?" : std::string(1, c);
  }
}

}  // namespace

std::string_view XmlTag::value(std::string_view attribute) const {
  const auto found = attributes.find(attribute);
  return found == attributes.end() ? std::string_view() : found->second;
}

std::vector<XmlTag> read_xml_tags(const ByteSupply& bytes, const std::string& name, std::uint64_t most) {
  TagReader reader(name, most);
  std::string_view piece = bytes();
  while (reader.add(piece)) piece = bytes();
  reader.find_appended_data(piece, bytes);
  return reader.take();
}

bool fits_xml(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const bool control = length == 1 && escaped(text[0]) == "?" && text[0] != '?';
    if (length == 0 || control || text.starts_with("\xef\xbf\xbe") || text.starts_with("\xef\xbf\xbf"))
      return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string xml_attribute(const std::string& name) {
  std::string result;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t length = utf8_length(std::string_view(name).substr(at));
    if (length == 0) {
      const auto byte = static_cast<unsigned char>(name[at++]);
      result += static_cast<char>(0xc0u | (byte >> 6u));
      result += static_cast<char>(0x80u | (byte & 0x3fu));
    } else if (length == 1) {
      result += escaped(name[at++]);
    } else {
      result += name.substr(at, length);
      at += length;
    }
  }
  return result;
}

}  // namespace adamas::io
