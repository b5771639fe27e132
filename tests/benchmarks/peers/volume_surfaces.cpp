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
#include <cstring>

#include "tests/benchmarks/peers/one_thread.h"
#include "tests/benchmarks/peers/vtk_surface.h"

namespace adamas::bench {
namespace {

int vtk_type(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return VTK_UNSIGNED_CHAR;
    case SampleType::kUint16:
      return VTK_UNSIGNED_SHORT;
    case SampleType::kInt16:
      return VTK_SHORT;
    case SampleType::kFloat32:
      break;
  }
  return VTK_FLOAT;
}

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
  const auto step = static_cast<std::uint64_t>(stride);
  std::array<std::uint64_t, 3> count{};
  for (std::size_t axis = 0; axis < 3; ++axis) count[axis] = (grid.dimensions[axis] - 1) / step + 1;
  vtkNew<vtkImageData> image;
  image->SetDimensions(static_cast<int>(count[0]), static_cast<int>(count[1]), static_cast<int>(count[2]));
  const double unit = stride / grid.spacing.x;
  image->SetSpacing(unit * grid.spacing.x, unit * grid.spacing.y, unit * grid.spacing.z);
  image->AllocateScalars(vtk_type(grid.type), 1);
  auto* to = static_cast<std::byte*>(image->GetScalarPointer());
  const std::size_t size = static_cast<std::size_t>(grid.bytes() / grid.samples());
  for (std::uint64_t k = 0; k < count[2]; ++k) {
    for (std::uint64_t j = 0; j < count[1]; ++j) {
      for (std::uint64_t i = 0; i < count[0]; ++i, to += size) {
        const std::uint64_t at = step * (i + grid.dimensions[0] * (j + grid.dimensions[1] * k));
        std::memcpy(to, samples.data() + size * at, size);
      }
    }
  }
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
