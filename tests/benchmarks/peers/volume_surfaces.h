#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "adamas/volume.h"
#include "tests/benchmarks/peers/flying_edges.h"

namespace adamas::bench {

// VTK's surfaces of a volume in memory, on one thread; in units of its samples' spacing along i.

/// vtkFlyingEdges3D of every `stride`-th sample along each axis.
PeerSurface flying_edges_of(const VolumeGrid& grid, std::span<const std::byte> samples, double isovalue,
                            int stride);

/// vtkQuadricDecimation to about so many triangles.
PeerSurface quadric_decimation(const PeerSurface& surface, std::size_t triangles);
/// vtkDecimatePro to about so many, which may change the surface's topology.
PeerSurface decimate_pro(const PeerSurface& surface, std::size_t triangles);

}  // namespace adamas::bench
