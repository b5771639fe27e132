#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "adamas/volume.h"
#include "datasets/sample_scale.h"
#include "datasets/scene.h"

namespace adamas::datasets {

/// A scene as a volume: samples of how far a point is inside the bodies, that is, the greatest value of all
/// materials minus that of the first, on a grid that spans the box. If a scene consists of spheres and planes
/// with slope 1 outside of which the first material has value 0, as `sphere` and `moving`, it is the signed
/// distance to the nearest surface, positive inside (of several bodies that overlap, the greatest).
class SceneVolume {
 public:
  /// For types of whole numbers, values from -1/4 to 1/4 of the box's shortest side fill the range. Throws
  /// Error if an axis has fewer than two samples. The scene must outlive this object.
  SceneVolume(const Scene& scene, const std::array<std::size_t, 3>& samples, SampleType type);

  [[nodiscard]] const VolumeGrid& grid() const { return grid_; }
  [[nodiscard]] const SampleScale& scale() const { return scale_; }
  [[nodiscard]] double value(const Vec3& p) const;
  /// Computes the samples of plane k in parallel; they are the same on any number of threads.
  void plane(std::uint64_t k, std::span<std::byte> samples) const;

 private:
  const Scene& scene_;
  VolumeGrid grid_;
  SampleScale scale_;
};

}  // namespace adamas::datasets
