#pragma once

#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/input_options.h"
#include "core/io/series_file.h"

namespace adamas::cli {

/// The steps that a command's inputs stand for (find_series); none for one file alone. Throws Error, also for
/// the first step whose file is not there.
std::vector<io::SeriesEntry> series_steps(const std::vector<std::string>& inputs);

/// What all steps of a series have in common: that of the first.
class SeriesForms {
 public:
  /// Throws Error, naming the step's file, where its grid, its materials or its fields are not those of the
  /// first step that was checked.
  void check(const std::string& file, const MultiMaterialData& data);
  /// The same of the names of the materials and the box alone.
  void check(const std::string& file, const IdVector<MaterialId, std::string>& materials, const Box3& box);

 private:
  std::string first_;  ///< file
  RectilinearGrid grid_;
  Box3 box_;
  IdVector<MaterialId, std::string> materials_;
  std::vector<interfaces::FieldInfo> fields_;
};

}  // namespace adamas::cli
