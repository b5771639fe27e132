#pragma once

#include <string>
#include <vector>

#include "adamas/grid_data.h"
#include "core/base/typed_id.h"
#include "core/data/mesh_data.h"
#include "core/data/multi_material_data.h"
#include "interfaces/fields/field_source.h"

namespace adamas::workflow {

/// The properties that all steps of a series must share with the first.
class SeriesForms {
 public:
  /// Throws Error, naming the step's file, where its grid, its materials or its fields are not those of the
  /// first step that was checked.
  void check(const std::string& file, const MultiMaterialData& data);
  /// Throws Error, as above, for data on a mesh of cells, which may differ between steps; their box may not.
  /// `fields`: those of its source.
  void check(const std::string& file, const MeshData& data, const std::vector<interfaces::FieldInfo>& fields);
  /// Throws Error, as above, but compares only the names of the materials and the box.
  void check(const std::string& file, const IdVector<MaterialId, std::string>& materials, const Box3& box);

 private:
  void check_fields(const std::string& file, const std::vector<interfaces::FieldInfo>& fields) const;

  std::string first_;  ///< the file of the first step
  RectilinearGrid grid_;
  Box3 box_;
  IdVector<MaterialId, std::string> materials_;
  std::vector<interfaces::FieldInfo> fields_;
};

}  // namespace adamas::workflow
