#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "adamas/fractions.h"
#include "adamas/grid_data.h"
#include "adamas/meshes.h"
#include "adamas/progress.h"

namespace adamas {

struct ReconstructOptions {
  /// Applies to labels: reconstruct interfaces without the staircase of voxels, within half a voxel of it
  /// along each axis.
  bool smooth_labels = false;
  FractionOptions fractions{};
  /// Fewer triangles, within this distance of the interfaces both ways, in units of length; 0: all of them.
  double simplify = 0;
};

/// The interface between two materials.
struct InterfaceArea {
  std::array<std::uint32_t, 2> materials{};  ///< their numbers, the lower one first
  std::size_t triangles = 0;
  double area = 0;  ///< in the square of the unit of length; of given interfaces that in the domain
};

/// The result of reconstruct().
struct ReconstructedInterfaces {
  InterfaceTriangles mesh;
  struct Material {
    std::string name;
    double volume_input = 0;          ///< as fractions or labels say, in the cube of the unit of length
    double volume_reconstructed = 0;  ///< as the interfaces enclose it, before they are simplified
  };
  std::vector<Material> materials;
  std::size_t bodies = 0;                     ///< connected parts of materials
  std::optional<FractionFindings> fractions;  ///< of volume fractions
};

/// Material interfaces from volume fractions or labels: each mixed cell holds what its fractions say, without
/// gaps or overlaps (docs/method.md, Interfaces from volume fractions; after Bonnell et al., Material
/// interface reconstruction, 2003). Throws Error at data that check() refuses and at fractions that are to be
/// smoothed as labels, and Cancelled where the progress says so.
ReconstructedInterfaces reconstruct(const GridData& data, const ReconstructOptions& options = {},
                                    Progress& progress = SilentProgress::instance());

}  // namespace adamas
