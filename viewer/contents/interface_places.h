#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/probe/cell_locator.h"
#include "viewer/contents/pair_surfaces.h"

namespace adamas::viewer {

/// The cells in which the fields on both sides of an interface are known at one of its vertices.
struct InterfacePlace {
  struct Side {
    BodyId body;
    /// The cell that has the vertex and a part of the body; kNoCell if there is none.
    std::uint32_t cell;
  };
  static constexpr std::uint32_t kNoCell = 0xffffffffu;
  std::array<Side, 2> sides;  ///< the front side and the back side
};

/// The places of all vertices, by surface and vertex. The surfaces are those of the interfaces, which were
/// extracted from the mesh.
std::vector<std::vector<InterfacePlace>> interface_places(const interfaces::ResampledMesh& mesh,
                                                          const interfaces::CellLocator& locator,
                                                          const interfaces::ExtractedInterfaces& interfaces,
                                                          std::span<const PairSurface> surfaces);

}  // namespace adamas::viewer
