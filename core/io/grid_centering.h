#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "core/io/grid_file.h"

namespace adamas::io {

/// How the values of a grid file were interpreted.
struct GridCentering {
  bool assumed = false;  ///< neither the file nor the caller said so
  bool mixed = false;    ///< the file states cells along some axes and nodes along others
};

/// Decides whether the arrays of a file are values of cells or at points: as `wanted`, else as the file says,
/// else as `otherwise`. Samples that are values of cells get one more node along each axis. If a file states
/// cells along some axes and nodes along others, its samples are values of cells: along the axes with nodes a
/// cell reaches halfway to the next samples, and ends with the last one. Arrays of VTK move only if they are
/// wanted elsewhere: points become cells that end halfway between them, and cells become points at their
/// centres. Throws Error with `name` if that is impossible: arrays on both are wanted on one, or a single
/// point gives its cell no size.
GridCentering choose_centering(const std::string& name, std::optional<Centering> wanted, Centering otherwise,
                               GridFile& file);

/// Moves values of one centering to the other: each cell gets the mean of its points, each point the mean of
/// the cells round it. The layout is `values[site * components + c]` on the sites of `from`; the result is on
/// the sites of the same nodes with centering `to`.
template <class T>
std::vector<T> average_to(Centering to, const RectilinearGrid& from, std::size_t components,
                          const std::vector<T>& values);

}  // namespace adamas::io
