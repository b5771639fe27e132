#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/data/stored_type.h"
#include "core/io/grid_file.h"

namespace adamas::io {

/// An identifier of HDF5, whose headers stay in sources.
using Hdf5Id = std::int64_t;

/// The name that HDF5 has for a numeric type in memory.
Hdf5Id hdf5_memory_type(StoredType type);

/// Throws Error, which begins with `name`, if the samples of a data set lie in other files.
void check_hdf5_samples(const std::string& name, Hdf5Id set);

/// Returns the number of numbers in a data set on a grid of these sizes. Throws Error, which begins with
/// `name`, where there are none or too many, or where the file cannot hold them.
std::uint64_t count_hdf5_numbers(const std::string& name, Hdf5Id set, StoredType stored,
                                 const std::array<std::uint64_t, 3>& sizes, std::uint64_t components);

/// Reads so many numbers of a data set into the values of an array. Throws Error as above where they are
/// damaged.
void read_hdf5_numbers(const std::string& name, Hdf5Id set, StoredType stored, std::uint64_t count,
                       GridArray& array);

}  // namespace adamas::io
