#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>

namespace adamas::io {

/// Colours of materials by their names: red, green and blue from 0 to 1.
using NamedColours = std::map<std::string, std::array<double, 3>>;

/// Finds the colours that a table of regions (none if its path is empty) and the header of a file (the same)
/// have for labels, under the names that these get; those of the table come first. Throws Error at a damaged
/// table or header.
NamedColours find_named_colours(const std::filesystem::path& file, const std::filesystem::path& region_names);

}  // namespace adamas::io
