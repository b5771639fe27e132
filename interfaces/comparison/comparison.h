#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adamas/comparison.h"
#include "adamas/progress.h"
#include "interfaces/comparison/mesh_figures.h"
#include "interfaces/comparison/reference_mesher.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

struct ComparedMesh;

/// The meshes to compare and the options for making them.
struct ComparisonOptions {
  std::vector<double> interface_errors;  ///< the wanted errors of the resampled meshes, in units of length
  ResamplingOptions resampling;          ///< all but the interface error
  bool tetgen = true, mesh3 = true;
  std::string tetgen_switches = "zpq1.414Q";
  /// The input if it is a labelled image, which Mesh_3 gets too; labels are materials.
  std::optional<LabelImage> image;
  MesherOptions mesher;  ///< its time limit is for all trials of one mesh together, including measurements
  /// This is called with each row as soon as it is finished; it may be empty.
  std::function<void(const ComparedMesh&)> finished;
};

/// A row of the comparison.
struct ComparedMesh {
  MeshKind kind = MeshKind::kOwn;
  std::optional<double> interface_error;  ///< the wanted error of the resampled mesh of this group of rows
  std::string failure;                    ///< the reason why there are no figures; empty if there are figures
  std::string switches;                   ///< the generator's switches
  std::string note;                       ///< further facts, for the user
  MeshFigures figures;
  double seconds = 0;  ///< the time for making the mesh
  /// The part of `seconds` for measuring the interfaces and correcting faults.
  double certifying_seconds = 0;
  double field_seconds = 0;  ///< the time for fields at its vertices
  std::size_t peak_memory_bytes = 0;
  std::size_t trials = 0;  ///< the number of tried sizes
  /// Whether there is a mesh, and its distance is that of the resampled mesh within SizingOptions::tolerance.
  bool matched = false;
  /// The wanted errors that the resampled mesh does not reach.
  std::vector<UnreachedError> unreached{};
};

/// Makes the rows, group by group (docs/method.md, Reference meshes). The row of TetGen with the input's
/// interfaces, which belongs to no error, is in the first group. A generator that fails gives a row with the
/// reason.
std::vector<ComparedMesh> compare_meshes(const ResamplingSource& source, const ComparisonOptions& options,
                                         Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
