#include "adamas/probe.h"

#include "core/base/loop_progress.h"
#include "core/data/grid_data.h"
#include "interfaces/library/adaptive_mesh.h"
#include "interfaces/library/input.h"
#include "interfaces/library/material_totals.h"
#include "interfaces/probe/material_integrals.h"
#include "interfaces/probe/probe.h"

namespace adamas {

using namespace interfaces;

namespace {

PointSamples to_point_samples(std::vector<ProbeSample>&& samples, const std::vector<std::string>& materials,
                              std::vector<FieldDescription> fields) {
  PointSamples result{materials, std::move(fields), {}};
  result.points.reserve(samples.size());
  for (ProbeSample& sample : samples)
    result.points.push_back({sample.point, sample.inside ? sample.material.value : PointSample::kNoMaterial,
                             std::move(sample.values), sample.interface_distance});
  return result;
}

}  // namespace

namespace interfaces {

std::vector<MaterialTotals> to_totals(IdVector<MaterialId, MaterialIntegral>&& integrals,
                                      const IdVector<MaterialId, std::string>& materials) {
  std::vector<MaterialTotals> totals;
  for (MaterialId m(0); m.value < integrals.size(); ++m.value)
    totals.push_back(
        {materials[m], integrals[m].volume, std::move(integrals[m].integral), std::move(integrals[m].mean)});
  return totals;
}

}  // namespace interfaces

PointSamples probe(const AdaptiveMesh& mesh, std::span<const Vec3> points) {
  const ResampledMesh& probed = mesh.contents().mesh;
  return to_point_samples(interfaces::probe(probed, points), probed.materials, describe(probed.fields));
}

PointSamples probe(const Input& input, std::span<const Vec3> points, const ReconstructOptions& options,
                   Progress& progress) {
  const LoopProgress loops(progress);
  const ResamplingSource source = input.contents().source(
      {.smooth_labels = options.smooth_labels, .fractions = options.fractions}, progress);
  progress.step("probing", -1);
  return to_point_samples(interfaces::probe(source, points), input.materials(), input.fields());
}

std::vector<MaterialTotals> material_totals(const AdaptiveMesh& mesh) {
  return to_totals(material_integrals(mesh.contents().mesh), mesh.contents().mesh.materials);
}

std::vector<MaterialTotals> material_totals(const GridData& data) {
  const MultiMaterialData taken = to_multi_material_data(data);
  return to_totals(material_integrals(taken), taken.materials);
}

}  // namespace adamas
