#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "interfaces/reference/mesh_figures.h"
#include "interfaces/reference/reference_mesher.h"
#include "interfaces/resampling/resample_figures.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

struct ComparedMesh;

/// What is compared, and how.
struct ComparisonOptions {
  std::vector<double> interface_errors;  ///< wanted of the resampled meshes, in units of length
  ResamplingOptions resampling;          ///< all but the interface error
  bool tetgen = true, mesh3 = true;
  std::string tetgen_switches = "zpq1.414Q";
  std::optional<LabelImage>
      image;             ///< what Mesh_3 is given too, where the input is one; labels are materials
  MesherOptions mesher;  ///< its time limit is for all trials of one mesh together, with measuring
  /// Called with each row as soon as it is finished; may be empty.
  std::function<void(const ComparedMesh&)> finished;
};

/// How many meshes of other generators a comparison asks for.
std::size_t reference_count(const ComparisonOptions& options);

enum class MeshKind {
  kOwn,               ///< the resampled mesh
  kOwnCut,            ///< its cells cut along the interfaces
  kTetGen,            ///< TetGen with the resampled mesh's interfaces
  kTetGenUntouched,   ///< TetGen with the input's interfaces
  kMesh3,             ///< Mesh_3, its sizing matched to the resampled mesh's measured distance
  kMesh3Optimised,    ///< the same, then perturbed and exuded, as Mesh_3 does by default
  kTetGenSimplified,  ///< TetGen with the input's interfaces, simplified to the interface error
  kMesh3Simplified,   ///< Mesh_3, matched as well, with the input's interfaces simplified to half of it
  kMesh3Labels,       ///< Mesh_3, matched as well, straight from the labelled image
};

/// A row of the comparison.
struct ComparedMesh {
  MeshKind kind = MeshKind::kOwn;
  std::optional<double> interface_error;  ///< wanted of the resampled mesh of this group of rows
  std::string failure;                    ///< why there are no figures; empty where there are
  std::string switches;                   ///< of the generator
  std::string note;                       ///< what else has to be known
  MeshFigures figures;
  double seconds = 0;             ///< for the mesh
  double certifying_seconds = 0;  ///< of these, for measuring the interfaces and mending what fails
  double field_seconds = 0;       ///< for fields at its vertices
  std::size_t peak_memory_bytes = 0;
  std::size_t trials = 0;  ///< of sizing
  /// There is a mesh, and its distance is that of the resampled mesh within SizingOptions::tolerance.
  bool matched = false;
  /// Of the resampled mesh, the errors that were wanted and not reached.
  std::vector<UnreachedError> unreached{};
};

/// The rows, group by group (docs/method.md, Reference meshes); that of TetGen with the input's interfaces,
/// which belongs to no error, comes in the first group. A generator that fails gives a row with its reason.
std::vector<ComparedMesh> compare_meshes(const ResamplingSource& source, const ComparisonOptions& options,
                                         Progress& progress = SilentProgress::instance());

/// "TetGen (our interfaces)" and the like.
std::string mesh_name(MeshKind kind);

}  // namespace adamas::interfaces
