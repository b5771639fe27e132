#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "interfaces/probe/probe.h"

namespace adamas::cli {

/// Reads points from lines "x,y,z", with semicolons, or commas, or blanks between them; more columns are left
/// out, as are empty lines, those that begin with '#' and one of names at the beginning. Throws Error with
/// the line, also where semicolons and commas are mixed: these would be decimal commas.
std::vector<Vec3> read_points(const std::filesystem::path& path);

/// Samples at points, as a table.
struct PointTable {
  IdVector<MaterialId, std::string> materials;
  std::vector<interfaces::FieldInfo> fields;
  std::vector<interfaces::ProbeSample> samples;

  /// x, y, z, material, interface distance, fields; with a line of names; cells without a value are empty.
  [[nodiscard]] std::string csv() const;
};

}  // namespace adamas::cli
