#include "core/io/nrrd_places.h"

#include <cmath>

#include "core/base/error.h"

namespace adamas::io {

namespace {

/// A number of a list with an entry per axis; nothing where it is left out or "nan".
std::optional<double> entry(const NrrdPlaces::Words& words, std::size_t at) {
  if (at >= words.size()) return {};
  const auto value = nrrd_number<double>(words[at]);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<Centering> center(const NrrdPlaces::Words& words, std::size_t at) {
  if (at < words.size() && words[at] == "cell") return Centering::kCells;
  if (at < words.size() && words[at] == "node") return Centering::kPoints;
  return {};
}

bool is_step(double step) { return step != 0 && std::isfinite(step); }

}  // namespace

bool NrrdPlaces::is_other(std::size_t at) const {
  const bool other_kind =
      at < kinds.size() && kinds[at] != "domain" && kinds[at] != "space" && kinds[at] != "???";
  return other_kind || (at < directions.size() && directions[at].size() < 2);
}

NrrdPlaces::Other NrrdPlaces::other_axis(const std::string& name) const {
  if (dimension != 0 && sizes.size() != dimension)
    fail("{}: expected {} sizes, found {}", name, dimension, sizes.size());
  if (sizes.size() < 2 || sizes.size() > 4)
    fail("{}: expected two to four sizes, found {}", name, sizes.size());
  constexpr std::size_t kMostUnsaid = 9;
  const std::size_t last = sizes.size() - 1;
  const bool four = sizes.size() == 4;
  Other other = is_other(0) ? Other::kFirst : four && is_other(last) ? Other::kLast : Other::kNone;
  if (other == Other::kNone && four) {
    other = sizes[0] <= kMostUnsaid ? Other::kFirst : Other::kLast;
    if (sizes[0] > kMostUnsaid && sizes[last] > kMostUnsaid)
      fail("{}: expected three axes of space, or kinds that say which of four is none, found four", name);
  }
  if (other != Other::kNone && last < 2) fail("{}: expected two or three axes of space, found one", name);
  return other;
}

/// Without directions: a step along the axis of its place, and what lies at the least and the greatest
/// coordinate, the first and the last sample or, where they are of cells, the outer faces of their cells.
void NrrdPlaces::set_axis(std::size_t axis, std::size_t at, NrrdHeader& header) const {
  const int a = static_cast<int>(axis);
  SampleCentering& of = header.centers[axis];
  const auto min = entry(mins, at), max = entry(maxs, at);
  const bool cells = of.stated == Centering::kCells;
  double step = entry(spacings, at).value_or(0);
  if (!is_step(step) && min && max) {
    const auto n = static_cast<double>(header.sizes[axis]);
    const double cell = (*max - *min) / n;
    step = cells || n == 1 ? cell : (*max - *min) / (n - 1);
    if (is_step(step)) of.cell = cell / step;
  }
  if (!is_step(step)) step = 1;
  header.axes.directions[axis] = {};
  header.axes.directions[axis][a] = step;
  header.axes.origin[a] = min.value_or(0);
  if (!min) return;
  if (cells) {
    header.axes.origin[a] += 0.5 * step;
  } else {
    of.first_face = 0;
  }
}

Vec3 NrrdPlaces::direction(const std::string& name, std::size_t at) const {
  if (at >= directions.size() || directions[at].size() < 2 || directions[at].size() > 3) {
    fail("{}: expected a space direction of two or three numbers for axis {}, found none", name, at);
  }
  Vec3 result;
  for (int i = 0; i < 3; ++i) {
    result[i] = entry(directions[at], static_cast<std::size_t>(i)).value_or(0);
  }
  return result;
}

void NrrdPlaces::apply(const std::string& name, NrrdHeader& header) const {
  const Other other = other_axis(name);
  header.planar = other == Other::kLast;
  const std::size_t before = other == Other::kFirst ? 1 : 0;
  const std::size_t count = sizes.size() - (other == Other::kNone ? 0 : 1);
  if (other != Other::kNone) header.components = header.planar ? sizes.back() : sizes[0];
  for (std::size_t axis = 0; axis < count; ++axis) {
    header.sizes[axis] = sizes[axis + before];
    header.centers[axis].stated = center(centers, axis + before);
  }
  if (directions.empty()) {
    // Of entries of an axis of components behind them nothing is one of space.
    for (std::size_t axis = 0; axis < 3; ++axis)
      set_axis(axis, axis < count ? axis + before : sizes.size(), header);
    return;
  }
  auto& steps = header.axes.directions;
  for (std::size_t axis = 0; axis < count; ++axis) steps[axis] = direction(name, axis + before);
  // The third axis of a plane image is across its two.
  if (count == 2) steps[2] = normalized(cross(steps[0], steps[1]));
  for (int axis = 0; axis < 3; ++axis) {
    header.axes.origin[axis] = entry(origin, static_cast<std::size_t>(axis)).value_or(0);
  }
}

}  // namespace adamas::io
