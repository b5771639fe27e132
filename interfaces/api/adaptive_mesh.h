#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "adamas/certified_distance.h"
#include "adamas/resample.h"
#include "core/data/unstructured_mesh.h"
#include "interfaces/api/input.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/resampler.h"

namespace adamas {

/// The implementation of an AdaptiveMesh.
struct AdaptiveMesh::Contents {
  /// The data that resampling needs beside its result; they are destroyed in reverse order.
  struct Run {
    std::shared_ptr<Input::Contents> input;
    interfaces::ResamplingSource source;  ///< this refers to the input's data
    std::optional<interfaces::Resampler> resampler;
  };

  std::unique_ptr<Run> run;  ///< null if the input is not kept
  ResampleReport report;
  std::vector<std::string> materials;
  std::vector<FieldDescription> fields;
  Box3 domain;
  IdVector<MaterialId, double> input_volumes;  ///< used if no input is kept; empty if they are not known

  /// Makes a mesh that has been refined.
  explicit Contents(std::unique_ptr<Run> its_run);
  /// Makes a mesh without input; its report has the figures that the mesh itself determines.
  explicit Contents(interfaces::ResampledMesh its_mesh);

  /// Returns the mesh that stands alone, which is made at the first call.
  [[nodiscard]] const interfaces::ResampledMesh& mesh() const;
  /// Return its tetrahedra and all of its arrays, which are made at the first call.
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 4>>& tetrahedra() const;
  [[nodiscard]] const TetrahedraView& view() const;
  /// Returns the data for refining. Throws Error if they are not kept; `wanted` names what needs them.
  [[nodiscard]] Run& kept_run(const char* wanted) const;

 private:
  mutable std::once_flag once_mesh_, once_tetrahedra_, once_view_;
  mutable interfaces::ResampledMesh mesh_;
  mutable std::vector<std::array<std::uint32_t, 4>> tetrahedra_;
  mutable UnstructuredMesh arrays_;
  mutable TetrahedraView view_;
};

namespace interfaces {

/// Converts measured distances to those of the library.
InterfaceDistances to_distances(const InterfaceCertificate& certificate);

}  // namespace interfaces

}  // namespace adamas
