#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adamas/comparison.h"
#include "adamas/progress.h"
#include "core/base/error.h"
#include "interfaces/comparison/mesh_figures.h"
#include "interfaces/comparison/reference_mesher.h"
#include "interfaces/resampling/resample_figures.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

struct ComparedMesh;

/// The meshes that are compared, and how they are made.
struct ComparisonOptions {
  std::vector<double> interface_errors;  ///< wanted of the resampled meshes, in units of length
  ResamplingOptions resampling;          ///< all but the interface error
  bool tetgen = true, mesh3 = true;
  std::string tetgen_switches = "zpq1.414Q";
  /// The input, where it is a labelled image, which Mesh_3 is given too; labels are materials.
  std::optional<LabelImage> image;
  MesherOptions mesher;  ///< its time limit is for all trials of one mesh together, with measuring
  /// This is called with each row as soon as it is finished; it may be empty.
  std::function<void(const ComparedMesh&)> finished;
};

/// A row of the comparison.
struct ComparedMesh {
  MeshKind kind = MeshKind::kOwn;
  std::optional<double> interface_error;  ///< wanted of the resampled mesh of this group of rows
  std::string failure;                    ///< why there are no figures; empty where there are
  std::string switches;                   ///< the generator's
  std::string note;                       ///< further facts, for the user
  MeshFigures figures;
  double seconds = 0;  ///< for the mesh
  double certifying_seconds =
      0;                     ///< the part of `seconds` for measuring the interfaces and mending what fails
  double field_seconds = 0;  ///< for fields at its vertices
  std::size_t peak_memory_bytes = 0;
  std::size_t trials = 0;  ///< sizes that were tried
  /// Whether there is a mesh, and its distance is that of the resampled mesh within SizingOptions::tolerance.
  bool matched = false;
  /// The errors that were wanted of the resampled mesh and not reached.
  std::vector<UnreachedError> unreached{};
};

/// Makes the rows, group by group (docs/method.md, Reference meshes); that of TetGen with the input's
/// interfaces, which belongs to no error, comes in the first group. A generator that fails gives a row with
/// its reason.
std::vector<ComparedMesh> compare_meshes(const ResamplingSource& source, const ComparisonOptions& options,
                                         Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
