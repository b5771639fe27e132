#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "adamas/comparison.h"
#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// Draws tetrahedra and seconds against the measured two-sided distance, both logarithmic, side by side:
/// .png, .svg or .pdf. Throws Error where the file cannot be written.
void write_comparison_picture(const std::filesystem::path& path, const std::vector<ComparisonRow>& rows,
                              const std::string& title);

}  // namespace adamas
