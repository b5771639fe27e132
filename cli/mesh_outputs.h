#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/surface_picture.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/probe/material_integrals.h"
#include "interfaces/source/field_source.h"
#include "interfaces/source/resampling_source.h"

namespace adamas::cli {

/// Volumes of the materials and integrals of their fields, in the input or in a mesh: of a density that is
/// mass.
struct Ledger {
  std::string of;  ///< what it is of: "input", "mesh", "cut mesh"
  IdVector<MaterialId, interfaces::MaterialIntegral> materials;
};

/// Volumes alone, where there are no fields.
Ledger volume_ledger(const std::string& of, const IdVector<MaterialId, double>& volumes);

/// For `--json`: a row per ledger and material.
Figures ledger_figures(const std::vector<Ledger>& ledgers, const IdVector<MaterialId, std::string>& materials,
                       const std::vector<interfaces::FieldInfo>& fields);
/// The same as CSV; what a material has not is left empty.
std::string ledger_csv(const std::vector<Ledger>& ledgers, const IdVector<MaterialId, std::string>& materials,
                       const std::vector<interfaces::FieldInfo>& fields);

/// The file that a mesh cut along its interfaces is written to, empty where it is not wanted, and how far the
/// faces between materials may be from the mesh's interfaces, none for half the interface error.
struct CutMeshOutput {
  std::string file;
  std::optional<ErrorTarget> error;
  bool split_bodies = false;  ///< a point on interfaces comes once for each body

  /// The file that the faces between bodies go to; empty where they are in the mesh's own.
  [[nodiscard]] std::string faces() const;

  /// Throws Error (kUsage) for an error that is none, and for a file of another kind.
  void declare(OutputSet& outputs) const;
};

void add_cut_mesh_options(const Command& command, CutMeshOutput& output);

/// Cuts, measures, prints, and writes; returns the figures for `--json`, null where no cut mesh is wanted.
/// `interface_error`: of the mesh, a length. `source`: what the mesh was made of, null where that is not
/// known.
Figures write_cut_mesh(const CutMeshOutput& output, const interfaces::ResampledMesh& mesh,
                       double interface_error, const interfaces::ResamplingSource* source,
                       std::vector<Ledger>& ledgers, Session& session);

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

/// Interfaces and their picture; `mesh` is called for what a picture that turns shows on a cut.
void write_interfaces(const MeshOutputs& outputs, const InterfaceMesh& interfaces, const Box3& box,
                      const std::function<interfaces::ResampledMesh()>& mesh, Session& session);
/// The mesh, the cut mesh, and last the ledgers, which get theirs; returns the figures of the cut mesh.
/// `interface_error` and `source` as for write_cut_mesh.
Figures write_mesh(const MeshOutputs& outputs, const interfaces::ResampledMesh& mesh, double interface_error,
                   const interfaces::ResamplingSource* source, std::vector<Ledger>& ledgers,
                   Session& session);

}  // namespace adamas::cli
