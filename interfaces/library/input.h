#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adamas/fractions.h"
#include "adamas/input.h"
#include "core/data/interface_mesh.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "interfaces/source/error_targets.h"
#include "interfaces/source/resampling_source.h"

namespace adamas {

/// What stands behind an Input.
struct Input::Contents {
  std::unique_ptr<MultiMaterialData> data;  ///< null for interfaces alone
  std::optional<InterfaceMesh> mesh;        ///< given interfaces, as they were given
  MendingOptions mending;                   ///< of given interfaces
  interfaces::InputFacts facts;
  std::vector<std::string> materials;
  std::vector<FieldDescription> fields;

  /// Data on a grid.
  explicit Contents(std::unique_ptr<MultiMaterialData> taken);
  /// Given interfaces in a domain, with or without data on a grid, which may have no materials of their own.
  /// Throws Error where no interface is in the domain.
  Contents(InterfaceMesh given, const Box3& domain, const MendingOptions& how,
           std::unique_ptr<MultiMaterialData> with = nullptr);

  /// What is resampled, made anew at each call: interfaces are reconstructed, or mended and checked. Notes
  /// what was mended. Throws Error where the options do not suit the input, and at interfaces that cannot be
  /// used. Refers to `data`.
  [[nodiscard]] interfaces::ResamplingSource source(const interfaces::ReconstructionOptions& options,
                                                    Progress& progress) const;
  /// As source(), and uses the given interfaces up.
  [[nodiscard]] interfaces::ResamplingSource take_source(const interfaces::ReconstructionOptions& options,
                                                         Progress& progress);
};

namespace interfaces {

/// Names, units and components of fields.
std::vector<FieldDescription> describe(const std::vector<FieldInfo>& fields);
/// Throws Error where the options are of labels or of volume fractions, and the data have none.
void check_reconstruction(const ReconstructionOptions& options, const MultiMaterialData& data);
/// Throws Error where such options are given for interfaces that are given.
void refuse_reconstruction(const ReconstructionOptions& options);

}  // namespace interfaces

}  // namespace adamas
