#include "core/io/zarr_array.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>
#include <numeric>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/parallel.h"

namespace adamas::io {

namespace {

static_assert(std::endian::native == std::endian::little, "samples are written as they are");

constexpr int kZlibLevel = 6;

const char* zarr_type(StoredType type) {
  constexpr const char* kNames[] = {"|i1", "|u1", "<i2", "<u2", "<i4", "<u4", "<i8", "<u8", "<f4", "<f8"};
  return kNames[static_cast<std::size_t>(type)];
}

void make_folder(const std::filesystem::path& path) {
  std::error_code code;
  std::filesystem::create_directories(path, code);
  if (code) fail("{}: could not be made: {}", path.string(), code.message());
}

/// Writes a file under its final name at once, since the folder above it has a temporary name.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  errno = 0;
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream)
    fail_as(writing_failure(errno), "{}: could not be written: {}", path.string(),
            errno != 0 ? std::strerror(errno) : "short write");
}

std::vector<std::byte> compressed(std::span<const std::byte> bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::byte> result(size);
  if (compress2(reinterpret_cast<Bytef*>(result.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), kZlibLevel) != Z_OK)
    throw std::bad_alloc();
  result.resize(size);
  return result;
}

}  // namespace

ZarrArray::ZarrArray(std::filesystem::path folder, const VolumeGrid& grid, StoredType type,
                     std::optional<std::uint64_t> steps)
    : folder_(std::move(folder)), grid_(grid), type_(type), steps_(steps) {
  for (std::size_t axis = 0; axis < 3; ++axis) chunk_[axis] = std::min(kSide, grid.dimensions[axis]);
  make_folder(folder_);
  write_header();
}

void ZarrArray::write_header() const {
  const auto [nx, ny, nz] = grid_.dimensions;
  const std::string text = fmt::format(
      R"({{
  "zarr_format": 2,
  "shape": [{}{}, {}, {}],
  "chunks": [{}{}, {}, {}],
  "dtype": "{}",
  "compressor": {{"id": "zlib", "level": {}}},
  "fill_value": 0,
  "order": "C",
  "filters": null,
  "dimension_separator": "/"
}}
)",
      steps_ ? fmt::format("{}, ", *steps_) : "", nz, ny, nx, steps_ ? "1, " : "", chunk_[2], chunk_[1],
      chunk_[0], zarr_type(type_), kZlibLevel);
  write_file(folder_ / ".zarray", std::as_bytes(std::span(text)));
}

void ZarrArray::Step::write_plane(std::span<const std::byte> samples) {
  const VolumeGrid& grid = array_.grid_;
  ADAMAS_ASSERT(samples.size() == array_.plane_bytes() && planes_ < grid.dimensions[2]);
  slab_.insert(slab_.end(), samples.begin(), samples.end());
  ++planes_;
  if (planes_ % array_.chunk_[2] != 0 && planes_ < grid.dimensions[2]) return;
  array_.write_slab(step_, planes_ - slab_.size() / array_.plane_bytes(), slab_);
  slab_.clear();
}

void ZarrArray::write_slab(std::uint64_t step, std::uint64_t first, std::span<const std::byte> planes) {
  std::filesystem::path folder = folder_;
  if (steps_) folder /= std::to_string(step);
  folder /= std::to_string(first / chunk_[2]);
  const auto chunks = [this](std::size_t axis) {
    return (grid_.dimensions[axis] + chunk_[axis] - 1) / chunk_[axis];
  };
  for (std::uint64_t y = 0; y < chunks(1); ++y) make_folder(folder / std::to_string(y));
  std::vector<std::uint64_t> sizes(chunks(0) * chunks(1));
  parallel_for(sizes.size(), 1, [&](std::size_t n) {
    const std::uint64_t x = n % chunks(0), y = n / chunks(0);
    const std::vector<std::byte> bytes = compressed(chunk(x, y, planes));
    write_file(folder / std::to_string(y) / std::to_string(x), bytes);
    sizes[n] = bytes.size();
  });
  bytes_ = std::accumulate(sizes.begin(), sizes.end(), bytes_);
}

std::vector<std::byte> ZarrArray::chunk(std::uint64_t x, std::uint64_t y,
                                        std::span<const std::byte> planes) const {
  const std::size_t width = stored_bytes(type_);
  const std::uint64_t row = grid_.dimensions[0] * width, rows = grid_.dimensions[1];
  const std::uint64_t x0 = x * chunk_[0], y0 = y * chunk_[1];
  const std::uint64_t bytes = std::min(chunk_[0], grid_.dimensions[0] - x0) * width;
  std::vector<std::byte> result(chunk_[0] * chunk_[1] * chunk_[2] * width);
  for (std::uint64_t k = 0; k < planes.size() / plane_bytes(); ++k) {
    for (std::uint64_t j = y0; j < std::min(y0 + chunk_[1], rows); ++j) {
      const std::uint64_t to = (k * chunk_[1] + j - y0) * chunk_[0] * width;
      std::memcpy(result.data() + to, planes.data() + (k * rows + j) * row + x0 * width, bytes);
    }
  }
  return result;
}

}  // namespace adamas::io
