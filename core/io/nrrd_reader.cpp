#include "core/io/nrrd_reader.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <utility>

#include "core/base/error.h"
#include "core/io/bunzip_stream.h"
#include "core/io/inflate_stream.h"
#include "core/io/input_file.h"
#include "core/io/nrrd_header.h"

namespace adamas {

namespace {

/// The header's data, decoded to bytes (or still text), not more of them than it states.
std::string data_of(const NrrdHeader& header, std::string_view content, const std::string& name) {
  for (std::size_t i = 0; i < header.line_skip; ++i) {
    const std::size_t end = content.find('\n');
    if (end == std::string_view::npos)
      fail("{}: expected {} lines to skip, found {}", name, header.line_skip, i);
    content.remove_prefix(end + 1);
  }
  const std::size_t expected = header.value_count() * header.type_bytes;
  std::string data;
  if (header.encoding == NrrdEncoding::kGzip || header.encoding == NrrdEncoding::kBzip2) {
    const auto skip = static_cast<std::size_t>(std::max<std::int64_t>(header.byte_skip, 0));
    const auto take = [&](std::string_view piece) {
      data +=
          piece.substr(0, std::min(piece.size(), expected + skip - std::min(data.size(), expected + skip)));
    };
    if (header.encoding == NrrdEncoding::kGzip) {
      inflate_stream(content, name, take);
    } else {
      bunzip_stream(supply_text(content), name, take);
    }
    data.erase(0, std::min(skip, data.size()));
  } else {
    const std::size_t skip = header.byte_skip >= 0       ? static_cast<std::size_t>(header.byte_skip)
                             : content.size() > expected ? content.size() - expected
                                                         : 0;
    if (skip > content.size()) fail("{}: expected {} bytes to skip, found {}", name, skip, content.size());
    data = content.substr(skip);
  }
  if (header.encoding != NrrdEncoding::kText && data.size() < expected) {
    fail("{}: expected {} bytes of data, found {}", name, expected, data.size());
  }
  return data;
}

template <class T, class Out>
std::vector<Out> from_bytes(const NrrdHeader& header, const std::string& data) {
  std::vector<Out> values(header.value_count());
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), data.data() + i * sizeof(T), sizeof(T));
    if (header.big_endian) std::reverse(bytes.begin(), bytes.end());
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    values[i] = static_cast<Out>(value);
  }
  return values;
}

template <class Out>
std::vector<Out> from_text(const NrrdHeader& header, std::string_view data, const std::string& name) {
  constexpr std::string_view kSpace = " \t\r\n,";
  const std::size_t count = header.value_count();
  std::vector<Out> values;
  while (values.size() < count) {
    data.remove_prefix(std::min(data.find_first_not_of(kSpace), data.size()));
    const std::size_t end = data.find_first_of(kSpace);
    // A number at the file's very end may have been cut.
    if (end == std::string_view::npos)
      fail("{}: expected {} values, found {} whole ones", name, count, values.size());
    double value = 0;
    const auto [rest, code] = std::from_chars(data.data(), data.data() + end, value);
    const bool fits = std::is_floating_point_v<Out> || (value >= -2147483648.0 && value <= 2147483647.0);
    if (code != std::errc() || rest != data.data() + end || !fits) {
      fail("{}: expected {} values, found something else after {}", name, count, values.size());
    }
    values.push_back(static_cast<Out>(value));
    data.remove_prefix(end);
  }
  return values;
}

void decode(const NrrdHeader& header, const std::string& data, const std::string& name, GridArray& array) {
  const std::string& type = header.type;
  const bool whole = type[0] != 'f' && header.type_bytes <= 4 && type != "uint32";
  if (header.encoding == NrrdEncoding::kText && whole) {
    array.values = from_text<std::int32_t>(header, data, name);
  } else if (header.encoding == NrrdEncoding::kText) {
    array.values = from_text<float>(header, data, name);
  } else if (type == "int8") {
    array.values = from_bytes<std::int8_t, std::int32_t>(header, data);
  } else if (type == "uint8") {
    array.values = from_bytes<std::uint8_t, std::int32_t>(header, data);
  } else if (type == "int16") {
    array.values = from_bytes<std::int16_t, std::int32_t>(header, data);
  } else if (type == "uint16") {
    array.values = from_bytes<std::uint16_t, std::int32_t>(header, data);
  } else if (type == "int32") {
    array.values = from_bytes<std::int32_t, std::int32_t>(header, data);
  } else if (type == "uint32") {
    array.values = from_bytes<std::uint32_t, float>(header, data);
  } else if (type == "int64") {
    array.values = from_bytes<std::int64_t, float>(header, data);
  } else if (type == "uint64") {
    array.values = from_bytes<std::uint64_t, float>(header, data);
  } else if (type == "float32") {
    array.values = from_bytes<float, float>(header, data);
  } else {
    array.values = from_bytes<double, float>(header, data);
  }
}

/// Large whole numbers that fit after all keep their value.
void narrow(GridArray& array) {
  if (array.type != "uint32" && array.type != "int64" && array.type != "uint64") return;
  const auto& values = std::get<0>(array.values);
  constexpr float kExact = 16777216;
  if (std::any_of(values.begin(), values.end(), [](float v) { return v > kExact || v < -kExact; })) return;
  array.values = std::vector<std::int32_t>(values.begin(), values.end());
}

}  // namespace

GridFile read_nrrd(const std::filesystem::path& path) {
  const std::string name = path.string();
  const std::string content = read_file(path);
  const NrrdHeader header = parse_nrrd_header(content, name);
  std::string data;
  if (header.data_file.empty()) {
    data = data_of(header, std::string_view(content).substr(header.header_bytes), name);
  } else {
    const std::filesystem::path beside = path.parent_path() / header.data_file;
    data = data_of(header, read_file(beside), beside.string());
  }
  GridArray array;
  array.name = file_stem(path);
  array.type = header.type;
  array.components = static_cast<int>(std::min<std::size_t>(header.components, 1u << 30));
  decode(header, data, name, array);
  narrow(array);
  GridFile file;
  file.kind = "NRRD";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const NrrdCentering& center = header.centers[axis];
    file.stated[axis] = center.stated;
    for (std::size_t i = 0; i <= header.sizes[axis]; ++i) {
      const auto place = static_cast<double>(i);
      if (i < header.sizes[axis]) file.nodes[axis].push_back(place);
      file.faces[axis].push_back(center.first_face + place * center.cell);
    }
  }
  file.arrays.push_back(std::move(array));
  file.space = header.space;
  lay_out(header.axes, file);
  return file;
}

}  // namespace adamas
