#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "interfaces/reference/comparison.h"

namespace adamas {

/// Tetrahedra and seconds against the measured two-sided distance, both logarithmic, side by side.
void write_comparison_picture(const std::filesystem::path& path, const std::vector<ComparedMesh>& rows,
                              const std::string& title);

}  // namespace adamas
