#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/progress.h"
#include "core/data/multi_material_data.h"

namespace adamas {

/// How to read a file as multi-material data. FILE-or-ARRAY names an array of the main file, or else a file
/// on the same grid that holds one array.
struct MaterialDataOptions {
  /// Materials and their volume fractions: NAME, FILE-or-ARRAY. Where empty, every array whose name contains
  /// "volume fraction" is a material.
  std::vector<std::pair<std::string, std::string>> fractions;
  double fraction_scale = 1;  ///< what a volume fraction of 1 is stored as (255, 100)
  std::string rest;           ///< one more material, of what the others leave of 1
  /// FILE-or-ARRAY of whole numbers that name the material of a site. Where neither it nor `fractions` is
  /// given and no array is a volume fraction, an array "labels" of a file with material names is taken.
  std::string labels;
  /// Further fields: NAME, FILE-or-ARRAY.
  std::vector<std::pair<std::string, std::string>> fields;
  /// Fields, by name, whose values are amounts per cell: they are divided by their material's volume there,
  /// and are zero where it has none.
  std::vector<std::string> extensive;
  /// x0, x1, y0, y1, z0, z1: only the sites in this box are kept.
  std::optional<std::array<double, 6>> region;
  /// What the values are on, whatever the files say.
  std::optional<Centering> centering;
  /// Where nothing is a material, all of the grid is one, kPlainMaterial, with all arrays as fields.
  bool plain = false;
  /// Told in a line what was assumed that the files do not say.
  std::function<void(const std::string&)> note;
};

/// The material of data that know none.
inline constexpr const char* kPlainMaterial = "volume";
/// Whether data know no materials.
bool is_plain(const MultiMaterialData& data);

/// Reads materials, fractions or labels, and fields from one file of those of read_grid_file, or several.
/// Remaining arrays are fields, per material where the name says so ("Mass for Steel", "density_Steel"); "X
/// Velocity", "Y Velocity" and "Z Velocity" are one vector field; units in brackets are kept; arrays on the
/// other centering are averaged. Samples of which nothing says whether they are of cells or points are taken
/// for values of cells (choose_centering), those of other files as they fit the main one. Materials of labels
/// are named by their value and sorted by it. Throws Error at unusable files and at data that
/// MultiMaterialData::normalise or check reject.
MultiMaterialData read_multi_material_data(const std::filesystem::path& path,
                                           const MaterialDataOptions& options = {},
                                           Progress& progress = SilentProgress::instance());

}  // namespace adamas
