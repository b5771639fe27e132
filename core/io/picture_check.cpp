#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/io/header_text.h"
#include "core/io/input_file.h"
#include "core/io/vtk_checks.h"

namespace adamas::io {

namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

/// Takes the words of a header, between which there are blanks and comments.
class PnmWords {
 public:
  PnmWords(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  std::string_view next(std::string_view what) {
    while (at_ < text_.size()) {
      at_ = std::min(text_.find_first_not_of(kBlanks, at_), text_.size());
      if (at_ == text_.size() || text_[at_] != '#') break;
      at_ = std::min(text_.find('\n', at_), text_.size());
    }
    const std::size_t end = text_.find_first_of(" \t\r\n\v\f#", at_);
    if (end == std::string_view::npos) fail("{}: expected {}, found the end of the header", name_, what);
    const std::string_view word = text_.substr(at_, end - at_);
    at_ = end;
    return word;
  }

  std::uint64_t number(std::string_view what, std::uint64_t most) {
    const std::string_view word = next(what);
    std::uint64_t value = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (code != std::errc() || end != word.data() + word.size() || value < 1 || value > most)
      fail("{}: expected {} from 1 to {}, found '{}'", name_, what, most, printable(word, 40));
    return value;
  }

  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

/// VTK looks for the rest of a header that is cut off without end, and takes samples of two bytes for twice
/// as many of one.
std::string check_pnm(const std::string& name, std::string_view text, std::uint64_t size) {
  constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 31, kMostValue = 255;
  PnmWords words(text, name);
  const std::string_view magic = words.next("P5 or P6");
  if (magic != "P5" && magic != "P6")
    fail("{}: expected a binary PGM or PPM (P5 or P6), found '{}'", name, printable(magic, 40));
  const std::uint64_t width = words.number("a width", kMostPixels),
                      height = words.number("a height", kMostPixels);
  words.number("a greatest value", kMostValue);
  const std::uint64_t channels = magic == "P6" ? 3 : 1, expected = width * height * channels,
                      left = size - words.at() - 1;
  if (left < expected) {
    fail("{}: expected {} bytes for {} x {} pixels of {}, found {}", name, expected, width, height, channels,
         left);
  }
  return left == expected ? ""
                          : fmt::format("{} bytes behind the first picture are not read", left - expected);
}

/// VTK crashes where the header is cut off.
void check_bmp(const std::string& name, std::uint64_t size) {
  constexpr std::uint64_t kHeader = 54;
  if (size < kHeader) fail("{}: expected a header of {} bytes, found {}", name, kHeader, size);
}

/// Of a picture of runs: pixels that are the same, once, or several of their own, behind a byte that says so.
void check_tga_runs(const std::string& name, std::uint64_t begin, std::uint64_t pixel, std::uint64_t pixels) {
  std::ifstream stream(name, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(begin));
  std::uint64_t found = 0;
  std::string skipped;
  while (found < pixels) {
    const int head = stream.get();
    if (head == std::ifstream::traits_type::eof()) break;
    constexpr int kSame = 128;
    const std::uint64_t run = static_cast<std::uint64_t>(head % kSame) + 1;
    skipped.resize((head >= kSame ? 1 : run) * pixel);
    if (!stream.read(skipped.data(), static_cast<std::streamsize>(skipped.size()))) break;
    found += run;
  }
  if (found < pixels) fail("{}: expected {} pixels, found {}", name, pixels, found);
}

/// VTK shows anything in place of pixels that are not there.
void check_tga(const std::string& name, std::string_view text, std::uint64_t size) {
  constexpr std::size_t kHeader = 18;
  if (text.size() < kHeader) fail("{}: expected a header of {} bytes, found {}", name, kHeader, text.size());
  const auto byte = [text](std::size_t at) { return std::uint64_t{static_cast<unsigned char>(text[at])}; };
  const auto word = [byte](std::size_t at) { return byte(at) | byte(at + 1) << 8; };
  const std::uint64_t pixel = (byte(16) + 7) / 8, pixels = word(12) * word(14),
                      begin = kHeader + byte(0) + (byte(1) != 0 ? word(5) * ((byte(7) + 7) / 8) : 0);
  constexpr unsigned kRunLengths = 8;
  const bool packed = (byte(2) & kRunLengths) != 0;
  // A run of up to 128 pixels takes one, and a byte.
  const std::uint64_t least = packed ? (pixels + 127) / 128 * (pixel + 1) : pixels * pixel,
                      left = size - std::min(begin, size);
  if (packed && left >= least) return check_tga_runs(name, begin, pixel, pixels);
  if (left < least) {
    fail("{}: expected {}{} bytes for {} x {} pixels of {}, found {}", name, least, packed ? " or more" : "",
         word(12), word(14), pixel, left);
  }
}

}  // namespace

std::string check_picture(const std::filesystem::path& path) {
  const std::string name = path.string(), extension = file_extension(path);
  const std::uint64_t size = check_input_file(path);
  if (extension == ".bmp") check_bmp(name, size);
  if (extension == ".tga") check_tga(name, read_beginning(path), size);
  const bool pnm = extension == ".pgm" || extension == ".ppm" || extension == ".pnm";
  return pnm ? check_pnm(name, read_beginning(path), size) : "";
}

}  // namespace adamas::io
