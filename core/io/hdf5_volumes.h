#pragma once

#define H5_USE_110_API
#include <hdf5.h>

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/vec3.h"
#include "core/io/stored_type.h"

namespace adamas::io {

/// The type that numbers of a type of HDF5 are handed over as; nothing where these are no numbers.
std::optional<StoredType> hdf5_stored_type(hid_t type);
/// HDF5's name for it in memory.
hid_t hdf5_memory_type(StoredType type);

/// Along how many axes a data set has numbers; 0 where there is none, or not of numbers.
int hdf5_axes(hid_t place, const char* name);

/// The data set that `wanted` names; where that is empty the only one along three axes or, where there is
/// none, along four. Throws Error, which begins with `name`, where there is none or more than one.
std::string choose_hdf5_set(const std::string& name, hid_t file, const std::string& wanted);

/// Data sets of numbers along so many axes: their names, at most kMostHdf5Listed.
inline constexpr std::size_t kMostHdf5Listed = 8;
std::vector<std::string> find_hdf5_sets(hid_t file, int axes, std::size_t most = kMostHdf5Listed);

/// Throws Error, which begins with `name`, where the samples of a data set lie in other files.
void check_hdf5_samples(const std::string& name, hid_t set);

/// Spacing along x, y and z by the attribute "element_size_um"; 1 where there is none.
Vec3 hdf5_spacing(hid_t set);

/// The attribute `time` of a data set as numbers: empty where it has none, or one of something else.
std::vector<double> hdf5_times(hid_t set);

}  // namespace adamas::io
