#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkDoubleArray.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkYoungsMaterialInterface.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/geometry/tetrahedron.h"
#include "tests/benchmarks/peers/material_surfaces.h"
#include "tests/benchmarks/peers/one_thread.h"
#include "tests/benchmarks/support/measurement.h"

namespace adamas::bench {
namespace {

using Array = vtkSmartPointer<vtkDoubleArray>;

Array make_array(const std::string& name, std::size_t size) {
  auto array = Array::New();
  array->SetName(name.c_str());
  array->SetNumberOfTuples(static_cast<vtkIdType>(size));
  return array;
}

/// Returns the negative gradient of a material's fractions at a cell: differences along each axis of means
/// over nine cells, weighted 1, 2, 1 along each of the other two. At the border the nearest existing cells
/// are used.
Vec3 normal_at(const MultiMaterialData& data, MaterialId m, const std::array<std::size_t, 3>& cell) {
  const RectilinearGrid& grid = data.grid;
  const auto at = [&](std::size_t axis, int step) {
    const auto moved = static_cast<std::ptrdiff_t>(cell[axis]) + step;
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
        moved, 0, static_cast<std::ptrdiff_t>(grid.sites(static_cast<int>(axis))) - 1));
  };
  Vec3 normal;
  for (int k = -1; k <= 1; ++k) {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        const double f = data.fraction(m, grid.site_index(at(0, i), at(1, j), at(2, k)));
        const auto weight = [](int step) { return step == 0 ? 2.0 : 1.0; };
        normal += f * Vec3{i * weight(j) * weight(k), j * weight(i) * weight(k), k * weight(i) * weight(j)};
      }
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double span = grid.site_coordinate(axis, at(a, 1)) - grid.site_coordinate(axis, at(a, -1));
    normal[axis] /= -16 * span;
  }
  return normal;
}

vtkSmartPointer<vtkRectilinearGrid> make_grid(const MultiMaterialData& data) {
  auto result = vtkSmartPointer<vtkRectilinearGrid>::New();
  const auto& nodes = data.grid.nodes;
  result->SetDimensions(static_cast<int>(nodes[0].size()), static_cast<int>(nodes[1].size()),
                        static_cast<int>(nodes[2].size()));
  std::array<Array, 3> axes;
  for (std::size_t a = 0; a < 3; ++a) {
    axes[a] = make_array("", nodes[a].size());
    std::copy(nodes[a].begin(), nodes[a].end(), axes[a]->GetPointer(0));
  }
  result->SetXCoordinates(axes[0]);
  result->SetYCoordinates(axes[1]);
  result->SetZCoordinates(axes[2]);
  const std::size_t cells = data.grid.site_count(), nx = data.grid.sites(0), ny = data.grid.sites(1);
  for (MaterialId m(0); m.value < data.materials.size(); ++m.value) {
    const std::string number = std::to_string(m.value);
    const Array fraction = make_array("f" + number, cells), x = make_array("x" + number, cells),
                y = make_array("y" + number, cells), z = make_array("z" + number, cells);
    for (std::size_t c = 0; c < cells; ++c) {
      const auto id = static_cast<vtkIdType>(c);
      fraction->SetValue(id, data.fraction(m, c));
      const Vec3 normal = normal_at(data, m, {c % nx, c / nx % ny, c / nx / ny});
      x->SetValue(id, normal.x);
      y->SetValue(id, normal.y);
      z->SetValue(id, normal.z);
    }
    for (const Array& array : {fraction, x, y, z}) result->GetCellData()->AddArray(array);
  }
  return result;
}

vtkSmartPointer<vtkYoungsMaterialInterface> run_filter(vtkRectilinearGrid& grid, std::size_t materials,
                                                       bool fill) {
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  blocks->SetBlock(0, &grid);
  auto filter = vtkSmartPointer<vtkYoungsMaterialInterface>::New();
  filter->SetInputData(blocks);
  filter->SetNumberOfMaterials(static_cast<int>(materials));
  for (std::size_t m = 0; m < materials; ++m) {
    const std::string number = std::to_string(m);
    filter->SetMaterialArrays(static_cast<int>(m), ("f" + number).c_str(), ("x" + number).c_str(),
                              ("y" + number).c_str(), ("z" + number).c_str(), "");
  }
  filter->UseAllBlocksOn();
  filter->SetFillMaterial(fill ? 1 : 0);
  filter->SetVolumeFractionRange(1e-6, 1 - 1e-6);
  filter->Update();
  return filter;
}

