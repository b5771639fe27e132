#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/io/hdf5_layout.h"
#include "core/io/hdf5_meshes.h"
#include "core/io/mesh_file.h"

namespace adamas::io {

/// Reads the cells of a file of HDF5 as a layout says: a mesh, blocks, or a grid at several times. Arrays are
/// all data sets with values of cells or nodes, by their paths, in the group of a step from there on. Throws
/// Error, which begins with the file's name, where data sets are missing or do not fit each other; it lists
/// some of those that are there.
MeshFile read_laid_out_mesh(const Hdf5Meshes& source, const Hdf5Layout& layout,
                            std::optional<std::uint64_t> time);
/// The times of the file: those that groups state as their attribute `time`, or else their numbers.
std::vector<double> laid_out_times(const Hdf5Meshes& source, const Hdf5Layout& layout);

/// The numbers along the axes of a grid, x first.
std::array<std::vector<double>, 3> read_laid_out_axes(const Hdf5Meshes& source, const Hdf5Layout& layout);

}  // namespace adamas::io
