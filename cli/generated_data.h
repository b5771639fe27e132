#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "adamas/progress.h"
#include "cli/usage.h"
#include "core/data/multi_material_data.h"

namespace adamas::cli {

/// Data that a command makes for itself: a scene, or the impact at its end.
struct GeneratedData {
  std::string name;
  std::array<std::size_t, 3> cells{};
  std::uint64_t seed = 0;
};

/// What can be made: the impact and all scenes.
std::vector<std::string> generated_names();

/// From the values of --generate, --dimensions and --seed; throws Error (kUsage).
GeneratedData parse_generated_data(const std::string& name, const std::string& dimensions,
                                   const std::string& seed);

MultiMaterialData generate_data(const GeneratedData& what, Progress& progress);

}  // namespace adamas::cli
