#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "adamas/files.h"  // MaterialDataOptions
#include "core/data/label_array.h"
#include "core/io/grid_file.h"

namespace adamas::io {

/// The name of the array of labels that write_multi_material_data writes.
inline constexpr const char* kWrittenLabels = "labels";

/// Labels as indices of names, in the order of the labels.
struct NamedLabels {
  LabelArray index;
  std::vector<std::string> names;
};

/// Lists names of labels by their values; a label without a name is called by its number, or "background" if
/// it is 0. Labels below 0 and above 65535 are left out.
std::vector<std::string> listed_names(const std::map<std::int64_t, std::string>& names);

/// The arrays of a file that are materials.
struct ChosenMaterials {
  std::vector<std::string> names;
  std::vector<GridArray> fractions;  ///< of each material, with one component; without that of the rest
  bool rest = false;                 ///< whether the last material has what the others leave
  std::optional<NamedLabels> labels;
  Centering centering = Centering::kCells;  ///< that of the first fractions, or of the labels
  double step = 0;                          ///< see FractionReport
};

/// Chooses, among the arrays of a file, those that are materials and those that are fields, as options and
/// names say (MaterialDataOptions). Errors begin with the source.
class MaterialArrays {
 public:
  /// Reads another file of one array that an option names.
  using OtherFile = std::function<GridArray(const std::string& option, const std::filesystem::path& file)>;

  MaterialArrays(const std::filesystem::path& path, const MaterialDataOptions& options,
                 std::vector<GridArray> arrays, std::vector<std::string> material_names,
                 OtherFile other_file);

  /// Whether options or names of arrays say what the materials are.
  [[nodiscard]] static bool name_materials(const MaterialDataOptions& options,
                                           const std::vector<GridArray>& arrays,
                                           const std::vector<std::string>& material_names);
  /// Takes the arrays of materials. Throws Error where there are none.
  ChosenMaterials take_materials();
  /// Takes the arrays of fields: those that options name, and all that are left.
  std::vector<GridArray> take_fields();

  /// What a volume fraction of 1 is stored as.
  [[nodiscard]] double fraction_scale() const { return options_.fraction_scale.value_or(1); }
  /// The fractions of an array, scaled.
  [[nodiscard]] std::vector<float> take_fractions(GridArray& array) const;
  /// What the fractions leave of 1.
  template <class Fractions>
  [[nodiscard]] static std::vector<float> rest_of(const Fractions& fractions, std::size_t sites);

 private:
  [[nodiscard]] bool names_fractions() const {
    return !options_.fractions.empty() || !options_.fraction_array.empty();
  }
  [[nodiscard]] GridArray take(std::size_t i);
  [[nodiscard]] GridArray resolve(const std::string& option, const std::string& value);
  [[noreturn]] void fail_used_twice(const std::string& option, const std::string& value) const;
  [[noreturn]] void fail_without_materials() const;
  void require_scalar(const GridArray& array, const char* hint = "") const;
  void add_material(const std::string& name);
  [[nodiscard]] double step_of(const GridArray& array) const;
  void add_fraction(const std::string& name, GridArray array, double step);
  void add_fractions(const std::string& name, GridArray array);
  [[nodiscard]] std::vector<std::string> component_materials(const std::string& name,
                                                             const GridArray& array) const;
  void set_labels(GridArray array);

  const std::filesystem::path& path_;
  std::string source_;
  const MaterialDataOptions& options_;
  std::vector<GridArray> arrays_;
  std::vector<std::string> material_names_;
  OtherFile other_file_;
  std::vector<std::string> taken_;  // arrays that are used
  std::optional<double> step_;
  ChosenMaterials chosen_;
};

template <class Fractions>
std::vector<float> MaterialArrays::rest_of(const Fractions& fractions, std::size_t sites) {
  std::vector<float> rest(sites);
  for (std::size_t site = 0; site < sites; ++site) {
    double left = 1;
    for (const auto& fraction : fractions) left -= static_cast<double>(fraction[site]);
    rest[site] = left < 0 ? 0.0f : static_cast<float>(left);
  }
  return rest;
}

}  // namespace adamas::io
