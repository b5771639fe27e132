#include "core/io/zarr_reader.h"

#include <blosc.h>
#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/data/stored_type.h"
#include "core/io/grid_axes.h"
#include "core/io/grid_numbers.h"
#include "core/io/input_file.h"

namespace adamas::io {

namespace {

using Json = nlohmann::json;

/// The greatest number of axes: time, channel, z, y, x.
constexpr std::size_t kMostAxes = 5;
/// The greatest ratio of the samples' bytes to those of the files: chunks may be missing.
constexpr double kMostPacked = 1e5;

Json read_json(const std::filesystem::path& path) {
  try {
    return Json::parse(read_file(path));
  } catch (const Json::exception&) {
    fail("{}: expected metadata of Zarr as JSON, found something else", path.string());
  }
}

/// The metadata of an array of Zarr 2.
struct ArrayHead {
  StoredType type = StoredType::kUint8;
  bool big_endian = false;
  std::string compressor, separator = ".";
  std::vector<std::uint64_t> shape, chunk;
  double fill = 0;

  ArrayHead(const std::filesystem::path& path, const Json& json) {
    const std::string name = path.string();
    if (json.at("order") != "C" || !json.value("filters", Json()).is_null())
      fail("{}: expected chunks in order C without filters, found others", name);
    shape = json.at("shape").get<std::vector<std::uint64_t>>();
    chunk = json.at("chunks").get<std::vector<std::uint64_t>>();
    if (shape.size() < 3 || shape.size() > kMostAxes || chunk.size() != shape.size())
      fail("{}: expected 3 to 5 axes, found {}", name, shape.size());
    for (std::size_t a = 0; a < shape.size(); ++a) {
      constexpr std::uint64_t kLongest = std::uint64_t{1} << 32;
      if (shape[a] < 1 || chunk[a] < 1 || shape[a] >= kLongest || chunk[a] >= kLongest)
        fail("{}: expected axes with samples, found {} in chunks of {}", name, shape[a], chunk[a]);
    }
    set_type(name, json.at("dtype").get<std::string>());
    if (const Json how = json.value("compressor", Json()); !how.is_null())
      compressor = how.at("id").get<std::string>();
    separator = json.value("dimension_separator", ".");
    if (const Json value = json.value("fill_value", Json()); value.is_number()) fill = value.get<double>();
  }

  [[nodiscard]] std::size_t chunk_bytes() const {
    double bytes = static_cast<double>(stored_bytes(type));
    for (const std::uint64_t n : chunk) bytes *= static_cast<double>(n);
    return bytes < 0x1p40 ? static_cast<std::size_t>(bytes) : std::numeric_limits<std::size_t>::max();
  }

 private:
  void set_type(const std::string& name, const std::string& text) {
    const std::string kind = text.size() == 3 ? text.substr(1) : "";
    const std::array<std::pair<const char*, StoredType>, 11> types{{{"b1", StoredType::kUint8},
                                                                    {"i1", StoredType::kInt8},
                                                                    {"u1", StoredType::kUint8},
                                                                    {"i2", StoredType::kInt16},
                                                                    {"u2", StoredType::kUint16},
                                                                    {"i4", StoredType::kInt32},
                                                                    {"u4", StoredType::kUint32},
                                                                    {"i8", StoredType::kInt64},
                                                                    {"u8", StoredType::kUint64},
                                                                    {"f4", StoredType::kFloat32},
                                                                    {"f8", StoredType::kFloat64}}};
    const auto* const found =
        std::ranges::find_if(types, [&](const auto& entry) { return kind == entry.first; });
    if (found == types.end())
      fail("{}: expected whole numbers or floats of 8 to 64 bits, found '{}'", name, text);
    type = found->second;
    big_endian = text[0] == '>';
  }
};

/// Unpacks a chunk. Returns whether there are as many bytes as `to` has.
bool unpack(const std::string& compressor, const std::string& from, std::span<char> to) {
  if (compressor.empty()) {
    if (from.size() == to.size()) std::ranges::copy(from, to.begin());
    return from.size() == to.size();
  }
  if (compressor == "blosc") {
    std::size_t bytes = 0;
    return blosc_cbuffer_validate(from.data(), from.size(), &bytes) >= 0 && bytes == to.size() &&
           blosc_decompress_ctx(from.data(), to.data(), to.size(), 1) == static_cast<int>(to.size());
  }
  if (compressor == "zstd")
    return ZSTD_decompress(to.data(), to.size(), from.data(), from.size()) == to.size();
  z_stream stream{};
  constexpr int kBothHeaders = 15 + 32;  // of zlib and of gzip
  if (inflateInit2(&stream, kBothHeaders) != Z_OK) return false;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(from.data()));
  stream.avail_in = static_cast<uInt>(from.size());
  stream.next_out = reinterpret_cast<Bytef*>(to.data());
  stream.avail_out = static_cast<uInt>(to.size());
  const int result = inflate(&stream, Z_FINISH);
  const bool whole = result == Z_STREAM_END && stream.avail_out == 0;
  inflateEnd(&stream);
  return whole;
}

class ZarrReader {
 public:
  explicit ZarrReader(const std::filesystem::path& path) : path_(path), name_(path.string()) {}

