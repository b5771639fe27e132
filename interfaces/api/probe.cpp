#include "adamas/probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/base/notes.h"
#include "core/data/grid_data.h"
#include "interfaces/api/adaptive_mesh.h"
#include "interfaces/api/input.h"
#include "interfaces/api/interface_areas.h"
#include "interfaces/api/material_totals.h"
#include "interfaces/probe/material_integrals.h"
#include "interfaces/probe/probe.h"

namespace adamas {

using namespace interfaces;

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

namespace {

/// Notes how many points are outside the domain, since their missing values are easily overlooked.
void note_points_outside(const PointSamples& samples, const Box3& domain, Progress& progress) {
  const auto outside = std::count_if(samples.points.begin(), samples.points.end(),
                                     [](const PointSample& sample) { return !sample.inside(); });
  if (outside == 0) return;
  note(progress, "{} of {} points {} outside of the domain {}", outside, samples.points.size(),
       outside == 1 ? "lies" : "lie", box_text(domain));
}

/// Samples labels at few points, near which interfaces are made; returns none for other inputs, and where
/// more is needed.
std::optional<std::vector<PointSample>> probe_labels(const Input& input, std::span<const Vec3> points,
                                                     const ReconstructionOptions& options,
                                                     Progress& progress) {
  // Where there are more points, all interfaces take less time.
  constexpr std::size_t kSitesPerPoint = 4096;
  const Input::Contents& contents = input.contents();
  if (!contents.data || contents.mesh || contents.data->labels.empty()) return {};
  const MultiMaterialData& data = *contents.data;
  check_reconstruction(options, data);
  if (options.smooth_labels || points.size() > data.grid.site_count() / kSitesPerPoint) return {};
  const std::unique_ptr<LabelParts> parts = LabelParts::make(data, progress);
  if (!parts) return {};
  progress.step("probing", -1);
  return interfaces::probe(data, *parts, points);
}

PointSamples described(const Input& input, std::vector<PointSample> samples, Progress& progress) {
  PointSamples result{input.materials(), input.fields(), std::move(samples)};
  note_points_outside(result, input.domain(), progress);
  return result;
}

PointSamples probe_source(const Input& input, const ResamplingSource& source, std::span<const Vec3> points,
                          Progress& progress) {
  progress.step("probing", -1);
  return described(input, interfaces::probe(source, points), progress);
}

ReconstructionOptions to_reconstruction_options(const ReconstructOptions& options) {
  return {.smooth_labels = options.smooth_labels, .fractions = options.fractions};
}

void append_number(std::string& line, double value) {
  line += ',';
  if (std::isfinite(value)) fmt::format_to(std::back_inserter(line), "{:.10g}", value);
}

}  // namespace

std::vector<Vec3> line_points(const Vec3& a, const Vec3& b, std::size_t count) {
  constexpr std::size_t kMaxPoints = 100'000'000;
  for (const Vec3* p : {&a, &b}) {
    if (!is_finite(*p)) fail("line: expected finite ends, found ({}, {}, {})", p->x, p->y, p->z);
  }
  if (count < 2 || count > kMaxPoints) fail("line: expected 2 to {} points, found {}", kMaxPoints, count);
  std::vector<Vec3> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(count - 1);
    points[i] = (1 - t) * a + t * b;
  }
  points.back() = b;
  return points;
}

std::string to_csv(const PointSamples& samples) {
  std::string text = "x,y,z,material,interface distance";
  for (const FieldDescription& f : samples.fields) {
    const std::string unit = f.unit.empty() ? "" : " [" + f.unit + "]";
    for (int c = 0; c < f.components; ++c) {
      const std::string index = f.components > 1 ? fmt::format(":{}", c) : std::string();
      text += ',' + csv_text(f.name + index + unit);
    }
  }
  text += '\n';
  for (const PointSample& s : samples.points) {
    fmt::format_to(std::back_inserter(text), "{:.10g},{:.10g},{:.10g},", s.point.x, s.point.y, s.point.z);
    if (s.inside()) text += csv_text(samples.materials[s.material]);
    append_number(text, s.interface_distance);
    for (const double value : s.values) append_number(text, value);
    text += '\n';
  }
  return text;
}

