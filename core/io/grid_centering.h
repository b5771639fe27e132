#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "core/io/grid_file.h"

namespace adamas::io {

/// What the values of a grid file were taken for.
struct GridCentering {
  bool assumed = false;  ///< neither the file nor the caller said so
  bool mixed = false;    ///< the file states cells along some axes and nodes along others
};

/// Decides whether the arrays of a file are values of cells or at points: as `wanted`, else as the file says,
/// else as `otherwise`. Samples that are values of cells get one more node along each axis. Where a file
/// states cells along some axes and nodes along others, samples are of cells too: along the latter a cell
/// reaches halfway to the next samples, and ends with the last. Arrays of VTK move only where they are wanted
/// elsewhere: points become cells that end halfway between them, and cells the points in their middle. Throws
/// Error with `name` where that cannot be: arrays on both are wanted on one, or one point alone gives its
/// cell no size.
GridCentering choose_centering(const std::string& name, std::optional<Centering> wanted, Centering otherwise,
                               GridFile& file);

/// Values of one centering moved to the other: each cell gets the mean of its points, each point the mean of
/// the cells round it. `values[site * components + c]` on the sites of `from`; the result is on those of the
/// same nodes with the centering `to`.
template <class T>
std::vector<T> average_to(Centering to, const RectilinearGrid& from, std::size_t components,
                          const std::vector<T>& values);

}  // namespace adamas::io
