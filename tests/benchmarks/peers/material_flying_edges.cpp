#include <vtkCellArray.h>
#include <vtkDiscreteFlyingEdges3D.h>
#include <vtkFlyingEdges3D.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkWindowedSincPolyDataFilter.h>

#include <algorithm>
#include <cmath>

#include "tests/benchmarks/peers/material_surfaces.h"
#include "tests/benchmarks/peers/one_thread.h"
#include "tests/benchmarks/support/measurement.h"

namespace adamas::bench {
namespace {

/// The number of layers of cells that are added all round. One layer copies the cells at the border, so that
/// surfaces reach the border; the other has no material, so that they are closed.
constexpr int kPadding = 2;
/// The number of rays along x through a cell, along either of the other axes.
constexpr int kRays = 6;
/// The pass band of VTK's examples for labels.
constexpr double kPassBand = 0.01;

/// Fills an image with the numbers of the padded grid, in units of cells: cell i has its centre at i + 1/2.
/// Cells without material have the number 0.
template <class Number, class OfSite>
void fill(const RectilinearGrid& grid, int type, const OfSite& of_site, vtkImageData& image) {
  const std::array<int, 3> n{static_cast<int>(grid.sites(0)), static_cast<int>(grid.sites(1)),
                             static_cast<int>(grid.sites(2))};
  image.SetDimensions(n[0] + 2 * kPadding, n[1] + 2 * kPadding, n[2] + 2 * kPadding);
  image.SetOrigin(0.5 - kPadding, 0.5 - kPadding, 0.5 - kPadding);
  image.AllocateScalars(type, 1);
  auto* to = static_cast<Number*>(image.GetScalarPointer());
  for (int k = -kPadding; k < n[2] + kPadding; ++k) {
    for (int j = -kPadding; j < n[1] + kPadding; ++j) {
      for (int i = -kPadding; i < n[0] + kPadding; ++i) {
        const std::array<int, 3> at{i, j, k};
        std::array<std::size_t, 3> nearest{};
        bool outside = false;
        for (std::size_t a = 0; a < 3; ++a) {
          nearest[a] = static_cast<std::size_t>(std::clamp(at[a], 0, n[a] - 1));
          outside = outside || at[a] < 1 - kPadding || at[a] > n[a] - 2 + kPadding;
        }
        const Number number = of_site(grid.site_index(nearest[0], nearest[1], nearest[2]));
        *to++ = outside ? Number{0} : number;
      }
    }
  }
}

/// Converts from units of cells to places: linear between nodes, and beyond them.
double place_on(const std::vector<double>& nodes, double x) {
  const double last = static_cast<double>(nodes.size()) - 2;
  const double cell = std::clamp(std::floor(x), 0.0, last);
  const auto c = static_cast<std::size_t>(cell);
  return nodes[c] + (x - cell) * (nodes[c + 1] - nodes[c]);
}

/// The lengths of rays inside closed surfaces, gathered by cell, in units of cells.
class RayVolumes {
 public:
  explicit RayVolumes(const RectilinearGrid& grid)
      : grid_(grid), crossings_(grid.sites(1) * grid.sites(2) * kRays * kRays) {}

