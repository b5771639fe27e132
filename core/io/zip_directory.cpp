#include "core/io/zip_directory.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <string_view>

#include "core/base/error.h"
#include "core/io/header_text.h"

namespace adamas::io {

namespace {

/// The sizes of records without their texts, and the signatures that they begin with.
constexpr std::size_t kEndBytes = 22, kLocatorBytes = 20, kLargeEndBytes = 56, kEntryBytes = 46,
                      kMemberBytes = 30;
constexpr std::uint32_t kEnd = 0x06054b50, kLocator = 0x07064b50, kLargeEnd = 0x06064b50, kEntry = 0x02014b50,
                        kMember = 0x04034b50;
/// A number that is in the additional field of large archives instead.
constexpr std::uint64_t kElsewhere = 0xffffffff;
constexpr std::uint64_t kLongestComment = 0xffff;
constexpr std::uint64_t kLongestDirectory = std::uint64_t{1} << 26;

template <class T>
T number(std::string_view bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

class Archive {
 public:
  explicit Archive(const FileHandle& file) : file_(file) {}

  std::vector<ZipMember> list() {
    find_directory();
    const std::string text = bytes(directory_, directory_bytes_);
    std::string_view rest = text;
    std::vector<ZipMember> members;
    for (std::uint64_t i = 0; i < count_; ++i) members.push_back(next(rest));
    return members;
  }

 private:
  [[noreturn]] void refuse() const {
    fail("{}: expected a whole zip archive, found one that is truncated or corrupt", file_.name());
  }

  [[nodiscard]] std::string bytes(std::uint64_t at, std::uint64_t count) const {
    if (at > file_.size() || count > file_.size() - at) refuse();
    std::string result(static_cast<std::size_t>(count), '\0');
    if (file_.read_some(at, std::as_writable_bytes(std::span(result))) != result.size()) refuse();
    return result;
  }

  /// Finds the directory by the record at the end of the archive, behind which only a comment may stand.
  void find_directory() {
    const std::uint64_t most = std::min(file_.size(), kEndBytes + kLongestComment);
    const std::uint64_t begin = file_.size() - most;
    const std::string tail = bytes(begin, most);
    std::size_t at = tail.size() >= kEndBytes ? tail.size() - kEndBytes + 1 : 0;
    const auto is_end = [&] {
      return number<std::uint32_t>(tail, at) == kEnd &&
             at + kEndBytes + number<std::uint16_t>(tail, at + 20) == tail.size();
    };
    do {
      if (at == 0) refuse();
      --at;
    } while (!is_end());
    count_ = number<std::uint16_t>(tail, at + 10);
    directory_bytes_ = number<std::uint32_t>(tail, at + 12);
    directory_ = number<std::uint32_t>(tail, at + 16);
    if (count_ == 0xffff || directory_bytes_ == kElsewhere || directory_ == kElsewhere)
      find_large_directory(begin + at);
    if (directory_bytes_ > kLongestDirectory) refuse();
  }

  /// Finds the directory of a large archive. `end`: the place of the record at its end.
  void find_large_directory(std::uint64_t end) {
    if (end < kLocatorBytes) refuse();
    const std::string locator = bytes(end - kLocatorBytes, kLocatorBytes);
    if (number<std::uint32_t>(locator, 0) != kLocator) refuse();
    const std::string large = bytes(number<std::uint64_t>(locator, 8), kLargeEndBytes);
    if (number<std::uint32_t>(large, 0) != kLargeEnd) refuse();
    count_ = number<std::uint64_t>(large, 32);
    directory_bytes_ = number<std::uint64_t>(large, 40);
    directory_ = number<std::uint64_t>(large, 48);
  }

  /// Takes the next entry from the rest of the directory.
  ZipMember next(std::string_view& rest) const {
    if (rest.size() < kEntryBytes || number<std::uint32_t>(rest, 0) != kEntry) refuse();
    const auto flags = number<std::uint16_t>(rest, 8), method = number<std::uint16_t>(rest, 10);
    ZipMember member;
    member.checksum = number<std::uint32_t>(rest, 16);
    member.packed = number<std::uint32_t>(rest, 20);
    member.size = number<std::uint32_t>(rest, 24);
    std::uint64_t place = number<std::uint32_t>(rest, 42);
    const std::size_t name = number<std::uint16_t>(rest, 28), extra = number<std::uint16_t>(rest, 30),
                      comment = number<std::uint16_t>(rest, 32);
    if (rest.size() < kEntryBytes + name + extra + comment) refuse();
    member.name = rest.substr(kEntryBytes, name);
    take_large_numbers(rest.substr(kEntryBytes + name, extra), member, place);
    rest.remove_prefix(kEntryBytes + name + extra + comment);

    member.deflated = method == 8;
    member.is_readable = (flags & 1u) == 0 && (method == 0 || method == 8);
    // Texts before the bytes of a member may have other lengths than in the directory.
    const std::string head = bytes(place, kMemberBytes);
    if (number<std::uint32_t>(head, 0) != kMember) refuse();
    member.begin = place + kMemberBytes + number<std::uint16_t>(head, 26) + number<std::uint16_t>(head, 28);
    if (member.begin > file_.size() || member.packed > file_.size() - member.begin) refuse();
    if (method == 0 && member.packed != member.size) refuse();
    return member;
  }

  /// Takes the numbers that do not fit into 32 bits from an entry's additional fields.
  void take_large_numbers(std::string_view fields, ZipMember& member, std::uint64_t& place) const {
    constexpr std::size_t kHead = 4;
    constexpr std::uint16_t kLargeNumbers = 1;
    while (fields.size() >= kHead) {
      const auto kind = number<std::uint16_t>(fields, 0), size = number<std::uint16_t>(fields, 2);
      fields.remove_prefix(kHead);
      if (size > fields.size()) refuse();
      std::string_view numbers = fields.substr(0, size);
      fields.remove_prefix(size);
      if (kind != kLargeNumbers) continue;
      for (std::uint64_t* value : {&member.size, &member.packed, &place}) {
        if (*value != kElsewhere) continue;
        if (numbers.size() < sizeof(std::uint64_t)) refuse();
        *value = number<std::uint64_t>(numbers, 0);
        numbers.remove_prefix(sizeof(std::uint64_t));
      }
    }
  }

  const FileHandle& file_;
  std::uint64_t count_ = 0, directory_ = 0, directory_bytes_ = 0;
};

}  // namespace

std::vector<ZipMember> list_zip_archive(const FileHandle& file) { return Archive(file).list(); }

}  // namespace adamas::io
