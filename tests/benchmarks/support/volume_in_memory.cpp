#include "tests/benchmarks/support/volume_in_memory.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "core/io/volume_reader.h"
#include "core/io/volume_stack.h"
#include "datasets/buckyball.h"
#include "isosurface/volume/page.h"
#include "isosurface/volume/samples.h"
#include "tests/benchmarks/support/turbulence.h"

namespace adamas::bench {

using namespace datasets;
using namespace io;
using namespace isosurface;

namespace {

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
  return parts;
}

template <class Source>
VolumeInMemory read_planes(const std::string& name, const VolumeGrid& grid, Source&& source) {
  VolumeInMemory volume{name, grid, std::vector<std::byte>(grid.bytes())};
  for (std::uint64_t k = 0; k < grid.dimensions[2]; ++k)
    source(k, std::span(volume.bytes).subspan(k * grid.plane_bytes(), grid.plane_bytes()));
  return volume;
}

VolumeInMemory read_file(const std::string& name, VolumeReader reader) {
  return read_planes(name, reader.grid(),
                     [&](std::uint64_t k, std::span<std::byte> to) { reader.read_plane(k, to); });
}

/// Returns the type in the parts of a generated volume's name, NAME:SIDE[:TYPE].
SampleType generated_type(const std::vector<std::string>& parts) {
  const std::string type = parts.size() > 2 ? parts[2] : "uint8";
  return type == "uint8" ? SampleType::kUint8 : type == "uint16" ? SampleType::kUint16 : SampleType::kFloat32;
}

std::string generated_name(const std::vector<std::string>& parts) {
  return parts[0] + " " + parts.at(1) + "^3 " + sample_name(generated_type(parts));
}

VolumeInMemory make_buckyball(const std::vector<std::string>& parts) {
  const std::uint64_t side = std::stoull(parts.at(1));
  const Buckyball ball({side, side, side}, generated_type(parts));
  return read_planes(generated_name(parts), ball.grid(),
                     [&](std::uint64_t k, std::span<std::byte> to) { ball.plane(k, to); });
}

/// Returns turbulence with values from 0 to the greatest number of the type, or to 1 for float32.
VolumeInMemory make_turbulence(const std::vector<std::string>& parts) {
  const std::uint64_t side = std::stoull(parts.at(1));
  VolumeGrid grid;
  grid.dimensions = {side, side, side};
  grid.type = generated_type(parts);
  VolumeInMemory volume{generated_name(parts), grid, std::vector<std::byte>(grid.bytes())};
  const std::vector<float> values = turbulence(side);
  with_sample_type(grid.type, [&](auto sample) {
    using Sample = decltype(sample);
    for (std::size_t n = 0; n < values.size(); ++n) {
      if constexpr (std::is_floating_point_v<Sample>)
        sample = values[n];
      else
        sample =
            static_cast<Sample>(std::floor(std::numeric_limits<Sample>::max() * double{values[n]} + 0.5));
      std::memcpy(volume.bytes.data() + n * sizeof(Sample), &sample, sizeof(Sample));
    }
  });
  return volume;
}

RawVolume raw_form(const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  RawVolume raw;
  for (std::size_t axis = 0; axis < 3; ++axis) raw.dimensions[axis] = std::stoull(parts.at(axis));
  const std::string& type = parts.at(3);
  raw.type = type == "uint8"   ? StoredType::kUint8
             : type == "int16" ? StoredType::kInt16
                               : StoredType::kUint16;
  raw.header_bytes = std::stoull(parts.at(4));
  return raw;
}

}  // namespace

std::vector<std::byte> VolumeInMemory::ordered_words() const {
  std::vector<std::byte> words(bytes.size());
  with_sample_type(grid.type, [&](auto sample) {
    for (std::size_t n = 0; n < bytes.size(); n += sizeof(sample)) {
      std::memcpy(&sample, bytes.data() + n, sizeof(sample));
      const auto word = static_cast<OrderedWord<decltype(sample)>>(ordered(sample));
      std::memcpy(words.data() + n, &word, sizeof(sample));
    }
  });
  return words;
}

VolumeInMemory load_volume(const std::string& what) {
  const std::vector<std::string> parts = split(what, ':');
  if (parts.at(0) == "buckyball") return make_buckyball(parts);
  if (parts[0] == "turbulence") return make_turbulence(parts);
  const std::filesystem::path path = parts.back();
  if (parts[0] == "raw") return read_file(path.stem().string(), open_raw_volume(path, raw_form(parts.at(1))));
  if (parts[0] == "stack")
    return read_file(path.parent_path().filename().string(), open_volume_stack(match_stack(path)));
  return read_file(path.stem().string(), open_volume(path));
}

}  // namespace adamas::bench
