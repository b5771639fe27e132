#include "tests/benchmarks/peers/volume_surfaces.h"

#include <vtkCellArray.h>
#include <vtkDecimatePro.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>

#include <algorithm>

#include "tests/benchmarks/peers/one_thread.h"
#include "tests/benchmarks/peers/vtk_samples.h"
#include "tests/benchmarks/peers/vtk_surface.h"

namespace adamas::bench {
namespace {

void give(const PeerSurface& surface, vtkPolyData& to) {
  vtkNew<vtkPoints> points;
  for (const Vec3& p : surface.points) points->InsertNextPoint(p.x, p.y, p.z);
  vtkNew<vtkCellArray> polygons;
  for (const auto& [a, b, c] : surface.triangles) polygons->InsertNextCell({a, b, c});
  to.SetPoints(points);
  to.SetPolys(polygons);
}

template <class Filter>
PeerSurface decimated(const PeerSurface& surface, std::size_t triangles, Filter& filter) {
  vtkNew<vtkPolyData> input;
  give(surface, *input);
  filter.SetInputData(input);
  const double part = static_cast<double>(triangles) / static_cast<double>(surface.triangles.size());
  filter.SetTargetReduction(std::clamp(1 - part, 0.0, 0.9999));
  filter.Update();
  return taken(*filter.GetOutput());
}

}  // namespace

PeerSurface flying_edges_of(const VolumeGrid& grid, std::span<const std::byte> samples, double isovalue,
                            int stride) {
  keep_vtk_on_one_thread();
  vtkNew<vtkImageData> image;
  const double unit = stride / grid.spacing.x;
  image->SetSpacing(unit * grid.spacing.x, unit * grid.spacing.y, unit * grid.spacing.z);
  copy_strided(samples, grid.dimensions, grid.type, stride,
               make_room(*image, grid.dimensions, grid.type, stride));
  vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInputData(image);
  edges->SetValue(0, isovalue);
  edges->ComputeNormalsOff();
  edges->ComputeGradientsOff();
  edges->ComputeScalarsOff();
  edges->Update();
  return taken(*edges->GetOutput());
}

PeerSurface quadric_decimation(const PeerSurface& surface, std::size_t triangles) {
  vtkNew<vtkQuadricDecimation> filter;
  return decimated(surface, triangles, *filter);
}

PeerSurface decimate_pro(const PeerSurface& surface, std::size_t triangles) {
  vtkNew<vtkDecimatePro> filter;
  filter->PreserveTopologyOff();
  return decimated(surface, triangles, *filter);
}

}  // namespace adamas::bench
