#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/volume.h"

namespace adamas::bench {

/// All samples of a volume.
struct VolumeInMemory {
  std::string name;
  VolumeGrid grid;
  std::vector<std::byte> bytes;

  [[nodiscard]] std::vector<std::byte> ordered_words()
      const;  ///< unsigned words in the order of the samples' values
};

/// Loads the volume that `what` names: buckyball:SIDE[:TYPE]; turbulence:SIDE[:TYPE]; a raw file after its
/// description, raw:X,Y,Z,TYPE,HEADER_BYTES:FILE; a pattern of slices, stack:PATTERN; or a file that
/// open_volume reads.
VolumeInMemory load_volume(const std::string& what);

}  // namespace adamas::bench