  GridFile run(std::optional<std::uint64_t> time) {
    if (std::filesystem::exists(path_ / "zarr.json"))
      fail("{}: expected Zarr 2, as OME-Zarr 0.4 has it, found Zarr 3", name_);
    find_array();
    const ArrayHead head(array_ / ".zarray", read_json(array_ / ".zarray"));
    check(head, time);
    GridFile file;
    file.kind = "OME-Zarr";
    add_axes(head, file);
    visit_stored_type(head.type,
                      [&]<class Stored>(Stored) { add_channels<Stored>(head, time.value_or(0), file); });
    GridAxes axes;
    axes.origin = origin_;
    lay_out(axes, file);
    return file;
  }

 private:
  /// Finds the array, and the places of its samples.
  void find_array() {
    array_ = path_;
    if (std::filesystem::exists(path_ / ".zarray")) return;
    const Json attributes = read_json(path_ / ".zattrs");
    const Json& image = attributes.at("multiscales").at(0);
    const Json& set = image.at("datasets").at(0);
    const std::string path = set.at("path").get<std::string>();
    if (path.find("..") != std::string::npos)
      fail("{}: expected an array in the folder, found '{}'", name_, path);
    array_ = path_ / path;
    for (const Json& axis : image.value("axes", Json::array()))
      names_ += axis.is_object() ? axis.at("name").get<std::string>().substr(0, 1)
                                 : axis.get<std::string>().substr(0, 1);
    transform(set.value("coordinateTransformations", Json::array()));
    transform(image.value("coordinateTransformations", Json::array()));
    for (const Json& channel : attributes.value("omero", Json::object()).value("channels", Json::array()))
      channels_.push_back(channel.value("label", ""));
  }

  /// Takes a scale and a translation, whose last three numbers are of z, y and x.
  void transform(const Json& transformations) {
    for (const Json& one : transformations) {
      for (const char* kind : {"scale", "translation"}) {
        if (one.value("type", "") != kind || !one.contains(kind)) continue;
        const auto numbers = one.at(kind).get<std::vector<double>>();
        if (numbers.size() < 3)
          fail("{}: expected a {} of all axes, found {} numbers", name_, kind, numbers.size());
        const bool is_scale = kind == std::string_view("scale");
        for (int axis = 0; axis < 3; ++axis) {
          const double number = numbers[numbers.size() - 1 - static_cast<std::size_t>(axis)];
          if (!std::isfinite(number) || (is_scale && !(number > 0)))
            fail("{}: expected a {} of finite numbers, found {}", name_, kind, number);
          if (is_scale) {
            spacing_[axis] *= number;
            origin_[axis] *= number;
          } else {
            origin_[axis] += number;
          }
        }
      }
    }
  }

  void check(const ArrayHead& head, std::optional<std::uint64_t> time) const {
    const std::string expected = std::string("tczyx").substr(kMostAxes - head.shape.size());
    const bool as_times = head.shape.size() == 4 && names_ == "tzyx";
    if (!names_.empty() && names_ != expected && !as_times)
      fail("{}: expected axes in the order t, c, z, y, x, found '{}'", name_, names_);
    const std::uint64_t times = as_times || head.shape.size() == kMostAxes ? head.shape[0] : 1;
    if (times > 1 && !time)
      fail("{}: expected one time, or which of them by --time (0 to {}), found {}", name_, times - 1, times);
    if (time.value_or(0) >= times)
      fail("{}: expected a time from 0 to {}, found {}", name_, times - 1, *time);
    double samples = static_cast<double>(stored_bytes(head.type));
    for (const std::uint64_t n : head.shape) samples *= static_cast<double>(n);
    const auto files = static_cast<double>(size_of_folder(array_));
    if (samples / static_cast<double>(times) > kMostPacked * files ||
        static_cast<double>(head.chunk_bytes()) > kMostPacked * files)
      fail("{}: expected {:g} bytes of samples, found {:g} of chunks", name_, samples, files);
    for (const char* known : {"", "zlib", "gzip", "blosc", "zstd"}) {
      if (head.compressor == known) return;
    }
    fail("{}: expected chunks of zlib, gzip, Blosc or Zstandard, found '{}'", name_, head.compressor);
  }

  void add_axes(const ArrayHead& head, GridFile& file) const {
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const std::uint64_t count = head.shape[head.shape.size() - 1 - a];
      for (std::uint64_t i = 0; i <= count; ++i) {
        const auto at = static_cast<double>(i);
        if (i < count) file.nodes[a].push_back(at * spacing_[axis]);
        file.faces[a].push_back((at - 0.5) * spacing_[axis]);
      }
    }
  }

