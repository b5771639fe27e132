#include "core/io/grid_axes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/error.h"

namespace adamas::io {

namespace {

/// For each axis of space, the axis of the array that is parallel to it, and whether the array runs in the
/// opposite direction.
struct Layout {
  std::array<std::size_t, 3> source{};
  std::array<bool, 3> reversed{};
};

/// Finds for each axis of space the axis of the array that is parallel to it. If there is none, throws Error
/// if `name` is given.
std::optional<std::array<std::size_t, 3>> find_sources(const GridAxes& axes, const std::string* name) {
  std::array<std::size_t, 3> sources{};
  std::array<bool, 3> taken{};
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3& d = axes.directions[a];
    int along = 0;
    for (int s = 1; s < 3; ++s) {
      if (std::abs(d[s]) > std::abs(d[along])) along = s;
    }
    const double across = std::abs(d[(along + 1) % 3]) + std::abs(d[(along + 2) % 3]);
    const auto s = static_cast<std::size_t>(along);
    if (!(std::abs(d[along]) > 0) || !(across <= kParallelAxes * std::abs(d[along])) || taken[s]) {
      if (name == nullptr) return {};
      fail(
          "{}: expected axes parallel to x, y and z, one to each, found the {} axis along ({:.6g}, {:.6g}, "
          "{:.6g})",
          *name, std::array{"first", "second", "third"}[a], d.x, d.y, d.z);
    }
    taken[s] = true;
    sources[s] = a;
  }
  return sources;
}

/// Returns the values of an array of `sizes` sites per axis in the order of the axes of space.
template <class T>
std::vector<T> rearranged(const std::vector<T>& values, std::size_t components, const Layout& layout,
                          const std::array<std::size_t, 3>& sizes) {
  const std::array<std::size_t, 3> stride{1, sizes[0], sizes[0] * sizes[1]};
  std::array<std::size_t, 3> n{};
  for (std::size_t s = 0; s < 3; ++s) n[s] = sizes[layout.source[s]];
  const auto offset = [&](std::size_t s, std::size_t i) {
    return stride[layout.source[s]] * (layout.reversed[s] ? n[s] - 1 - i : i);
  };
  std::vector<T> result;
  result.reserve(values.size());
  for (std::size_t k = 0; k < n[2]; ++k) {
    for (std::size_t j = 0; j < n[1]; ++j) {
      for (std::size_t i = 0; i < n[0]; ++i) {
        const std::size_t site = offset(0, i) + offset(1, j) + offset(2, k);
        for (std::size_t c = 0; c < components; ++c) result.push_back(values[site * components + c]);
      }
    }
  }
  return result;
}

/// Returns labels of `sizes` sites per axis with some axes reversed.
LabelArray turned(const LabelArray& labels, const std::array<bool, 3>& reversed,
                  const std::array<std::size_t, 3>& sizes) {
  std::vector<std::size_t> rows;
  rows.reserve(sizes[1] * sizes[2]);
  for (std::size_t k = 0; k < sizes[2]; ++k) {
    for (std::size_t j = 0; j < sizes[1]; ++j)
      rows.push_back((reversed[1] ? sizes[1] - 1 - j : j) + sizes[1] * (reversed[2] ? sizes[2] - 1 - k : k));
  }
  return labels.part(sizes[0], 0, sizes[0], rows, reversed[0]);
}

void rearrange(GridArray& array, const Layout& layout, const GridFile& file) {
  std::array<std::size_t, 3> sizes{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t nodes = file.nodes[a].size();
    sizes[a] = array.centering == Centering::kPoints ? nodes : nodes - std::min<std::size_t>(nodes, 1);
  }
  const auto components = static_cast<std::size_t>(std::max(array.components, 0));
  // read_grid_file reports an array of another size as an error.
  if (array.size() != sizes[0] * sizes[1] * sizes[2] * components) return;
  if (array.runs && layout.source == std::array<std::size_t, 3>{0, 1, 2}) {
    array.runs->index = turned(array.runs->index, layout.reversed, sizes);
    return;
  }
  array.expand();
  std::visit([&](auto& values) { values = rearranged(values, components, layout, sizes); }, array.values);
}

}  // namespace

double even_step(const std::string& name, int axis, const std::vector<double>& nodes) {
  constexpr double kUneven = 1e-5;
  if (nodes.empty()) fail("{}: expected samples along three axes, found none", name);
  if (nodes.size() == 1) return 1;
  const double step = (nodes.back() - nodes.front()) / static_cast<double>(nodes.size() - 1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double even = nodes.front() + static_cast<double>(i) * step;
    if (!(std::abs(nodes[i] - even) <= kUneven * std::abs(step))) {
      fail("{}: expected even spacing along {}, found a sample at {} instead of {}", name, "xyz"[axis],
           nodes[i], even);
    }
  }
  return step;
}

void require_laid_out(const std::string& name, const GridFile& file) {
  if (file.aslant) find_sources(*file.aslant, &name);
}

bool are_parallel(const GridAxes& axes) { return find_sources(axes, nullptr).has_value(); }

void lay_out(const GridAxes& axes, GridFile& file) {
  const auto sources = find_sources(axes, nullptr);
  if (!sources) {
    file.aslant = axes;
    return;
  }
  Layout layout{*sources, {}};
  std::array<std::vector<double>, 3> nodes, faces;
  std::array<std::optional<Centering>, 3> stated;
  for (int axis = 0; axis < 3; ++axis) {
    const auto s = static_cast<std::size_t>(axis);
    const std::size_t from = layout.source[s];
    const double step = axes.directions[from][axis];
    for (const double t : file.nodes[from]) nodes[s].push_back(axes.origin[axis] + step * t);
    for (const double t : file.faces[from]) faces[s].push_back(axes.origin[axis] + step * t);
    stated[s] = file.stated[from];
    // A negative spacing in the file also reverses the axis.
    layout.reversed[s] = !nodes[s].empty() && nodes[s].front() > nodes[s].back();
    if (!layout.reversed[s] && nodes[s].size() == 1 && faces[s].size() == 2)
      layout.reversed[s] = faces[s].front() > faces[s].back();
    if (!layout.reversed[s]) continue;
    std::reverse(nodes[s].begin(), nodes[s].end());
    std::reverse(faces[s].begin(), faces[s].end());
  }
  const bool in_order =
      layout.source == std::array<std::size_t, 3>{0, 1, 2} &&
      std::none_of(layout.reversed.begin(), layout.reversed.end(), [](bool r) { return r; });
  for (GridArray& array : file.arrays) {
    if (!in_order) rearrange(array, layout, file);
  }
  file.nodes = std::move(nodes);
  file.faces = std::move(faces);
  file.stated = stated;
}

}  // namespace adamas::io
