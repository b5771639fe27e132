#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "adamas/volume.h"
#include "core/base/unnamed_file.h"
#include "isosurface/gradients/gradient_pages.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// The samples of the steps of a block in a scratch file, for what looks at all of them side by side while
/// each step's own file is open but once.
class SampleSpool {
 public:
  /// Throws Error where `folder` cannot hold files.
  SampleSpool(const std::filesystem::path& folder, const VolumeGrid& grid) : grid_(grid), file_(folder) {}
  SampleSpool(const SampleSpool&) = delete;
  SampleSpool& operator=(const SampleSpool&) = delete;

  /// The planes of the next step, which are kept as they are read. Valid as long as this and `planes` are.
  PlaneSource add(const PlaneSource& planes);
  /// Those rows of each step all planes of which were read. Valid as long as this is.
  [[nodiscard]] std::vector<RowSource> rows() const;

 private:
  VolumeGrid grid_;
  ScratchFile file_;
  std::size_t steps_ = 0;
};

}  // namespace adamas::isosurface