  /// Adds the crossings of a triangle with the rays.
  void add(const std::array<Vec3, 3>& t) {
    const double low_y = std::min({t[0].y, t[1].y, t[2].y}), high_y = std::max({t[0].y, t[1].y, t[2].y});
    const double low_z = std::min({t[0].z, t[1].z, t[2].z}), high_z = std::max({t[0].z, t[1].z, t[2].z});
    const auto ny = static_cast<long>(grid_.sites(1)) * kRays, nz = static_cast<long>(grid_.sites(2)) * kRays;
    const double area = (t[1].y - t[0].y) * (t[2].z - t[0].z) - (t[2].y - t[0].y) * (t[1].z - t[0].z);
    if (area == 0) return;
    for (long k = std::max(0L, first(low_z)); k < nz && place(k, kShiftZ) <= high_z; ++k) {
      for (long j = std::max(0L, first(low_y)); j < ny && place(j, kShiftY) <= high_y; ++j) {
        const double y = place(j, kShiftY), z = place(k, kShiftZ);
        std::array<double, 3> w{};
        bool inside = true;
        for (std::size_t i = 0; i < 3; ++i) {
          const Vec3 &p = t[(i + 1) % 3], &q = t[(i + 2) % 3];
          w[i] = ((p.y - y) * (q.z - z) - (q.y - y) * (p.z - z)) / area;
          inside = inside && w[i] >= 0;
        }
        if (inside)
          crossings_[static_cast<std::size_t>(j + ny * k)].push_back(w[0] * t[0].x + w[1] * t[1].x +
                                                                     w[2] * t[2].x);
      }
    }
  }

  /// Returns the parts of the cells between odd and even crossings.
  [[nodiscard]] std::vector<double> fractions() {
    std::vector<double> result(grid_.site_count(), 0.0);
    const std::size_t ny = grid_.sites(1) * kRays, nx = grid_.sites(0);
    for (std::size_t ray = 0; ray < crossings_.size(); ++ray) {
      auto& x = crossings_[ray];
      std::sort(x.begin(), x.end());
      const std::size_t j = ray % ny / kRays, k = ray / ny / kRays;
      for (std::size_t c = 0; c + 1 < x.size(); c += 2) {
        for (std::size_t i = 0; i < nx; ++i) {
          const double low = std::max(x[c], static_cast<double>(i));
          const double high = std::min(x[c + 1], static_cast<double>(i) + 1);
          if (high > low) result[grid_.site_index(i, j, k)] += (high - low) / (kRays * kRays);
        }
      }
    }
    return result;
  }

 private:
  // The shifts keep rays away from edges of surfaces between centres of cells, also from diagonal ones.
  static constexpr double kShiftY = 1.3e-4, kShiftZ = 4.7e-4;
  [[nodiscard]] static double place(long ray, double shift) {
    return (static_cast<double>(ray) + 0.5 + shift) / kRays;
  }
  [[nodiscard]] static long first(double at) { return static_cast<long>(std::floor(at * kRays)) - 1; }

