#pragma once

#include <string>
#include <vector>

#include "adamas/cut_mesh.h"
#include "adamas/meshes.h"
#include "adamas/resample.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/ledger.h"
#include "cli/picture_options.h"

namespace adamas::cli {

/// The file that a mesh cut along its interfaces is written to, empty where it is not wanted.
struct CutMeshOutput {
  std::string file;
  CutMeshOptions options;

  /// The file that the faces between bodies go to; empty where they are in the mesh's own.
  [[nodiscard]] std::string faces() const;

  /// Throws Error (kUsage) for an error that is none, and for a file of another kind.
  void declare(OutputSet& outputs) const;
};

/// The files that a resampled mesh is written to, each empty where it is not wanted.
struct MeshOutputs {
  std::string mesh, interfaces, ledger;
  CutMeshOutput cut;
  PictureOptions picture;

  /// Whether the mesh itself is wanted, with its fields.
  [[nodiscard]] bool need_mesh() const { return !mesh.empty() || !cut.file.empty() || !ledger.empty(); }
  [[nodiscard]] bool need_interfaces() const { return !interfaces.empty() || !picture.file.empty(); }
  /// Throws Error (kUsage) for what is no file of its kind, and Error where folders cannot be used.
  void declare(OutputSet& outputs) const;
};

/// `series`: whether there may be several meshes.
void add_mesh_output_options(const Command& command, MeshOutputs& outputs, bool series = false);

/// Writes interfaces and their picture, which shows a cut of the mesh where it turns.
void write_interfaces(const MeshOutputs& outputs, const InterfaceTriangles& interfaces,
                      const AdaptiveMesh& mesh, Session& session);
/// Writes the mesh, the cut mesh, and last the ledgers, which get theirs; prints what the cut mesh is like
/// and returns its figures, null where none is wanted.
Figures write_meshes(const MeshOutputs& outputs, const AdaptiveMesh& mesh, std::vector<Ledger>& ledgers,
                     Session& session);

}  // namespace adamas::cli
