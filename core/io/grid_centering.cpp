#include "core/io/grid_centering.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/error.h"

namespace adamas::io {

namespace {

const char* name_of(Centering centering) { return centering == Centering::kCells ? "cells" : "points"; }

void set_arrays(Centering centering, GridFile& file) {
  for (GridArray& array : file.arrays) array.centering = centering;
}

/// Faces halfway between nodes, and the ends: the first and the last node, or as far beyond them as the
/// nearest face lies within.
std::vector<double> faces_between(const std::vector<double>& nodes, bool beyond) {
  std::vector<double> faces;
  for (std::size_t i = 1; i < nodes.size(); ++i) faces.push_back(0.5 * (nodes[i - 1] + nodes[i]));
  const double first = nodes.front(), last = nodes.back();
  faces.insert(faces.begin(), beyond ? 2 * first - faces.front() : first);
  faces.push_back(beyond ? 2 * last - faces.back() : last);
  return faces;
}

/// Arrays that VTK has elsewhere go where they are wanted.
void move_arrays(const std::string& name, Centering wanted, GridFile& file) {
  const auto is_elsewhere = [wanted](const GridArray& array) { return array.centering != wanted; };
  const auto count = std::count_if(file.arrays.begin(), file.arrays.end(), is_elsewhere);
  if (count == 0) return;
  if (count != std::ssize(file.arrays)) {
    fail("{}: expected all arrays on {}, as is asked for, or all on {}, found both", name, name_of(wanted),
         wanted == Centering::kCells ? "points" : "cells");
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto& nodes = file.nodes[axis];
    if (nodes.size() < 2) {
      fail("{}: expected two points or more along {} where they are to be cells, found {}", name, "xyz"[axis],
           nodes.size());
    }
    if (wanted == Centering::kCells) {
      nodes = faces_between(nodes, true);
      continue;
    }
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) nodes[i] = 0.5 * (nodes[i] + nodes[i + 1]);
    nodes.pop_back();
  }
  set_arrays(wanted, file);
}

/// Whether the samples of a file are nodes along each axis. The file states the centering of at least one
/// axis.
std::array<bool, 3> node_axes(const GridFile& file, Centering otherwise) {
  const auto& stated = file.stated;
  const auto says = [&stated](Centering c) {
    return std::find(stated.begin(), stated.end(), c) != stated.end();
  };
  const bool both = says(Centering::kCells) && says(Centering::kPoints);
  // An axis for which the file says nothing is treated like the others.
  if (!both) otherwise = says(Centering::kCells) ? Centering::kCells : Centering::kPoints;
  std::array<bool, 3> nodes{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    nodes[axis] = stated[axis].value_or(otherwise) == Centering::kPoints;
  return nodes;
}

void take_for_cells(const std::array<bool, 3>& nodes, GridFile& file) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool halves = nodes[axis] && file.nodes[axis].size() > 1;
    file.nodes[axis] = halves ? faces_between(file.nodes[axis], false) : file.faces[axis];
  }
  set_arrays(Centering::kCells, file);
}

}  // namespace

GridCentering choose_centering(const std::string& name, std::optional<Centering> wanted, Centering otherwise,
                               GridFile& file) {
  GridCentering result;
  if (!file.has_samples()) {
    if (wanted) move_arrays(name, *wanted, file);
    return result;
  }
  std::array<bool, 3> nodes{};
  nodes.fill(wanted.value_or(otherwise) == Centering::kPoints);
  const bool stated =
      std::any_of(file.stated.begin(), file.stated.end(), [](const auto& s) { return s.has_value(); });
  if (!wanted && stated) nodes = node_axes(file, otherwise);
  result.assumed = !wanted && !stated;
  const auto points = std::count(nodes.begin(), nodes.end(), true);
  result.mixed = points != 0 && points != 3;
  if (points != 3) take_for_cells(nodes, file);
  for (auto& faces : file.faces) faces.clear();
  return result;
}

template <class T>
std::vector<T> average_to(Centering to, const RectilinearGrid& from, std::size_t components,
                          const std::vector<T>& values) {
  if (to == from.centering) return values;
  RectilinearGrid target{from.nodes, to};
  // Along an axis, site i of the target touches the sites i + first .. i + first + 1 of the source that
  // exist.
  const std::ptrdiff_t first = to == Centering::kCells ? 0 : -1;
  std::vector<T> result(target.site_count() * components);
  std::array<std::size_t, 3> index{}, begin{}, end{};
  for (std::size_t site = 0; site < target.site_count(); ++site) {
    index = {site % target.sites(0), site / target.sites(0) % target.sites(1),
             site / (target.sites(0) * target.sites(1))};
    std::size_t count = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::ptrdiff_t low = static_cast<std::ptrdiff_t>(index[axis]) + first;
      const auto limit = static_cast<std::ptrdiff_t>(from.sites(static_cast<int>(axis)));
      begin[axis] = static_cast<std::size_t>(std::max<std::ptrdiff_t>(low, 0));
      end[axis] = static_cast<std::size_t>(std::min(low + 2, limit));
      count *= end[axis] - begin[axis];
    }
    for (std::size_t c = 0; c < components; ++c) {
      double sum = 0;
      for (std::size_t k = begin[2]; k < end[2]; ++k) {
        for (std::size_t j = begin[1]; j < end[1]; ++j) {
          for (std::size_t i = begin[0]; i < end[0]; ++i) {
            sum += static_cast<double>(values[from.site_index(i, j, k) * components + c]);
          }
        }
      }
      result[site * components + c] = static_cast<T>(sum / static_cast<double>(count));
    }
  }
  return result;
}

template std::vector<float> average_to(Centering, const RectilinearGrid&, std::size_t,
                                       const std::vector<float>&);
template std::vector<double> average_to(Centering, const RectilinearGrid&, std::size_t,
                                        const std::vector<double>&);

}  // namespace adamas::io
