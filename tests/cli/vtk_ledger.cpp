#include "vtk_ledger.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkTetra.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <array>
#include <cmath>

namespace adamas::test {

std::map<std::string, LedgerEntry> grid_ledger(const std::filesystem::path& vtr, const std::string& density) {
  const auto reader = vtkSmartPointer<vtkXMLRectilinearGridReader>::New();
  reader->SetFileName(vtr.c_str());
  reader->Update();
  vtkRectilinearGrid* grid = reader->GetOutput();
  vtkCellData* cells = grid->GetCellData();
  const std::string prefix = "Volume Fraction for ";
  std::map<std::string, LedgerEntry> ledger;
  for (int a = 0; a < cells->GetNumberOfArrays(); ++a) {
    const std::string name = cells->GetArrayName(a);
    if (name.rfind(prefix, 0) != 0) continue;
    const std::string material = name.substr(prefix.size());
    vtkDataArray* fraction = cells->GetArray(a);
    vtkDataArray* field = cells->GetArray((density + " for " + material).c_str());
    LedgerEntry& entry = ledger[material];
    for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
      std::array<double, 6> b{};
      grid->GetCellBounds(c, b.data());
      const double volume = (b[1] - b[0]) * (b[3] - b[2]) * (b[5] - b[4]) * fraction->GetTuple1(c);
      entry.volume += volume;
      if (field != nullptr) entry.mass += volume * field->GetTuple1(c);
    }
  }
  return ledger;
}

std::map<std::string, LedgerEntry> cut_mesh_ledger(const std::filesystem::path& vtu,
                                                   const std::string& density) {
  const auto reader = vtkSmartPointer<vtkXMLUnstructuredGridReader>::New();
  reader->SetFileName(vtu.c_str());
  reader->Update();
  vtkUnstructuredGrid* mesh = reader->GetOutput();
  auto* names = vtkStringArray::SafeDownCast(mesh->GetFieldData()->GetAbstractArray("material_names"));
  vtkDataArray* material = mesh->GetCellData()->GetArray("material");
  vtkDataArray* field = mesh->GetPointData()->GetArray(density.c_str());
  vtkDataArray* means = mesh->GetCellData()->GetArray(density.c_str());
  std::map<std::string, LedgerEntry> ledger;
  for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c) {
    vtkIdList* points = mesh->GetCell(c)->GetPointIds();
    std::array<std::array<double, 3>, 4> p{};
    double mean = means == nullptr ? 0 : means->GetTuple1(c);
    for (vtkIdType i = 0; i < 4; ++i) {
      mesh->GetPoint(points->GetId(i), p[static_cast<std::size_t>(i)].data());
      if (field != nullptr) mean += 0.25 * field->GetTuple1(points->GetId(i));
    }
    const double volume =
        std::abs(vtkTetra::ComputeVolume(p[0].data(), p[1].data(), p[2].data(), p[3].data()));
    LedgerEntry& entry = ledger[names->GetValue(static_cast<vtkIdType>(material->GetTuple1(c)))];
    entry.volume += volume;
    entry.mass += volume * mean;
  }
  return ledger;
}

}  // namespace adamas::test