/// Calls visit(material, cells) for the cells that the filter has made of each material.
template <class Visit>
void for_each_block(vtkYoungsMaterialInterface& filter, std::size_t materials, Visit&& visit) {
  auto* output = vtkMultiBlockDataSet::SafeDownCast(filter.GetOutputDataObject(0));
  for (unsigned m = 0; m < materials && m < output->GetNumberOfBlocks(); ++m) {
    auto* block = vtkMultiBlockDataSet::SafeDownCast(output->GetBlock(m));
    for (unsigned d = 0; block != nullptr && d < block->GetNumberOfBlocks(); ++d) {
      if (auto* cells = vtkUnstructuredGrid::SafeDownCast(block->GetBlock(d))) visit(m, *cells);
    }
  }
}

void add_polygons(vtkUnstructuredGrid& cells, MaterialSurfaces& result) {
  const auto first = static_cast<std::uint32_t>(result.points.size());
  for (vtkIdType p = 0; p < cells.GetNumberOfPoints(); ++p) {
    const double* x = cells.GetPoint(p);
    result.points.push_back({x[0], x[1], x[2]});
  }
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < cells.GetNumberOfCells(); ++c) {
    cells.GetCellPoints(c, corners);
    const auto corner = [&](vtkIdType n) { return first + static_cast<std::uint32_t>(corners->GetId(n)); };
    for (vtkIdType n = 1; n + 1 < corners->GetNumberOfIds(); ++n)
      result.triangles.push_back({corner(0), corner(n), corner(n + 1)});
  }
}

/// Adds each piece's volume to the cell that its middle lies in.
void add_volumes(const RectilinearGrid& grid, vtkUnstructuredGrid& pieces, std::vector<double>& fractions) {
  vtkNew<vtkGenericCell> piece;
  vtkNew<vtkIdList> ids;
  vtkNew<vtkPoints> points;
  for (vtkIdType c = 0; c < pieces.GetNumberOfCells(); ++c) {
    pieces.GetCell(c, piece);
    if (piece->GetCellDimension() < 3) continue;
    piece->Triangulate(0, ids, points);
    double volume = 0;
    Vec3 middle;
    const auto place = [&](vtkIdType n) {
      const double* x = points->GetPoint(n);
      return Vec3{x[0], x[1], x[2]};
    };
    for (vtkIdType n = 0; n + 3 < points->GetNumberOfPoints(); n += 4) {
      const double v = std::abs(signed_volume(place(n), place(n + 1), place(n + 2), place(n + 3)));
      volume += v;
      middle += 0.25 * v * (place(n) + place(n + 1) + place(n + 2) + place(n + 3));
    }
    if (!(volume > 0)) continue;
    std::array<std::size_t, 3> at{};
    double whole = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const auto& nodes = grid.nodes[a];
      const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, middle[axis] / volume);
      at[a] = static_cast<std::size_t>(above - nodes.begin()) - 1;
      whole *= nodes[at[a] + 1] - nodes[at[a]];
    }
    fractions[grid.site_index(at[0], at[1], at[2])] += volume / whole;
  }
}

}  // namespace

MaterialSurfaces youngs_interfaces(const MultiMaterialData& data) {
  keep_vtk_on_one_thread();
  MaterialSurfaces result;
  const std::size_t materials = data.materials.size();
  const double start = thread_seconds();
  const auto grid = make_grid(data);
  const auto surfaces = run_filter(*grid, materials, false);
  result.seconds = thread_seconds() - start;
  for_each_block(*surfaces, materials,
                 [&](unsigned, vtkUnstructuredGrid& cells) { add_polygons(cells, result); });
  const auto filled = run_filter(*grid, materials, true);
  result.fractions.assign(materials, std::vector<double>(data.grid.site_count(), 0.0));
  for_each_block(*filled, materials, [&](unsigned m, vtkUnstructuredGrid& cells) {
    add_volumes(data.grid, cells, result.fractions[m]);
  });
  return result;
}

}  // namespace adamas::bench
