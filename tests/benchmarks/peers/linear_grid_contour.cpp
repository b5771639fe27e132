#include "tests/benchmarks/peers/linear_grid_contour.h"

#include <vtkContour3DLinearGrid.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <stdexcept>

#include "tests/benchmarks/peers/one_thread.h"

namespace adamas::bench {

struct LinearGridContour::Grid {
  vtkNew<vtkUnstructuredGrid> cells;
};

LinearGridContour::LinearGridContour(const std::vector<Vec3>& points, const std::vector<float>& values,
                                     const std::vector<Tetrahedron>& tetrahedra)
    : grid_(std::make_unique<Grid>()) {
  keep_vtk_on_one_thread();
  vtkNew<vtkPoints> places;
  places->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
  vtkNew<vtkFloatArray> scalars;
  scalars->SetNumberOfTuples(static_cast<vtkIdType>(points.size()));
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto at = static_cast<vtkIdType>(p);
    places->SetPoint(at, points[p].x, points[p].y, points[p].z);
    scalars->SetValue(at, values[p]);
  }
  vtkUnstructuredGrid& cells = *grid_->cells;
  cells.SetPoints(places);
  cells.GetPointData()->SetScalars(scalars);
  cells.AllocateExact(static_cast<vtkIdType>(tetrahedra.size()),
                      static_cast<vtkIdType>(4 * tetrahedra.size()));
  for (const Tetrahedron& t : tetrahedra) {
    const std::array<vtkIdType, 4> corners{t[0], t[1], t[2], t[3]};
    cells.InsertNextCell(VTK_TETRA, 4, corners.data());
  }
}

LinearGridContour::~LinearGridContour() = default;

LinearGridContour::Size LinearGridContour::contour(double isovalue, bool shared, bool normals) {
  vtkNew<vtkContour3DLinearGrid> filter;
  filter->SetInputData(grid_->cells);
  filter->SetValue(0, isovalue);
  filter->SetMergePoints(shared);
  filter->SequentialProcessingOn();
  filter->InterpolateAttributesOff();
  filter->SetComputeNormals(normals);
  filter->Update();
  vtkPolyData* found = vtkPolyData::SafeDownCast(filter->GetOutput());
  if (found == nullptr) throw std::runtime_error("vtkContour3DLinearGrid: no triangles");
  return {static_cast<std::uint64_t>(found->GetNumberOfPolys()),
          static_cast<std::uint64_t>(found->GetNumberOfPoints())};
}

}  // namespace adamas::bench
