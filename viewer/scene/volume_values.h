#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "adamas/volume.h"
#include "core/geometry/vec3.h"

namespace adamas::viewer {

/// The values of a store at places, linear along each axis between samples.
class VolumeValues {
 public:
  virtual ~VolumeValues() = default;

  /// NaN where a place lies outside of the samples, or a page cannot be had. `lod`: between which samples,
  /// one of 2^lod along each axis.
  [[nodiscard]] virtual double at(const Vec3& in_space, int lod) = 0;
  [[nodiscard]] double at(const Vec3& in_space) { return at(in_space, 0); }
  /// The coarsest LOD that tells more than one value.
  [[nodiscard]] virtual int coarsest() const = 0;
  [[nodiscard]] virtual const VolumeGrid& grid() const = 0;
  [[nodiscard]] virtual std::uint32_t steps() const = 0;
  /// Goes over to another step of a series; a store of one volume has that alone. Throws Error where tables
  /// of the step are damaged.
  virtual void set_step(std::uint32_t step) = 0;
  /// Of one sample of every cube of 2^N a side, N as small as there are a million at most: those that are
  /// finite.
  [[nodiscard]] virtual std::vector<double> some() = 0;
  /// Where the values of all steps of a series are, as the directory tells, rounded outwards: between these
  /// and the ends of a range that is given. That of a store of one step is left as it is.
  [[nodiscard]] virtual std::array<double, 2> extended_by_steps(std::array<double, 2> range) = 0;
  [[nodiscard]] virtual const std::string& name() const = 0;

  /// `memory`: bytes that decoded pages may take. `step`: of a series; a store of one volume has that alone.
  /// Throws Error where the file is no store or has no such step.
  static std::unique_ptr<VolumeValues> open(const std::string& path, std::size_t memory, std::uint32_t step);
};

}  // namespace adamas::viewer
