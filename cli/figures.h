#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "adamas/geometry.h"
#include "adamas/report_text.h"
#include "adamas/text.h"

namespace adamas::cli {

/// The figures of a run that `--json` writes; keys keep the order in which they were added.
using Figures = nlohmann::ordered_json;

/// Writes indented JSON; numbers that are not finite become null.
void write_figures(const std::filesystem::path& path, const Figures& figures);

/// Returns [x0, x1, y0, y1, z0, z1].
Figures box_figures(const Box3& box);

/// Returns the greatest resident memory of this process so far.
std::size_t peak_memory_bytes();

}  // namespace adamas::cli
