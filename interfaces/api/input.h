#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adamas/fractions.h"
#include "adamas/input.h"
#include "core/data/interface_mesh.h"
#include "core/data/mesh_data.h"
#include "core/data/multi_material_data.h"
#include "interfaces/api/error_targets.h"
#include "interfaces/input/resampling_source.h"
#include "interfaces/probe/material_integrals.h"
#include "interfaces/reconstruction/reconstruction.h"

namespace adamas {

/// The implementation of an Input.
struct Input::Contents {
  std::unique_ptr<MultiMaterialData> data;  ///< null if the input is only interfaces, or a mesh
  std::unique_ptr<MeshData> cells;          ///< null unless the input is data on a mesh
  /// The integrals over the materials of data whose fractions have been given up; else empty.
  IdVector<MaterialId, interfaces::MaterialIntegral> integrals;
  std::optional<InterfaceMesh> mesh;  ///< given interfaces before mending
  MendingOptions mending;             ///< for given interfaces
  interfaces::InputFacts facts;
  std::vector<std::string> materials;
  std::vector<FieldDescription> fields;

  /// Makes an input of data on a grid.
  explicit Contents(std::unique_ptr<MultiMaterialData> taken);
  /// Makes an input of data on a mesh.
  explicit Contents(std::unique_ptr<MeshData> taken);
  /// Makes an input of given interfaces in a domain, with or without data on a grid, which need no materials.
  /// Throws Error if no interface is in the domain.
  Contents(InterfaceMesh given, const Box3& domain, const MendingOptions& how,
           std::unique_ptr<MultiMaterialData> with = nullptr);

  /// Makes the source for resampling, which refers to `data`: interfaces are reconstructed, or mended and
  /// checked; what was mended is noted. Throws Error if the options do not suit the input or interfaces
  /// cannot be used.
  [[nodiscard]] interfaces::ResamplingSource source(const interfaces::ReconstructionOptions& options,
                                                    Progress& progress) const;
  /// Makes the source as source() does, and moves the given interfaces into it. Fractions without fields,
  /// which nobody needs once interfaces are made of them, are given up.
  [[nodiscard]] interfaces::ResamplingSource take_source(const interfaces::ReconstructionOptions& options,
                                                         Progress& progress);
};

namespace interfaces {

/// Returns the names, units and components of fields.
std::vector<FieldDescription> describe(const std::vector<FieldInfo>& fields);
/// Throws Error where the options are of labels or of volume fractions, and the data have none.
void check_reconstruction(const ReconstructionOptions& options, const MultiMaterialData& data);
void check_reconstruction(const ReconstructionOptions& options, const MeshData& data);
/// Throws Error if reconstruction options are set, since interfaces are given.
void refuse_reconstruction(const ReconstructionOptions& options);

}  // namespace interfaces

}  // namespace adamas
