#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "adamas/volume.h"
#include "tests/benchmarks/peers/flying_edges.h"

namespace adamas::bench {

// The functions return VTK's surfaces of a volume in memory, made on one thread, in units of the samples'
// spacing along i.

/// Runs vtkFlyingEdges3D on every `stride`-th sample along each axis.
PeerSurface flying_edges_of(const VolumeGrid& grid, std::span<const std::byte> samples, double isovalue,
                            int stride);

/// Runs vtkQuadricDecimation to about this number of triangles.
PeerSurface quadric_decimation(const PeerSurface& surface, std::size_t triangles);
/// Runs vtkDecimatePro to about this number of triangles, which may change the surface's topology.
PeerSurface decimate_pro(const PeerSurface& surface, std::size_t triangles);

}  // namespace adamas::bench
