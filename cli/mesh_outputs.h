#pragma once

#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/cut_mesh_output.h"
#include "cli/ledger.h"
#include "cli/surface_picture.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas {

/// The files that a resampled mesh is written to, each empty where it is not wanted.
struct MeshOutputs {
  std::string mesh, interfaces, ledger;
  CutMeshOutput cut;
  SurfacePictureOptions picture;

  /// Whether the mesh itself is wanted, with its fields.
  [[nodiscard]] bool need_mesh() const { return !mesh.empty() || !cut.file.empty() || !ledger.empty(); }
  [[nodiscard]] bool need_interfaces() const { return !interfaces.empty() || !picture.camera.file.empty(); }
  /// Throws UsageError for what is no file of its kind, and Error where folders cannot be used.
  void declare(OutputSet& outputs) const;
};

void add_mesh_output_options(const Command& command, MeshOutputs& outputs);

/// Interfaces and their picture.
void write_interfaces(const MeshOutputs& outputs, const InterfaceMesh& interfaces, const Box3& box,
                      Session& session);
/// The mesh, the cut mesh, and last the ledgers, which get theirs; returns the figures of the cut mesh.
/// `interface_error` and `source` as for write_cut_mesh.
Figures write_mesh(const MeshOutputs& outputs, const ResampledMesh& mesh, double interface_error,
                   const ResamplingSource* source, std::vector<Ledger>& ledgers, Session& session);

}  // namespace adamas
