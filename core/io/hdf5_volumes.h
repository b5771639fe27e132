#pragma once

#define H5_USE_110_API
#include <hdf5.h>

#include <optional>
#include <string>
#include <vector>

#include "core/io/stored_type.h"

namespace adamas {

/// The type that numbers of a type of HDF5 are handed over as; nothing where these are no numbers.
std::optional<StoredType> hdf5_stored_type(hid_t type);
/// HDF5's name for it in memory.
hid_t hdf5_memory_type(StoredType type);

/// Along how many axes a data set has numbers; 0 where there is none, or not of numbers.
int hdf5_axes(hid_t place, const char* name);

/// The data set that `wanted` names; where that is empty the only one along three axes or, where there is
/// none, along four. Throws Error, which begins with `name`, where there is none or more than one.
std::string choose_hdf5_set(const std::string& name, hid_t file, const std::string& wanted);

/// The attribute `time` of a data set as numbers: empty where it has none, or one of something else.
std::vector<double> hdf5_times(hid_t set);

}  // namespace adamas
