// Tests that a hierarchy that is adapted from step to step is the one that refinement from the roots makes of
// each step alone: it has the same numbers, and all its data are the same, bit for bit.

#include <cstring>

#include "core/base/error.h"
#include "datasets/flow/impact.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/resampling/resampler.h"
#include "tests/interfaces/hierarchy_validation.h"
#include "tests/interfaces/resampler_scenes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

template <class T>
void append(std::string& bytes, const std::vector<T>& values) {
  if constexpr (std::is_same_v<T, std::string>) {
    for (const std::string& value : values) bytes += value + '\n';
  } else {
    const auto size = values.size() * sizeof(T);
    bytes.resize(bytes.size() + size);
    if (size > 0) std::memcpy(bytes.data() + bytes.size() - size, values.data(), size);
  }
}

/// Returns all that the file of a mesh holds, in its order.
std::string bytes_of(const UnstructuredMesh& mesh) {
  std::string bytes;
  append(bytes, mesh.points);
  append(bytes, mesh.connectivity);
  for (const auto* arrays : {&mesh.point_arrays, &mesh.cell_arrays, &mesh.field_arrays}) {
    for (const NamedArray& array : *arrays) {
      bytes += array.name + '\n';
      std::visit([&bytes](const auto& values) { append(bytes, values); }, array.values);
    }
  }
  return bytes;
}

/// Returns the corners of all tetrahedra by number, whether they are leaves or not.
std::vector<std::array<LatticePoint, 4>> corners_by_number(const Resampler& resampler) {
  const auto& hierarchy = resampler.hierarchy();
  std::vector<std::array<LatticePoint, 4>> corners(hierarchy.tetrahedron_slots());
  std::vector<TetrahedronId> open = hierarchy.roots();
  while (!open.empty()) {
    const TetrahedronId t = open.back();
    open.pop_back();
    corners[t.value] = hierarchy.corners(t);
    if (hierarchy.is_leaf(t)) continue;
    for (const TetrahedronId child : hierarchy.children(t)) open.push_back(child);
  }
  return corners;
}

/// Returns the native elements of all tetrahedra by number, in the order in which their errors are added up.
std::vector<std::vector<std::uint32_t>> elements_by_number(const Resampler& resampler) {
  std::vector<std::vector<std::uint32_t>> elements(resampler.hierarchy().tetrahedron_slots());
  resampler.hierarchy().for_each_leaf([&](TetrahedronId t) {
    const auto found = resampler.elements(t);
    elements[t.value].assign(found.begin(), found.end());
  });
  return elements;
}

void expect_equal(const Resampler& adapted, const Resampler& alone) {
  ASSERT_NO_THROW(test::validate(adapted.hierarchy()));
  EXPECT_EQ(corners_by_number(adapted), corners_by_number(alone));
  EXPECT_EQ(elements_by_number(adapted), elements_by_number(alone));
  EXPECT_TRUE(bytes_of(to_unstructured_mesh(resampled_mesh(adapted))) ==
              bytes_of(to_unstructured_mesh(resampled_mesh(alone))));
  const InterfaceMesh shown = approximated_interfaces(adapted).mesh,
                      expected = approximated_interfaces(alone).mesh;
  EXPECT_EQ(shown.points, expected.points);
  EXPECT_EQ(shown.triangles, expected.triangles);
  ASSERT_EQ(adapted.certificate().has_value(), alone.certificate().has_value());
  if (!alone.certificate()) return;
  EXPECT_EQ(adapted.certificate()->networks.upper, alone.certificate()->networks.upper);
  EXPECT_EQ(adapted.certificate()->materials.upper, alone.certificate()->materials.upper);
  EXPECT_EQ(adapted.certificate()->worst_material, alone.certificate()->worst_material);
}

/// Resamples steps one after another, each from the hierarchy of the one before, and compares each with
/// refinement from the roots. Returns the total numbers of merges and splits.
Adaptation follow(const std::vector<MultiMaterialData>& steps, const ResamplingOptions& options) {
  std::optional<Resampler::MeshHierarchy> previous;
  Adaptation all;
  for (const MultiMaterialData& data : steps) {
    const ResamplingSource source = make_grid_source(data);
    Resampler adapted(source, options), alone(source, options);
    alone.refine();
    if (previous) {
      adapted.refine(std::move(*previous));
    } else {
      adapted.refine();
    }
    expect_equal(adapted, alone);
    if (adapted.adaptation()) {
      all.kept += adapted.adaptation()->kept;
      all.merged += adapted.adaptation()->merged;
      all.split += adapted.adaptation()->split;
    }
    previous = adapted.give_hierarchy();
  }
  return all;
}

