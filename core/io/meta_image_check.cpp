#include "core/io/meta_image_check.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/io/inflate_stream.h"
#include "core/io/input_file.h"

namespace adamas {

namespace {

using Header = std::map<std::string, std::string>;

bool is_matrix(const std::string& key) {
  return key == "TransformMatrix" || key == "Rotation" || key == "Orientation";
}

/// "Key = value" lines up to ElementDataFile, which is always the last; leaves the stream behind that line.
Header read_header(std::ifstream& stream, const std::string& name) {
  constexpr std::size_t kLines = 1000;
  Header header;
  std::string line;
  for (std::size_t i = 0; i < kLines && std::getline(stream, line); ++i) {
    const std::size_t equal = line.find('=');
    if (equal == std::string::npos) continue;
    std::string key, value;
    std::istringstream(line.substr(0, equal)) >> key;
    std::istringstream(line.substr(equal + 1)) >> std::ws >> value;
    if (key == "DimSize" || is_matrix(key)) value = line.substr(equal + 1);
    header[key] = value;
    if (key == "ElementDataFile") return header;
  }
  fail("{}: expected a MetaImage header with ElementDataFile, found none", name);
}

std::uint64_t element_bytes(const std::string& type) {
  if (type == "MET_CHAR" || type == "MET_UCHAR") return 1;
  if (type == "MET_SHORT" || type == "MET_USHORT") return 2;
  if (type == "MET_INT" || type == "MET_UINT" || type == "MET_FLOAT") return 4;
  if (type == "MET_DOUBLE" || type == "MET_LONG_LONG" || type == "MET_ULONG_LONG") return 8;
  return 0;
}

bool is_true(const Header& header, const std::string& key) {
  const auto found = header.find(key);
  return found != header.end() && !found->second.empty() &&
         (found->second[0] == 'T' || found->second[0] == 't');
}

/// Bytes that the header promises; 0 where it does not say.
std::uint64_t promised_bytes(const Header& header, const std::string& name) {
  if (!header.contains("DimSize") || !header.contains("ElementType")) return 0;
  std::uint64_t bytes = element_bytes(header.at("ElementType"));
  if (header.contains("ElementNumberOfChannels")) {
    std::uint64_t channels = 0;
    std::istringstream(header.at("ElementNumberOfChannels")) >> channels;
    bytes *= std::min<std::uint64_t>(channels, 1'000'000);
  }
  std::istringstream sizes(header.at("DimSize"));
  std::int64_t size = 0;
  while (sizes >> size) {
    constexpr std::uint64_t kMost = std::uint64_t{1} << 46;
    if (size < 1 || static_cast<std::uint64_t>(size) > kMost / std::max<std::uint64_t>(bytes, 1)) {
      fail("{}: expected sizes that can be, found DimSize {}", name, header.at("DimSize"));
    }
    bytes *= static_cast<std::uint64_t>(size);
  }
  return bytes;
}

}  // namespace

void check_meta_image(const std::filesystem::path& path) {
  std::string name = path.string();
  std::ifstream stream(path, std::ios::binary);
  const Header header = read_header(stream, name);
  const std::uint64_t expected = promised_bytes(header, name);
  const std::string& file = header.at("ElementDataFile");
  const bool text = header.contains("BinaryData") && !is_true(header, "BinaryData");
  if (expected == 0 || text || file == "LIST" || file.find('%') != std::string::npos) return;
  std::uint64_t at = 0, size = 0;
  if (file == "LOCAL" || file == "Local" || file == "local") {
    size = std::filesystem::file_size(path);
    // The stream has no position where the file ends with the header's last line.
    at = stream.good() ? static_cast<std::uint64_t>(stream.tellg()) : size;
  } else {
    const std::filesystem::path beside = path.parent_path() / file;
    name += ": " + beside.string();
    size = check_input_file(beside);
    stream = std::ifstream(beside, std::ios::binary);
  }
  std::uint64_t found = size - at;
  if (is_true(header, "CompressedData")) {
    std::string bytes(found, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    found = inflate_stream(bytes, name, [](std::string_view) {});
  }
  if (found < expected) fail("{}: expected {} bytes of data, found {}", name, expected, found);
}

std::optional<std::array<Vec3, 3>> meta_image_directions(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  const Header header = read_header(stream, path.string());
  const auto found =
      std::find_if(header.begin(), header.end(), [](const auto& entry) { return is_matrix(entry.first); });
  if (found == header.end()) return {};
  std::istringstream text(found->second);
  std::vector<double> numbers;
  for (double number = 0; numbers.size() <= 9 && text >> number;) numbers.push_back(number);
  if (numbers.size() != 4 && numbers.size() != 9) {
    fail("{}: {}: expected four or nine numbers, found {}", path.string(), found->first, numbers.size());
  }
  const std::size_t dimension = numbers.size() == 4 ? 2 : 3;
  std::array<Vec3, 3> directions{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    directions[i / dimension][static_cast<int>(i % dimension)] = numbers[i];
  }
  return directions;
}

}  // namespace adamas
