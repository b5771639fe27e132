#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "adamas/volume.h"
#include "core/data/stored_type.h"

namespace adamas::io {

/// An array of a Zarr store, version 2 of the format: a folder with `.zarray` and a file for each chunk,
/// named t/z/y/x for a series and z/y/x for a volume. A chunk has one step and at most 64 samples along each
/// axis, least byte first, x fastest, as a zlib stream; outside the volume it has zeros. Equal samples give
/// equal bytes.
class ZarrArray {
 public:
  static constexpr std::uint64_t kSide = 64;

  /// Makes the folder, in an existing one, and writes `.zarray`. `steps`: the number of steps of a series.
  /// Throws Error if they cannot be written.
  /// `type`: that of the numbers of planes.
  ZarrArray(std::filesystem::path folder, const VolumeGrid& grid, StoredType type,
            std::optional<std::uint64_t> steps);

  [[nodiscard]] const VolumeGrid& grid() const { return grid_; }
  /// The size of the files written so far, in bytes.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  /// The size of the planes that are kept until their chunks are complete, in bytes.
  [[nodiscard]] std::uint64_t slab_bytes() const { return chunk_[2] * plane_bytes(); }

  /// Writes one step, plane by plane in ascending order. Several steps may be written at the same time.
  class Step {
   public:
    /// `step` counts from 0; it is 0 for a volume. The array must outlive this object.
    Step(ZarrArray& array, std::uint64_t step) : array_(array), step_(step) {}
    /// Writes the next plane. Throws Error if a chunk cannot be written.
    void write_plane(std::span<const std::byte> samples);

   private:
    ZarrArray& array_;
    std::uint64_t step_;
    std::uint64_t planes_ = 0;     ///< number of planes taken
    std::vector<std::byte> slab_;  ///< planes whose chunks are not written yet
  };

 private:
  [[nodiscard]] std::uint64_t plane_bytes() const { return grid_.plane_samples() * stored_bytes(type_); }
  void write_header() const;
  /// Writes the chunks of some planes, the first of which begins a chunk.
  void write_slab(std::uint64_t step, std::uint64_t first, std::span<const std::byte> planes);
  [[nodiscard]] std::vector<std::byte> chunk(std::uint64_t x, std::uint64_t y,
                                             std::span<const std::byte> planes) const;

  std::filesystem::path folder_;
  VolumeGrid grid_;
  StoredType type_;
  std::optional<std::uint64_t> steps_;
  std::array<std::uint64_t, 3> chunk_{};  ///< number of samples along x, y and z
  std::uint64_t bytes_ = 0;
};

}  // namespace adamas::io