void expect_all_ways(const Adaptation& changes) {
  EXPECT_GT(changes.kept, 0u);
  EXPECT_GT(changes.merged, 0u);
  EXPECT_GT(changes.split, 0u);
}

MultiMaterialData scene_data(const std::string& name, std::uint64_t seed, double time, std::size_t cells,
                             bool fields) {
  SceneOptions options;
  options.time = time;
  SamplingOptions sampling;
  sampling.fields = fields;
  sampling.depth = 2;
  return sample_scene(make_scene(name, seed, options), {cells, cells, cells}, sampling);
}

std::vector<MultiMaterialData> moving_steps(std::size_t cells, bool fields) {
  std::vector<MultiMaterialData> steps;
  for (const double time : {0.0, 0.1, 0.25, 0.6, 1.0})
    steps.push_back(scene_data("moving", 0, time, cells, fields));
  return steps;
}

ResamplingOptions within(double error) {
  ResamplingOptions options;
  options.interface_error = error;
  return options;
}

TEST(ResamplerSeries, ScenesThatMove) {
  ResamplingOptions options = within(0.02);
  options.certify = false;
  expect_all_ways(follow(moving_steps(12, false), options));
}

/// Certification, mending and conservation continue from the adapted hierarchy.
TEST(LongResamplerSeries, CertifiedAndConserved) {
  ResamplingOptions options = within(0.03);
  options.volume_error = 0.01;
  options.conserve = true;
  expect_all_ways(follow(moving_steps(12, true), options));
}

TEST(LongResamplerSeries, Fields) {
  ResamplingOptions options = within(0.04);
  const std::vector<MultiMaterialData> steps = moving_steps(12, true);
  options.field_errors.assign(steps[0].fields.size(), std::nullopt);
  options.field_errors.back() = 0.5;
  expect_all_ways(follow(steps, options));
}

/// The steps have nothing in common, so each needs other cells.
TEST(LongResamplerSeries, OtherSeeds) {
  for (const std::string name : {"voronoi10", "random"}) {
    std::vector<MultiMaterialData> steps;
    for (std::uint64_t seed = 1; seed <= 2; ++seed) steps.push_back(scene_data(name, seed, 1, 10, false));
    expect_all_ways(follow(steps, within(0.05)));
  }
}

TEST(LongResamplerSeries, AnImpact) {
  ImpactOptions impact;
  impact.cells = {10, 10, 16};
  FlowSolver<3> flow = make_impact(impact);
  std::vector<MultiMaterialData> steps;
  for (const double time : {0.0, 0.5, 1.0, 2.0, 3.0}) {
    flow.advance_to(time, SilentProgress::instance());
    steps.push_back(flow_data(flow, "impact", {"g/cm3", "Mbar", "cm/us"}));
  }
  expect_all_ways(follow(steps, within(0.3)));
}

/// Where the number of tetrahedra is limited, each step begins at the roots.
TEST(ResamplerSeries, AGreatestNumberOfTetrahedra) {
  ResamplingOptions options = within(0.01);
  options.certify = false;
  options.max_tetrahedra = 700;
  const Adaptation changes = follow(moving_steps(10, false), options);
  EXPECT_EQ(changes.kept + changes.merged + changes.split, 0u);
}

/// When two steps are the same, all cells are kept.
TEST(ResamplerSeries, NothingChanges) {
  ResamplingOptions options = within(0.03);
  options.certify = false;
  const std::vector<MultiMaterialData> steps{scene_data("moving", 0, 0.5, 10, false),
                                             scene_data("moving", 0, 0.5, 10, false)};
  const Adaptation changes = follow(steps, options);
  EXPECT_GT(changes.kept, 0u);
  EXPECT_EQ(changes.merged + changes.split, 0u);
}

TEST(ResamplerSeries, AnotherDomainIsRefused) {
  const MultiMaterialData data = scene_data("moving", 0, 0.5, 6, false);
  const ResamplingSource source = make_grid_source(data);
  Resampler resampler(source, within(0.1));
  Resampler::MeshHierarchy other(Domain::fit({{0, 0, 0}, {1, 1, 2}}));
  EXPECT_THROW(resampler.refine(std::move(other)), Error);
}

}  // namespace
}  // namespace adamas
