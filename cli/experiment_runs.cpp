#include "cli/experiment_runs.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "adamas/report_text.h"
#include "interfaces/cross_section/field_choice.h"
#include "interfaces/library/resample_report.h"
#include "interfaces/resampling/nested_errors.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::cli {

using namespace interfaces;

namespace {

NestedSummary nested_summary(const Resampler& resampler, std::size_t field) {
  const NestedErrors nested = nest_field_errors(resampler, field);
  const CorrectedErrors corrected = correct_field_errors(resampler, field);
  const auto& hierarchy = resampler.hierarchy();
  NestedSummary result;
  result.undefined = corrected.undefined;
  std::vector<TetrahedronId> open = hierarchy.roots();
  while (!open.empty()) {
    const TetrahedronId t = open.back();
    open.pop_back();
    if (hierarchy.is_leaf(t)) continue;
    const auto children = hierarchy.children(t);
    open.insert(open.end(), children.begin(), children.end());
    const double direct = nested[t], sum = corrected.of_tetrahedra[t.value];
    result.greatest = std::max(result.greatest, direct);
    result.corrected_greatest = std::max(result.corrected_greatest, sum);
    result.mean += direct;
    result.corrected_mean += sum;
    ++result.tetrahedra;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(result.tetrahedra, 1));
  result.mean /= count;
  result.corrected_mean /= count;
  return result;
}

}  // namespace

ExperimentRun run_resampler(const ResamplingSource& source, const ResamplingOptions& options,
                            Console& console, ResampledMesh* mesh, InterfaceMesh* interfaces) {
  const auto start = std::chrono::steady_clock::now();
  Resampler resampler(source, options, console);
  resampler.refine();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  console.step("measuring", -1);
  ExperimentRun run;
  run.options = options;
  run.report = report_of(resampler, console);
  run.seconds = elapsed.count();
  run.json = resample_json(run.report);
  run.json["seconds"] = run.seconds;
  run.unreached = unreached_lines(run.report);
  run.told = unreached_lines(run.report, console.verbose);
  if (interfaces != nullptr) *interfaces = approximated_interfaces(resampler, console);
  if (mesh != nullptr) {
    *mesh = resampled_mesh(resampler);
    for (std::size_t f = 0; f < run.report.fields.size(); ++f)
      run.nested.push_back(nested_summary(resampler, f));
  }
  return run;
}

std::vector<LedgerRow> ledger_rows(const IdVector<MaterialId, std::string>& materials,
                                   const IdVector<MaterialId, MaterialIntegral>& input,
                                   const IdVector<MaterialId, MaterialIntegral>& mesh,
                                   std::optional<std::size_t> in, std::optional<std::size_t> out) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<LedgerRow> rows;
  for (MaterialId m(0); m.value < materials.size(); ++m.value) {
    rows.push_back({materials[m], input[m].volume, mesh[m].volume, in ? input[m].integral[*in] : kNone,
                    out ? mesh[m].integral[*out] : kNone});
  }
  return rows;
}

std::vector<LedgerRow> make_ledger(const MultiMaterialData& data, const ResampledMesh& mesh,
                                   const std::string& density) {
  std::optional<std::size_t> in, out;
  if (!density.empty()) {
    const std::vector<FieldInfo> fields = field_infos(data);
    in = fields[find_field(fields, density, data.source).field].offset;
    out = mesh.fields[find_field(mesh.fields, density, mesh.source).field].offset;
  }
  return ledger_rows(data.materials, material_integrals(data), material_integrals(mesh), in, out);
}

}  // namespace adamas::cli
