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

/// A row of the comparison as it was measured: its sizes, angles, distances, errors of fields and volumes are
/// in `figures`, and not yet in the members of the library's row.
struct ComparedMesh : ComparisonRow {
  MeshFigures figures;
};

/// Makes the rows, group by group (docs/method.md, Reference meshes). The row of TetGen with the input's
/// interfaces, which belongs to no error, is in the first group. A generator that fails gives a row with the
/// reason.
std::vector<ComparedMesh> compare_meshes(const ResamplingSource& source, const ComparisonOptions& options,
                                         Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
