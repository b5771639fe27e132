#pragma once

#include <vtkCellArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include "tests/benchmarks/peers/flying_edges.h"

namespace adamas::bench {

/// Returns the triangles that a filter of VTK has made.
inline PeerSurface taken(vtkPolyData& found) {
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

}  // namespace adamas::bench
