#pragma once

#include <string>
#include <vector>

#include "adamas/cut_mesh.h"
#include "adamas/material_colours.h"
#include "adamas/meshes.h"
#include "adamas/resample.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/ledger.h"
#include "cli/picture_options.h"

namespace adamas::cli {

/// The file of a mesh that is cut along its interfaces; empty where it is not wanted.
struct CutMeshOutput {
  std::string file;
  CutMeshOptions options;

  /// Returns the file of the faces between bodies; empty where they are in the mesh's own file.
  [[nodiscard]] std::string faces() const;

  /// Declares the files. Throws Error (kUsage) for an invalid error, and for a file of another kind.
  void declare(OutputSet& outputs) const;
};

/// The files of a resampled mesh, each empty where it is not wanted.
struct MeshOutputs {
  std::string mesh, interfaces, ledger;
  MaterialColours colours{};  ///< those that the input has for materials
  CutMeshOutput cut;
  PictureOptions picture;

  /// Returns whether the mesh itself is wanted, with its fields.
  [[nodiscard]] bool need_mesh() const { return !mesh.empty() || !cut.file.empty() || !ledger.empty(); }
  [[nodiscard]] bool need_interfaces() const { return !interfaces.empty() || !picture.file.empty(); }
  /// Declares the files. Throws Error (kUsage) for names of another kind, and Error where folders cannot be
  /// used.
  void declare(OutputSet& outputs) const;
};

/// Adds the options of these files. `series`: whether there may be several meshes.
void add_mesh_output_options(const Command& command, MeshOutputs& outputs, bool series = false);

/// Writes interfaces and their picture, which shows a section of the mesh if it can be turned.
void write_interfaces(const MeshOutputs& outputs, const InterfaceTriangles& interfaces,
                      const AdaptiveMesh& mesh, Session& session);
/// Writes the mesh, the cut mesh, and last the ledgers, to which they are added; prints figures of the cut
/// mesh and returns them, null where none is wanted.
Figures write_meshes(const MeshOutputs& outputs, const AdaptiveMesh& mesh, std::vector<Ledger>& ledgers,
                     Session& session);

}  // namespace adamas::cli
