#include "tests/benchmarks/peers/volume_surfaces.h"

#include <vtkCellArray.h>
#include <vtkDecimatePro.h>
#include <vtkFlyingEdges3D.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>

#include <algorithm>
#include <cstring>

#include "tests/benchmarks/peers/one_thread.h"

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

PeerSurface taken(vtkPolyData& found) {
  PeerSurface result;
  for (vtkIdType p = 0; p < found.GetNumberOfPoints(); ++p) {
    const double* x = found.GetPoint(p);
    result.points.push_back({x[0], x[1], x[2]});
  }
  vtkNew<vtkIdList> corners;
  vtkCellArray& polygons = *found.GetPolys();
  for (polygons.InitTraversal(); polygons.GetNextCell(corners) != 0;) {
    const auto corner = [&](vtkIdType n) { return static_cast<std::uint32_t>(corners->GetId(n)); };
    result.triangles.push_back({corner(0), corner(1), corner(2)});
  }
  return result;
}

void give(const PeerSurface& surface, vtkPolyData& to) {
  vtkNew<vtkPoints> points;
  for (const Vec3& p : surface.points) points->InsertNextPoint(p.x, p.y, p.z);
  vtkNew<vtkCellArray> polygons;
  for (const auto& [a, b, c] : surface.triangles) polygons->InsertNextCell({a, b, c});
  to.SetPoints(points);
  to.SetPolys(polygons);
}

double reduction(const PeerSurface& surface, std::size_t triangles) {
  const double part = static_cast<double>(triangles) / static_cast<double>(surface.triangles.size());
  return std::clamp(1 - part, 0.0, 0.9999);
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
  vtkNew<vtkPolyData> input;
  give(surface, *input);
  vtkNew<vtkQuadricDecimation> filter;
  filter->SetInputData(input);
  filter->SetTargetReduction(reduction(surface, triangles));
  filter->Update();
  return taken(*filter->GetOutput());
}

PeerSurface decimate_pro(const PeerSurface& surface, std::size_t triangles) {
  vtkNew<vtkPolyData> input;
  give(surface, *input);
  vtkNew<vtkDecimatePro> filter;
  filter->SetInputData(input);
  filter->SetTargetReduction(reduction(surface, triangles));
  filter->PreserveTopologyOff();
  filter->Update();
  return taken(*filter->GetOutput());
}

}  // namespace adamas::bench
