#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "adamas/error_target.h"
#include "adamas/geometry.h"

namespace adamas::cli {

// The functions below parse values of options. Each throws Error (kUsage) that names the option, what was
// expected and what was found.

/// Returns the parts of "a,b" before, between and behind commas.
std::vector<std::string> split_at_commas(const std::string& text);
/// Returns a finite number above 0.
double parse_positive(const std::string& option, const std::string& text);
/// Returns a number from 0 to `greatest`.
double parse_up_to(const std::string& option, const std::string& text, double greatest);
/// Returns a part of a whole, as "0.02" or "2%": from 0 to `greatest`.
double parse_part(const std::string& option, const std::string& text, double greatest = 1);
/// Returns 0.01 for "1%": a part of a whole, above 0% and below 100%.
double parse_percentage(const std::string& option, const std::string& text);
/// Both return a whole number: from 1 on, or from 0 on.
std::size_t parse_count(const std::string& option, const std::string& text);
std::size_t parse_count_from_0(const std::string& option, const std::string& text);
/// Returns the bytes of a size like "256M", in units of 1024 with K, M, G or T; at least 1.
std::size_t parse_size(const std::string& option, const std::string& text);
/// Returns the `count` finite numbers of a text like "1,2.5,-3".
std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count);
double parse_number(const std::string& option, const std::string& text);
std::array<double, 2> parse_two_numbers(const std::string& option, const std::string& text);
Vec3 parse_vector(const std::string& option, const std::string& text);
/// Returns the plane of "x=0.5", at right angles to an axis.
Plane parse_plane_option(const std::string& option, const std::string& text);
/// Return the box "x0,x1,y0,y1,z0,z1", with x0 < x1 and so on.
std::array<double, 6> parse_bounds(const std::string& option, const std::string& text);
Box3 parse_box(const std::string& option, const std::string& text);
/// Returns the error of a text like "0.15", "1%" or "0.5voxels".
ErrorTarget parse_distance(const std::string& option, const std::string& text);
/// Returns the counts of "X,Y,Z", or one count for all three.
std::array<std::size_t, 3> parse_dimensions(const std::string& option, const std::string& text);
/// Returns the two sides of "NAME=VALUE", split at its first '=', or its last.
std::pair<std::string, std::string> parse_assignment(const std::string& option, const std::string& text,
                                                     bool at_last = false);

}  // namespace adamas::cli