PointSamples probe(const AdaptiveMesh& mesh, std::span<const Vec3> points, Progress& progress) {
  const LoopProgress loops(progress);
  const ResampledMesh& probed = mesh.contents().mesh();
  progress.step("probing", -1);
  PointSamples samples{probed.materials, describe(probed.fields), interfaces::probe(probed, points)};
  note_points_outside(samples, probed.box, progress);
  return samples;
}

PointSamples probe(const Input& input, std::span<const Vec3> points, const ReconstructOptions& options,
                   Progress& progress) {
  const LoopProgress loops(progress);
  const ReconstructionOptions how = to_reconstruction_options(options);
  if (auto samples = probe_labels(input, points, how, progress))
    return described(input, std::move(*samples), progress);
  return probe_source(input, input.contents().source(how, progress), points, progress);
}

InputProbe probe_and_integrate(const Input& input, std::span<const Vec3> points,
                               const ReconstructOptions& options, Progress& progress) {
  const LoopProgress loops(progress);
  const ReconstructionOptions how = to_reconstruction_options(options);
  // Where interfaces are given, the grid needs no materials.
  const MultiMaterialData* data = input.contents().data.get();
  const bool has_materials = data != nullptr && !(data->fractions.empty() && data->labels.empty());
  InputProbe result;
  if (has_materials) {
    // Integrals of data need no interfaces, unless they are given and have to be checked.
    if (points.empty() && !input.contents().mesh) {
      check_reconstruction(how, *data);
      result.samples = described(input, {}, progress);
    } else {
      result.samples = probe(input, points, options, progress);
    }
    progress.check();
    result.totals = to_totals(material_integrals(*data), data->materials);
    return result;
  }
  const ResamplingSource source = input.contents().source(how, progress);
  result.samples = probe_source(input, source, points, progress);
  progress.check();
  if (const MeshData* cells = input.contents().cells.get()) {
    result.totals = to_totals(material_integrals(*cells, source.volumes), source.materials);
    return result;
  }
  for (MaterialId m(0); m.value < source.volumes.size(); ++m.value)
    result.totals.push_back({source.materials[m], source.volumes[m], {}, {}});
  result.interfaces = interface_areas(source);
  return result;
}

std::vector<MaterialTotals> material_totals(const AdaptiveMesh& mesh) {
  const auto& reported = mesh.report().materials;
  if (mesh.fields().empty() && !reported.empty()) {
    std::vector<MaterialTotals> totals;
    for (const ResampleReport::Material& m : reported) totals.push_back({m.name, m.volume_mesh, {}, {}});
    return totals;
  }
  const ResampledMesh& integrated = mesh.contents().mesh();
  return to_totals(material_integrals(integrated), integrated.materials);
}

std::vector<MaterialTotals> input_totals(const AdaptiveMesh& mesh) {
  const AdaptiveMesh::Contents& contents = mesh.contents();
  // Where interfaces are given, the grid needs no materials.
  const MultiMaterialData* data = contents.run ? contents.run->input->data.get() : nullptr;
  if (data != nullptr && !contents.run->input->integrals.empty())
    return to_totals(IdVector(contents.run->input->integrals), data->materials);
  if (data != nullptr && !(data->fractions.empty() && data->labels.empty()))
    return to_totals(material_integrals(*data), data->materials);
  const IdVector<MaterialId, double>& volumes =
      contents.run ? contents.run->source.volumes : contents.input_volumes;
  if (contents.run && contents.run->input->cells) {
    const auto& materials = contents.run->source.materials;
    return to_totals(material_integrals(*contents.run->input->cells, volumes), materials);
  }
  std::vector<MaterialTotals> totals;
  for (MaterialId m(0); m.value < volumes.size(); ++m.value)
    totals.push_back({contents.materials[m.value], volumes[m], {}, {}});
  return totals;
}

std::vector<MaterialTotals> material_totals(const GridData& data) {
  const MultiMaterialData taken = to_multi_material_data(data);
  return to_totals(material_integrals(taken), taken.materials);
}

}  // namespace adamas
