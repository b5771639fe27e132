#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/volume.h"

namespace adamas::bench {

/// Triangles with shared points.
struct PeerSurface {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Runs vtkFlyingEdges3D on one thread, on a file of samples alone, which is read as a whole.
struct FlyingEdges {
  std::filesystem::path raw;
  std::array<std::uint64_t, 3> dimensions{};
  SampleType type = SampleType::kUint8;
  double isovalue = 0;
  bool normals = false;
  int stride = 1;  ///< only every `stride`-th sample along each axis is contoured

  /// Returns the number of triangles; the surface itself is discarded.
  [[nodiscard]] std::uint64_t count() const;
  /// Returns the surface with the first sample at the origin and a spacing of 1 between those of the file.
  [[nodiscard]] PeerSurface surface() const;
};

}  // namespace adamas::bench