  const RectilinearGrid& grid_;
  std::vector<std::vector<double>> crossings_;
};

/// Adds a material's surface, in units of cells, and the part of each cell that it leaves to the material.
void add(vtkPolyData& found, const MultiMaterialData& data, MaterialSurfaces& result) {
  const auto first = static_cast<std::uint32_t>(result.points.size());
  std::vector<Vec3> in_cells;
  for (vtkIdType p = 0; p < found.GetNumberOfPoints(); ++p) {
    const double* x = found.GetPoint(p);
    in_cells.push_back({x[0], x[1], x[2]});
    result.points.push_back({place_on(data.grid.nodes[0], x[0]), place_on(data.grid.nodes[1], x[1]),
                             place_on(data.grid.nodes[2], x[2])});
  }
  RayVolumes volumes(data.grid);
  vtkNew<vtkIdList> corners;
  vtkCellArray& polygons = *found.GetPolys();
  for (polygons.InitTraversal(); polygons.GetNextCell(corners) != 0;) {
    const auto corner = [&](vtkIdType n) { return static_cast<std::uint32_t>(corners->GetId(n)); };
    volumes.add({in_cells[corner(0)], in_cells[corner(1)], in_cells[corner(2)]});
    result.triangles.push_back({first + corner(0), first + corner(1), first + corner(2)});
  }
  result.fractions.push_back(volumes.fractions());
}

/// Returns the smoothed surfaces, which belong to the filter.
vtkPolyData* smoothed(vtkPolyData& surfaces, int iterations, vtkWindowedSincPolyDataFilter& filter) {
  filter.SetInputData(&surfaces);
  filter.SetNumberOfIterations(iterations);
  filter.SetPassBand(kPassBand);
  filter.BoundarySmoothingOff();
  filter.FeatureEdgeSmoothingOff();
  filter.NonManifoldSmoothingOn();
  filter.NormalizeCoordinatesOn();
  filter.Update();
  return filter.GetOutput();
}

}  // namespace

std::vector<std::uint16_t> greatest_material(const MultiMaterialData& data) {
  std::vector<std::uint16_t> result(data.grid.site_count());
  for (std::size_t cell = 0; cell < result.size(); ++cell) {
    MaterialId best(0);
    for (MaterialId m(1); m.value < data.materials.size(); ++m.value) {
      if (data.fraction(m, cell) > data.fraction(best, cell)) best = m;
    }
    result[cell] = static_cast<std::uint16_t>(best.value);
  }
  return result;
}

LabelSurfaceCost label_flying_edges(const MultiMaterialData& data) {
  keep_vtk_on_one_thread();
  constexpr int kIterations = 20;
  vtkNew<vtkImageData> labels;
  fill<short>(
      data.grid, VTK_SHORT, [&](std::size_t site) { return static_cast<short>(data.labels[site] + 1); },
      *labels);
  const double start = thread_seconds();
  vtkNew<vtkDiscreteFlyingEdges3D> edges;
  edges->SetInputData(labels);
  for (std::size_t m = 0; m < data.materials.size(); ++m)
    edges->SetValue(static_cast<int>(m), static_cast<double>(m) + 1);
  edges->ComputeNormalsOff();
  edges->ComputeGradientsOff();
  edges->Update();
  LabelSurfaceCost cost;
  cost.seconds = thread_seconds() - start;
  vtkNew<vtkWindowedSincPolyDataFilter> smoother;
  smoothed(*edges->GetOutput(), kIterations, *smoother);
  cost.smoothed_seconds = thread_seconds() - start;
  cost.triangles = static_cast<std::uint64_t>(edges->GetOutput()->GetNumberOfPolys());
  return cost;
}

MaterialSurfaces discrete_flying_edges(const MultiMaterialData& data, int smoothing_iterations) {
  keep_vtk_on_one_thread();
  const std::vector<std::uint16_t> greatest = greatest_material(data);
  vtkNew<vtkImageData> labels;
  fill<short>(
      data.grid, VTK_SHORT, [&](std::size_t site) { return static_cast<short>(greatest[site] + 1); },
      *labels);
  MaterialSurfaces result;
  for (std::size_t m = 0; m < data.materials.size(); ++m) {
    const double start = thread_seconds();
    vtkNew<vtkDiscreteFlyingEdges3D> edges;
    edges->SetInputData(labels);
    edges->SetValue(0, static_cast<double>(m) + 1);
    edges->ComputeNormalsOff();
    edges->ComputeGradientsOff();
    edges->Update();
    vtkPolyData* found = edges->GetOutput();
    vtkNew<vtkWindowedSincPolyDataFilter> smoother;
    if (smoothing_iterations > 0) found = smoothed(*found, smoothing_iterations, *smoother);
    result.seconds += thread_seconds() - start;
    add(*found, data, result);
  }
  return result;
}

MaterialSurfaces fraction_contours(const MultiMaterialData& data) {
  keep_vtk_on_one_thread();
  MaterialSurfaces result;
  for (MaterialId m(0); m.value < data.materials.size(); ++m.value) {
    vtkNew<vtkImageData> fractions;
    fill<float>(
        data.grid, VTK_FLOAT, [&](std::size_t site) { return data.fraction(m, site); }, *fractions);
    const double start = thread_seconds();
    vtkNew<vtkFlyingEdges3D> edges;
    edges->SetInputData(fractions);
    edges->SetValue(0, 0.5);
    edges->ComputeNormalsOff();
    edges->ComputeGradientsOff();
    edges->Update();
    result.seconds += thread_seconds() - start;
    add(*edges->GetOutput(), data, result);
  }
  return result;
}

}  // namespace adamas::bench
