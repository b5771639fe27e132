#include "core/io/meta_image_check.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/io/inflate_stream.h"
#include "core/io/input_file.h"
#include "core/io/meta_image_fields.h"
#include "core/io/number_list.h"

namespace adamas {

namespace {

bool is_matrix(const std::string& key) {
  return key == "TransformMatrix" || key == "Rotation" || key == "Orientation";
}

MetaImageFields read_fields(const std::filesystem::path& path) {
  return parse_meta_image_fields(read_beginning(path), path.string());
}

std::uint64_t element_bytes(const std::string& type) {
  if (type == "MET_CHAR" || type == "MET_UCHAR") return 1;
  if (type == "MET_SHORT" || type == "MET_USHORT") return 2;
  if (type == "MET_INT" || type == "MET_UINT" || type == "MET_FLOAT") return 4;
  if (type == "MET_DOUBLE" || type == "MET_LONG_LONG" || type == "MET_ULONG_LONG") return 8;
  return 0;
}

/// As many as there are axes: VTK does not stop at other numbers.
std::vector<std::int64_t> sizes(const MetaImageFields& header, const std::string& name) {
  constexpr std::uint64_t kMostAxes = 10;
  const std::string axes = header.has("NDims") ? header.value("NDims") : "";
  const auto count = parse_number_list<std::uint64_t>(axes);
  if (!count || count->size() != 1 || count->front() < 1 || count->front() > kMostAxes)
    fail("{}: NDims: expected a number from 1 to {}, found '{}'", name, kMostAxes, axes);
  const auto found = parse_number_list<std::int64_t>(header.value("DimSize"));
  if (!found || found->size() != count->front()) {
    fail("{}: DimSize: expected {} whole numbers, found '{}'", name, count->front(), header.value("DimSize"));
  }
  return *found;
}

/// Bytes that the header promises; 0 where it does not say.
std::uint64_t promised_bytes(const MetaImageFields& header, const std::string& name) {
  if (!header.has("DimSize") || !header.has("ElementType")) return 0;
  std::uint64_t bytes = element_bytes(header.value("ElementType"));
  if (header.has("ElementNumberOfChannels")) {
    std::uint64_t channels = 0;
    std::istringstream(header.value("ElementNumberOfChannels")) >> channels;
    bytes *= std::min<std::uint64_t>(channels, 1'000'000);
  }
  for (const std::int64_t size : sizes(header, name)) {
    constexpr std::uint64_t kMost = std::uint64_t{1} << 46;
    if (size < 1 || static_cast<std::uint64_t>(size) > kMost / std::max<std::uint64_t>(bytes, 1)) {
      fail("{}: expected sizes that can be, found DimSize {}", name, header.value("DimSize"));
    }
    bytes *= static_cast<std::uint64_t>(size);
  }
  return bytes;
}

}  // namespace

void check_meta_image(const std::filesystem::path& path) {
  std::string name = path.string();
  const MetaImageFields header = read_fields(path);
  const std::uint64_t expected = promised_bytes(header, name);
  const std::string file = header.value("ElementDataFile");
  const bool text = header.has("BinaryData") && !header.is_true("BinaryData");
  if (expected == 0 || text || file == "LIST" || file.find('%') != std::string::npos) return;
  std::filesystem::path data = path;
  std::uint64_t at = header.header_bytes;
  if (!header.is_local()) {
    data = path.parent_path() / file;
    name += ": " + data.string();
    at = 0;
  }
  const std::uint64_t size = check_input_file(data);
  std::uint64_t found = size - at;
  if (header.is_true("CompressedData")) {
    std::string bytes(found, '\0');
    std::ifstream stream(data, std::ios::binary);
    stream.seekg(static_cast<std::streamoff>(at));
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    found = inflate_stream(bytes, name, [](std::string_view) {});
  }
  if (found < expected) fail("{}: expected {} bytes of data, found {}", name, expected, found);
}

std::string meta_image_space(const std::filesystem::path& path) {
  return meta_image_space(read_fields(path));
}

std::string meta_image_space(const MetaImageFields& fields) {
  const std::string text = fields.value("AnatomicalOrientation");
  const bool known = text.size() == 3 && text.find_first_not_of("RLAPISrlapis") == std::string::npos;
  return known ? "LPS" : "";
}

std::optional<std::array<Vec3, 3>> meta_image_directions(const std::filesystem::path& path) {
  return meta_image_directions(read_fields(path), path.string());
}

std::optional<std::array<Vec3, 3>> meta_image_directions(const MetaImageFields& fields,
                                                         const std::string& name) {
  const auto& values = fields.values;
  const auto found =
      std::find_if(values.begin(), values.end(), [](const auto& entry) { return is_matrix(entry.first); });
  if (found == values.end()) return {};
  std::istringstream text(found->second);
  std::vector<double> numbers;
  for (double number = 0; numbers.size() <= 9 && text >> number;) numbers.push_back(number);
  if (numbers.size() != 4 && numbers.size() != 9) {
    fail("{}: {}: expected four or nine numbers, found {}", name, found->first, numbers.size());
  }
  const std::size_t dimension = numbers.size() == 4 ? 2 : 3;
  std::array<Vec3, 3> directions{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    directions[i / dimension][static_cast<int>(i % dimension)] = numbers[i];
  }
  return directions;
}

}  // namespace adamas
