#include "core/io/byte_supply.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include "core/base/error.h"

namespace adamas::io {

namespace {

constexpr std::size_t kPiece = std::size_t{1} << 18;

constexpr int kNoDigit = -1, kBlank = -2;

constexpr std::array<int, 256> base64_digits() {
  std::array<int, 256> digits{};
  digits.fill(kNoDigit);
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kDigits.size(); ++i) {
    digits[static_cast<unsigned char>(kDigits[i])] = static_cast<int>(i);
  }
  for (const char blank : {' ', '\t', '\r', '\n'}) digits[static_cast<unsigned char>(blank)] = kBlank;
  return digits;
}

class Base64 {
 public:
  Base64(ByteSupply text, std::string name) : text_(std::move(text)), name_(std::move(name)) {}

  std::string_view next() {
    decoded_.clear();
    while (decoded_.empty()) {
      const std::string_view piece = text_();
      if (piece.empty()) {
        if (count_ != 0) fail("{}: expected whole groups of four base64 characters, found {}", name_, count_);
        break;
      }
      for (const char c : piece) add(c);
    }
    return decoded_;
  }

 private:
  void add(char c) {
    static constexpr auto kDigits = base64_digits();
    const int digit = kDigits[static_cast<unsigned char>(c)];
    if (digit == kBlank) return;
    // One or two fill characters end a group; only another fill character may follow them in it.
    const bool fills = c == '=' && count_ >= 2;
    if ((digit == kNoDigit && !fills) || (filled_ > 0 && !fills)) {
      fail("{}: expected base64 text, found a character of code {}", name_, static_cast<unsigned char>(c));
    }
    filled_ += fills ? 1 : 0;
    group_ = group_ << 6 | static_cast<unsigned>(fills ? 0 : digit);
    if (++count_ < 4) return;
    for (int byte = 0; byte < 3 - filled_; ++byte) {
      decoded_ += static_cast<char>(group_ >> (16 - 8 * byte) & 0xff);
    }
    count_ = filled_ = 0;
    group_ = 0;
  }

  ByteSupply text_;
  std::string name_, decoded_;
  unsigned group_ = 0;
  int count_ = 0, filled_ = 0;  ///< characters of the group, and fill characters among them
};

}  // namespace

ByteSupply supply_file(std::shared_ptr<const FileHandle> file, std::uint64_t begin) {
  return [file = std::move(file), begin, buffer = std::vector<char>(kPiece)]() mutable {
    const std::size_t count = file->read_some(begin, std::as_writable_bytes(std::span(buffer)));
    begin += count;
    return std::string_view(buffer.data(), count);
  };
}

ByteSupply supply_both(ByteSupply first, ByteSupply second) {
  return [first = std::move(first), second = std::move(second), ended = false]() mutable {
    const std::string_view piece = ended ? std::string_view() : first();
    if (!piece.empty()) return piece;
    ended = true;
    return second();
  };
}

ByteSupply supply_before(ByteSupply bytes, char mark) {
  return [bytes = std::move(bytes), mark, ended = false]() mutable {
    if (ended) return std::string_view();
    const std::string_view piece = bytes();
    const std::size_t end = piece.find(mark);
    ended = piece.empty() || end != std::string_view::npos;
    return piece.substr(0, end);
  };
}

ByteSupply supply_base64(ByteSupply text, std::string name) {
  return [decoder = std::make_shared<Base64>(std::move(text), std::move(name))] { return decoder->next(); };
}

std::string_view ByteTaker::take(std::uint64_t most) {
  if (piece_.empty()) piece_ = supply_();
  const std::string_view taken =
      piece_.substr(0, static_cast<std::size_t>(std::min<std::uint64_t>(most, std::string_view::npos - 1)));
  piece_.remove_prefix(taken.size());
  return taken;
}

bool ByteTaker::take_all(char* bytes, std::size_t size) {
  while (size > 0) {
    const std::string_view taken = take(size);
    if (taken.empty()) return false;
    std::memcpy(bytes, taken.data(), taken.size());
    bytes += taken.size();
    size -= taken.size();
  }
  return true;
}

ByteSupply ByteTaker::part(std::uint64_t size) {
  return [this, left = size]() mutable {
    const std::string_view taken = left > 0 ? take(left) : std::string_view();
    left -= taken.size();
    return taken;
  };
}

}  // namespace adamas::io
