#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "adamas/certified_distance.h"
#include "adamas/resample.h"
#include "core/data/interface_mesh.h"
#include "core/data/unstructured_mesh.h"
#include "interfaces/api/input.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/resampler.h"

namespace adamas {

/// What stands behind an AdaptiveMesh.
struct AdaptiveMesh::Contents {
  /// What resampling needs beside its result; destroyed in the reverse order.
  struct Run {
    std::shared_ptr<Input::Contents> input;
    interfaces::ResamplingSource source;  ///< refers to the input's data
    std::optional<interfaces::Resampler> resampler;
  };

  std::unique_ptr<Run> run;  ///< null where the input is not kept
  ResampleReport report;
  std::vector<std::string> materials;
  std::vector<FieldDescription> fields;
  Box3 domain;
  IdVector<MaterialId, double> input_volumes;  ///< where no input is kept; empty where they are not known

  /// A mesh that was refined.
  explicit Contents(std::unique_ptr<Run> its_run);
  /// A mesh without input; of its report the numbers that it says itself are set.
  explicit Contents(interfaces::ResampledMesh its_mesh);

  /// The mesh on its own, made at the first call.
  [[nodiscard]] const interfaces::ResampledMesh& mesh() const;
  /// Its tetrahedra alone, and all arrays, made at the first call.
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 4>>& tetrahedra() const;
  [[nodiscard]] const TetrahedraView& view() const;
  /// What refining needs. Throws Error where it is not kept; `wanted` says what cannot be had without.
  [[nodiscard]] Run& kept_run(const char* wanted) const;

 private:
  mutable std::once_flag once_mesh_, once_tetrahedra_, once_view_;
  mutable interfaces::ResampledMesh mesh_;
  mutable std::vector<std::array<std::uint32_t, 4>> tetrahedra_;
  mutable UnstructuredMesh arrays_;
  mutable TetrahedraView view_;
};

namespace interfaces {

/// The measured distances as the library returns them.
InterfaceDistances to_distances(const InterfaceCertificate& certificate);

}  // namespace interfaces

}  // namespace adamas
