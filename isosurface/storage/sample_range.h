#pragma once

#include <array>
#include <optional>

#include "isosurface/storage/stored_pages.h"
#include "isosurface/volume/samples.h"

namespace adamas {

/// The least and the greatest finite sample of a store, the first greater where there is none; nothing where
/// the part of the file that tells of them is damaged.
template <class Sample>
std::optional<std::array<double, 2>> sample_range(StoredPages<OrderedWord<Sample>>& pages);

}  // namespace adamas
