#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/plane.h"
#include "core/geometry/vec3.h"

namespace adamas {

// Values of options as text. Every function throws UsageError that names the option, what was expected and
// what was found.

/// A finite number above 0.
double parse_positive(const std::string& option, const std::string& text);
/// A whole number of at least that.
std::size_t parse_count(const std::string& option, const std::string& text, std::size_t least = 1);
/// "256M": bytes, in units of 1024 with K, M, G or T; at least 1.
std::size_t parse_size(const std::string& option, const std::string& text);
/// "1,2.5,-3": that many finite numbers.
std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count);
Vec3 parse_vector(const std::string& option, const std::string& text);
/// "x=0.5": a plane at right angles to an axis.
Plane parse_plane_option(const std::string& option, const std::string& text);
/// "x0,x1,y0,y1,z0,z1" with x0 < x1 and so on.
std::array<double, 6> parse_bounds(const std::string& option, const std::string& text);
Box3 to_box(const std::array<double, 6>& bounds);
/// "X,Y,Z": counts, or one for all three.
std::array<std::size_t, 3> parse_dimensions(const std::string& option, const std::string& text);
/// "NAME=VALUE" at its first '=', or its last.
std::pair<std::string, std::string> parse_assignment(const std::string& option, const std::string& text,
                                                     bool at_last = false);

/// An error wanted: absolute, or a part of something (0.01 for "1%").
struct ErrorTarget {
  double value = 0;
  bool relative = false;
  [[nodiscard]] double of(double whole) const { return relative ? value * whole : value; }
};
/// "0.15" or "1%"; positive and finite.
ErrorTarget parse_error_target(const std::string& option, const std::string& text);

}  // namespace adamas