  template <class Stored>
  void add_channels(const ArrayHead& head, std::uint64_t time, GridFile& file) {
    const bool as_times = head.shape.size() == 4 && names_ == "tzyx";
    const std::uint64_t channels = head.shape.size() > 3 && !as_times ? head.shape[head.shape.size() - 4] : 1;
    for (std::uint64_t channel = 0; channel < channels; ++channel) {
      std::vector<std::uint64_t> first;
      if (head.shape.size() == kMostAxes) first = {time, channel};
      if (head.shape.size() == 4) first = {as_times ? time : channel};
      const std::vector<Stored> values = read_image<Stored>(head, first);
      GridArray array;
      const bool named = channel < channels_.size() && !channels_[channel].empty();
      array.name = named          ? channels_[channel]
                   : channels > 1 ? fmt::format("channel {}", channel)
                                  : file_stem(path_);
      array.type = stored_name(head.type);
      set_numbers(std::span(values), array);
      file.arrays.push_back(std::move(array));
    }
  }

  /// Reads the samples along z, y and x; `first`: the indices along the axes before these.
  template <class Stored>
  std::vector<Stored> read_image(const ArrayHead& head, const std::vector<std::uint64_t>& first) const {
    const std::size_t before = first.size();
    const std::span shape = std::span(head.shape).subspan(before),
                    chunk = std::span(head.chunk).subspan(before);
    std::vector<Stored> values(static_cast<std::size_t>(shape[0] * shape[1] * shape[2]),
                               static_cast<Stored>(head.fill));
    std::vector<char> bytes(head.chunk_bytes());
    // Where the image lies in chunks that have several times or channels.
    std::uint64_t offset = 0;
    for (std::size_t a = 0; a < before; ++a) offset = offset * head.chunk[a] + first[a] % head.chunk[a];
    offset *= chunk[0] * chunk[1] * chunk[2];
    std::array<std::uint64_t, 3> at{};
    for (at[0] = 0; at[0] * chunk[0] < shape[0]; ++at[0]) {
      for (at[1] = 0; at[1] * chunk[1] < shape[1]; ++at[1]) {
        for (at[2] = 0; at[2] * chunk[2] < shape[2]; ++at[2]) {
          if (!read_chunk(head, first, at, bytes)) continue;
          copy_chunk(head, at, bytes.data() + offset * sizeof(Stored), shape, chunk, values);
        }
      }
    }
    return values;
  }

  /// Reads and unpacks a chunk; returns false if there is none.
  bool read_chunk(const ArrayHead& head, const std::vector<std::uint64_t>& first,
                  const std::array<std::uint64_t, 3>& at, std::vector<char>& bytes) const {
    std::string place;
    for (std::size_t a = 0; a < first.size(); ++a)
      place += std::to_string(first[a] / head.chunk[a]) + head.separator;
    place += fmt::format("{}{}{}{}{}", at[0], head.separator, at[1], head.separator, at[2]);
    const std::filesystem::path path = array_ / place;
    std::error_code code;
    if (!std::filesystem::exists(path, code)) return false;
    if (!unpack(head.compressor, read_file(path), bytes))
      fail("{}: chunk {}: expected {} bytes of samples, found others", name_, place, bytes.size());
    return true;
  }

  /// Copies the part of a chunk that lies in the image.
  template <class Stored>
  static void copy_chunk(const ArrayHead& head, const std::array<std::uint64_t, 3>& at, const char* from,
                         std::span<const std::uint64_t> shape, std::span<const std::uint64_t> chunk,
                         std::vector<Stored>& values) {
    std::array<std::uint64_t, 3> begin{}, count{};
    for (std::size_t a = 0; a < 3; ++a) {
      begin[a] = at[a] * chunk[a];
      count[a] = std::min(chunk[a], shape[a] - begin[a]);
    }
    const bool swap = sizeof(Stored) > 1 && head.big_endian != (std::endian::native == std::endian::big);
    for (std::uint64_t z = 0; z < count[0]; ++z) {
      for (std::uint64_t y = 0; y < count[1]; ++y) {
        const char* row = from + ((z * chunk[1] + y) * chunk[2]) * sizeof(Stored);
        Stored* to = values.data() + ((begin[0] + z) * shape[1] + begin[1] + y) * shape[2] + begin[2];
        for (std::uint64_t x = 0; x < count[2]; ++x) {
          std::array<char, sizeof(Stored)> number{};
          std::memcpy(number.data(), row + x * sizeof(Stored), sizeof(Stored));
          if (swap) std::ranges::reverse(number);
          std::memcpy(to + x, number.data(), sizeof(Stored));
        }
      }
    }
  }

  const std::filesystem::path& path_;
  std::string name_;
  std::filesystem::path array_;
  std::string names_;  // the first letters of the axes' names; empty if none are stated
  Vec3 spacing_{1, 1, 1}, origin_;
  std::vector<std::string> channels_;
};

}  // namespace

GridFile read_zarr(const std::filesystem::path& path, std::optional<std::uint64_t> time) {
  try {
    return ZarrReader(path).run(time);
  } catch (const Json::exception& error) {
    fail("{}: expected the metadata of OME-Zarr 0.4, found others", path.string());
  }
}

}  // namespace adamas::io
