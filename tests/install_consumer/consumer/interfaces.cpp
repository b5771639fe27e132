// Resamples a ball of iron in water, given as volume fractions and a temperature, and looks at the result.

#include <adamas/reconstruct.h>
#include <adamas/resample.h>
#include <adamas/slice.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace {

constexpr std::size_t kCells = 16;
constexpr double kRadius = 0.3;

/// Returns the part of a cell that is within the ball, by points in it.
float iron_fraction(std::size_t i, std::size_t j, std::size_t k) {
  constexpr int kPoints = 8;
  int within = 0;
  for (int p = 0; p < kPoints * kPoints * kPoints; ++p) {
    const auto at = [](std::size_t cell, int point) {
      return (static_cast<double>(cell) + (point + 0.5) / kPoints) / kCells - 0.5;
    };
    const adamas::Vec3 offset{at(i, p % kPoints), at(j, p / kPoints % kPoints), at(k, p / kPoints / kPoints)};
    if (adamas::norm(offset) < kRadius) ++within;
  }
  return static_cast<float>(within) / (kPoints * kPoints * kPoints);
}

}  // namespace

int main() {
  std::vector<float> iron, water;
  std::vector<double> temperature;
  for (std::size_t k = 0; k < kCells; ++k) {
    for (std::size_t j = 0; j < kCells; ++j) {
      for (std::size_t i = 0; i < kCells; ++i) {
        iron.push_back(iron_fraction(i, j, k));
        water.push_back(1 - iron.back());
        temperature.push_back(300 + 10 * static_cast<double>(k));
      }
    }
  }
  // The data refer to these arrays.
  adamas::GridData data;
  data.grid = adamas::RectilinearGrid::uniform({kCells, kCells, kCells}, {0, 0, 0},
                                               {1.0 / kCells, 1.0 / kCells, 1.0 / kCells});
  data.materials = {"iron", "water"};
  data.fractions = {iron, water};
  data.fields.push_back({.name = "temperature", .unit = "K", .values = temperature});

  adamas::ResampleOptions options;
  options.interface_error = 0.02;
  options.field_errors = {{"temperature", 5}};
  const adamas::AdaptiveMesh mesh = adamas::resample(data, options);
  const adamas::ResampleReport& report = mesh.report();
  std::printf("%zu tetrahedra, interfaces within %.4f\n", mesh.tetrahedra().size(),
              report.interface_error->certified);

  // Each material has its own field, in named arrays.
  const adamas::ArrayView& of_iron = mesh.point_array("temperature in iron");
  const auto values = std::get<std::span<const double>>(of_iron.values);

  const adamas::InterfaceTriangles shown = mesh.interfaces();
  const adamas::MaterialTetrahedra cut = mesh.cut_mesh();
  const adamas::Slice slice = adamas::slice(mesh, {{0.5, 0.5, 0.5}, {0, 0, 1}}, {.field = "temperature"});
  std::printf("%zu triangles of interfaces, %zu tetrahedra of one material, iron's area %.4f\n",
              shown.triangles.size(), cut.tetrahedra.size(), slice.material_areas[0]);

  const adamas::ReconstructedInterfaces all = adamas::reconstruct(data);
  std::printf("%zu triangles of the input's interfaces\n", all.mesh.triangles.size());

  const double disc = std::numbers::pi * kRadius * kRadius;
  const bool close = std::abs(slice.material_areas[0] - disc) < 0.1 * disc;
  const bool within = report.interface_error->certified <= 0.02 && report.unreached.empty();
  return close && within && values.size() == mesh.points().size() && !cut.tetrahedra.empty() ? 0 : 1;
}
