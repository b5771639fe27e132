#include "adamas/generated_files.h"

#include <memory>
#include <span>
#include <utility>

#include "adamas/volume_output.h"
#include "core/data/multi_material_data.h"
#include "core/data/stored_type.h"
#include "core/io/multi_material_writer.h"
#include "core/io/volume_writer.h"
#include "datasets/buckyball.h"
#include "datasets/scene_volume.h"

namespace adamas {

using namespace datasets;
using namespace io;

namespace {

SeriesOutput::Writer writer_of(OwnedGridData owned) {
  const std::shared_ptr<const MultiMaterialData> data = std::move(owned).release();
  return [data](const std::filesystem::path& path) { write_multi_material_data(path, *data); };
}

/// Returns a writer of the samples of a scene; `written` gets their scale.
SeriesOutput::Writer writer_of_samples(const SceneSampling& sampling, double time, WrittenScene& written,
                                       Progress& progress) {
  return [&sampling, &written, &progress,
          scene = make_scene(sampling.name, sampling.seed, {sampling.box, time})](const auto& path) {
    const SceneVolume volume(scene, sampling.cells, *sampling.volume);
    written.slope = volume.scale().slope(), written.intercept = volume.scale().intercept();
    std::vector<std::byte> samples(volume.grid().plane_bytes());
    const auto plane = [&](std::uint64_t k) {
      progress.check();
      volume.plane(k, samples);
      return std::span<const std::byte>(samples);
    };
    write_point_arrays(path, volume.grid(), {{"inside", written.slope, written.intercept, plane}});
  };
}

std::vector<PointArray> point_arrays(const MixingSimulation& flow) {
  std::vector<PointArray> arrays;
  const std::size_t plane = flow.grid().plane_bytes();
  for (const SampledField& field : flow.fields()) {
    arrays.push_back(
        {field.name, field.slope, field.intercept,
         [plane, samples = field.samples](std::uint64_t k) { return samples.subspan(k * plane, plane); }});
  }
  return arrays;
}

}  // namespace

WrittenScene write_scene(const SceneSampling& sampling, SeriesOutput& series, OutputSet& outputs,
                         Progress& progress) {
  WrittenScene written;
  const auto make = [&](double time, Progress& step) {
    const AnalyticScene scene(sampling.name, sampling.seed, {sampling.box, time});
    if (sampling.volume) {
      written.states.push_back({time, scene.materials()});
      return writer_of_samples(sampling, time, written, step);
    }
    GeneratedScene sampled = scene.sample(sampling.cells, sampling.blur, step);
    written.states.push_back({time, std::move(sampled.materials)});
    return writer_of(std::move(sampled.data));
  };
  series.write(make, outputs, progress);
  return written;
}

void write_flow(ImpactSimulation& flow, SeriesOutput& series, OutputSet& outputs, Progress& progress) {
  const auto make = [&flow](double time, Progress& step) {
    flow.advance_to(time, step);
    return writer_of(flow.data());
  };
  series.write(make, outputs, progress);
}

void write_flow(MixingSimulation& flow, SeriesOutput& series, OutputSet& outputs, Progress& progress) {
  const auto make = [&flow](double time, Progress& step) -> SeriesOutput::Writer {
    flow.advance_to(time, step);
    return [&flow](const auto& path) { write_point_arrays(path, flow.grid(), point_arrays(flow)); };
  };
  series.write(make, outputs, progress);
}

WrittenVolume write_buckyball(const std::array<std::uint64_t, 3>& samples, SampleType type,
                              const std::filesystem::path& output, OutputSet& outputs, Progress& progress) {
  declare_volume_output(output, outputs);
  const Buckyball ball(samples, type);
  const VolumeGrid& grid = ball.grid();
  const auto make = [&](const PlaneSink& sink) {
    std::vector<std::byte> plane(grid.plane_bytes());
    const std::uint64_t planes = grid.dimensions[2];
    for (std::uint64_t k = 0; k < planes; ++k) {
      progress.step("writing " + output.string(), static_cast<double>(k) / static_cast<double>(planes));
      ball.plane(k, plane);
      sink(plane);
    }
  };
  return {grid, write_volume_output(output, grid, stored_type(grid.type), "buckyball", make, outputs)};
}

}  // namespace adamas
