#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/console.h"
#include "cli/resample_figures.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/probe/material_integrals.h"
#include "interfaces/resampling/resampler.h"
#include "workflow/slices/slice_loading.h"

namespace adamas::cli {

/// Errors of one field over the tetrahedra that were split, made monotone in two ways.
struct NestedSummary {
  double greatest = 0, mean = 0;                      ///< the greatest below
  double corrected_greatest = 0, corrected_mean = 0;  ///< by vertex corrections (D 3.1)
  std::size_t tetrahedra = 0;
  std::size_t undefined = 0;  ///< without a correction
};

/// The result of one run of the resampler within an experiment.
struct ExperimentRun {
  interfaces::ResamplingOptions options;
  ResampleReport report;
  std::vector<NestedSummary> nested;   ///< per field; empty without a mesh
  std::vector<std::string> unreached;  ///< a line for each error that was wanted and not reached
  std::vector<std::string> told;       ///< the same as a terminal shows it, many bodies as one line
  Figures json;
  double seconds = 0;
};

/// Resamples; `mesh` and `interfaces`, unless null, receive the result.
ExperimentRun run_resampler(const interfaces::ResamplingSource& source,
                            const interfaces::ResamplingOptions& options, Console& console,
                            interfaces::ResampledMesh* mesh = nullptr, InterfaceMesh* interfaces = nullptr);

/// Volume and, where there is a density, mass of a material, in the input and in the mesh.
struct LedgerRow {
  std::string material;
  double volume_input = 0, volume_mesh = 0;
  double mass_input = 0, mass_mesh = 0;  ///< NaN where the material has no density
};

/// The rows of integrals of an input and of a mesh, by material; `in` and `out`: the places of the density in
/// them, none for volumes alone.
std::vector<LedgerRow> ledger_rows(const IdVector<MaterialId, std::string>& materials,
                                   const IdVector<MaterialId, interfaces::MaterialIntegral>& input,
                                   const IdVector<MaterialId, interfaces::MaterialIntegral>& mesh,
                                   std::optional<std::size_t> in, std::optional<std::size_t> out);

/// Integrals over what the files hold. `density`: the name of a scalar field; empty for volumes alone.
std::vector<LedgerRow> make_ledger(const MultiMaterialData& data, const interfaces::ResampledMesh& mesh,
                                   const std::string& density);

}  // namespace adamas::cli
