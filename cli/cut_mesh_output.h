#pragma once

#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/ledger.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/source/resampling_source.h"

namespace adamas {

/// The file that a mesh cut along its interfaces is written to, empty where it is not wanted, and how far the
/// faces between materials may be from the mesh's interfaces, empty for half the interface error.
struct CutMeshOutput {
  std::string file, error;

  /// Throws UsageError for an error that is none, and for a file of another kind.
  void declare(OutputSet& outputs) const;
};

void add_cut_mesh_options(const Command& command, CutMeshOutput& output);

/// Cuts, measures, prints, and writes; returns the figures for `--json`, null where no cut mesh is wanted.
/// `interface_error`: of the mesh, a length. `source`: what the mesh was made of, null where that is not
/// known.
Figures write_cut_mesh(const CutMeshOutput& output, const ResampledMesh& mesh, double interface_error,
                       const ResamplingSource* source, std::vector<Ledger>& ledgers, Session& session);

}  // namespace adamas
