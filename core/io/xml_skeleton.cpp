#include "core/io/xml_skeleton.h"

#include <algorithm>
#include <string_view>

#include "core/base/error.h"
#include "core/io/input_file.h"

namespace adamas {

namespace {

/// Bytes kept of a text between two tags.
constexpr std::size_t kKept = 64;

class Scanner {
 public:
  explicit Scanner(const std::string& name) : name_(name) {}

  /// False where nothing more is wanted.
  bool add(std::string_view piece) {
    while (!piece.empty()) {
      const std::size_t used = in_tag_ ? add_tag(piece) : add_between(piece);
      file_at_ += used;
      piece.remove_prefix(used);
      if (appended_ && !in_tag_ && kept_ == kKept) return false;
    }
    return true;
  }

  [[nodiscard]] XmlSkeleton take() { return std::move(skeleton_); }

 private:
  void keep(std::string_view bytes) {
    skeleton_.text += bytes;
    if (skeleton_.text.size() > kLongestHeader) {
      fail("{}: expected tags of less than {} bytes, found more", name_, kLongestHeader);
    }
  }

  std::size_t add_between(std::string_view piece) {
    const std::size_t end = appended_ ? piece.size() : std::min(piece.find('<'), piece.size());
    const std::size_t kept = std::min(end, kKept - kept_);
    keep(piece.substr(0, kept));
    kept_ += kept;
    if (end == piece.size()) return end;
    if (file_at_ + end != skeleton_.file_position(skeleton_.text.size())) {
      skeleton_.places.emplace_back(skeleton_.text.size(), file_at_ + end);
    }
    in_tag_ = true;
    tag_begin_ = skeleton_.text.size();
    quote_ = '\0';
    return end;
  }

  std::size_t add_tag(std::string_view piece) {
    std::size_t used = 0;
    while (used < piece.size() && in_tag_) {
      const std::size_t end =
          std::min(piece.find_first_of(quote_ != '\0' ? ends_of_quote() : "\"'>", used), piece.size());
      keep(piece.substr(used, end - used));
      used = end;
      if (used == piece.size()) break;
      keep(piece.substr(used, 1));
      end_part(piece[used++]);
    }
    return used;
  }

  [[nodiscard]] std::string_view ends_of_quote() const { return {&quote_, 1}; }
  [[nodiscard]] std::string_view tag() const { return std::string_view(skeleton_.text).substr(tag_begin_); }

  /// A quote or the end of a tag.
  void end_part(char c) {
    // Quotes mean nothing in comments.
    const bool comment = tag().starts_with("<!--");
    if (c != '>') {
      quote_ = quote_ != '\0' || comment ? '\0' : c;
      return;
    }
    if (comment && (!tag().ends_with("-->") || tag().size() < 7)) return;
    in_tag_ = false;
    kept_ = 0;
    appended_ = tag().starts_with("<AppendedData");
  }

  const std::string& name_;
  XmlSkeleton skeleton_;
  std::uint64_t file_at_ = 0;
  bool in_tag_ = false, appended_ = false;
  std::size_t tag_begin_ = 0, kept_ = 0;
  char quote_ = '\0';
};

}  // namespace

std::uint64_t XmlSkeleton::file_position(std::size_t at) const {
  const auto after =
      std::upper_bound(places.begin(), places.end(), at,
                       [](std::size_t place, const auto& entry) { return place < entry.first; });
  const auto& [here, there] = *std::prev(after);
  return there + (at - here);
}

XmlSkeleton read_xml_skeleton(const ByteSupply& bytes, const std::string& name) {
  Scanner scanner(name);
  for (std::string_view piece = bytes(); !piece.empty() && scanner.add(piece);) piece = bytes();
  return scanner.take();
}

}  // namespace adamas
