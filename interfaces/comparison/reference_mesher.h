#pragma once

#include <string>

#include "interfaces/comparison/piecewise_linear_complex.h"
#include "interfaces/mesh/conforming_mesh.h"
#include "interfaces/reference_client/child_program.h"
#include "interfaces/reference_client/program_messages.h"

namespace adamas::interfaces {

/// The separate program `adamas-reference`, which makes meshes of other generators, and its limits.
struct MesherOptions {
  std::filesystem::path program;
  ChildLimits limits;
};

/// A mesh by another generator, or the reason why there is none.
struct ReferenceResult {
  std::string failure;   ///< empty if there is a mesh
  bool crashed = false;  ///< whether the program ended by a signal
  ConformingMesh mesh;
  double seconds = 0;                 ///< the time in the library, without start of the process, input and
                                      ///< output
  std::size_t peak_memory_bytes = 0;  ///< of the process; 0 if it is not known
};

/// Meshes a complex by TetGen with these switches. If it crashes, it runs again to find triangles that
/// intersect.
ReferenceResult mesh_by_tetgen(const PiecewiseLinearComplex& complex, const std::string& switches,
                               const MesherOptions& options,
                               const Progress& progress = SilentProgress::instance());

/// Meshes a complex by CGAL's Mesh_3 with the patches' borders protected.
ReferenceResult mesh_by_mesh3(const PiecewiseLinearComplex& complex, const Mesh3Criteria& criteria,
                              const MesherOptions& options,
                              const Progress& progress = SilentProgress::instance());

/// Meshes labels directly by CGAL's Mesh_3. The tetrahedra's bodies are the labels.
ReferenceResult mesh_by_mesh3(const LabelImage& image, const Mesh3Criteria& criteria,
                              const MesherOptions& options,
                              const Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
