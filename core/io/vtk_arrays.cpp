#include "core/io/vtk_arrays.h"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <string_view>

#include "core/base/error.h"
#include "core/io/grid_numbers.h"

namespace adamas::io {

namespace {

std::string type_name(int type, int bytes) {
  switch (type) {
    case VTK_FLOAT:
      return "float32";
    case VTK_DOUBLE:
      return "float64";
    case VTK_BIT:
      return "bit";
    case VTK_UNSIGNED_CHAR:
    case VTK_UNSIGNED_SHORT:
    case VTK_UNSIGNED_INT:
    case VTK_UNSIGNED_LONG:
    case VTK_UNSIGNED_LONG_LONG:
      return fmt::format("uint{}", 8 * bytes);
    default:
      return fmt::format("int{}", 8 * bytes);
  }
}

std::vector<std::string> component_names(vtkDataArray& source) {
  std::vector<std::string> names;
  for (int c = 0; c < source.GetNumberOfComponents(); ++c) {
    const char* name = source.HasAComponentName() ? source.GetComponentName(c) : nullptr;
    if (name == nullptr || *name == '\0') return {};
    names.emplace_back(name);
  }
  return names;
}

vtkDataSetAttributes& attributes(vtkDataSet& set, Centering centering) {
  if (centering == Centering::kCells) return *set.GetCellData();
  return *set.GetPointData();
}

/// Lists the names of all arrays of the pieces, in the order in which they come first.
std::vector<std::string> array_names(std::span<const MeshPiece> pieces, Centering centering) {
  std::vector<std::string> names;
  for (const MeshPiece& piece : pieces) {
    vtkDataSetAttributes& own = attributes(*piece.set, centering);
    for (int i = 0; i < own.GetNumberOfArrays(); ++i) {
      const char* name = own.GetAbstractArray(i)->GetName();
      if (name == nullptr || name == std::string_view("vtkGhostType")) continue;
      if (std::ranges::find(names, name) == names.end()) names.emplace_back(name);
    }
  }
  return names;
}

/// Makes an array without values of the type, the components and the name of another.
vtkSmartPointer<vtkDataArray> empty_like(vtkDataArray& own) {
  auto result = vtk::TakeSmartPointer(own.NewInstance());
  result->SetName(own.GetName());
  result->SetNumberOfComponents(own.GetNumberOfComponents());
  for (int c = 0; own.HasAComponentName() && c < own.GetNumberOfComponents(); ++c) {
    if (own.GetComponentName(c) != nullptr) result->SetComponentName(c, own.GetComponentName(c));
  }
  return result;
}

/// Joins the values of an array; null unless all pieces have it as numbers of one type.
vtkSmartPointer<vtkDataArray> joined(const std::string& file, const std::string& name,
                                     std::span<const MeshPiece> pieces, Centering centering) {
  vtkSmartPointer<vtkDataArray> result;
  for (const MeshPiece& piece : pieces) {
    vtkDataArray* own = attributes(*piece.set, centering).GetArray(name.c_str());
    if (own == nullptr) return nullptr;
    if (result == nullptr) result = empty_like(*own);
    if (own->GetDataType() != result->GetDataType() ||
        own->GetNumberOfComponents() != result->GetNumberOfComponents())
      return nullptr;
    const bool of_cells = centering == Centering::kCells;
    const vtkIdType items = of_cells ? piece.set->GetNumberOfCells() : piece.set->GetNumberOfPoints();
    if (own->GetNumberOfTuples() != items)
      fail("{}: array '{}': expected values of {} {}, found {}", file, name, items,
           of_cells ? "cells" : "points", own->GetNumberOfTuples());
    for (const vtkIdType i : of_cells ? piece.cells : piece.points) result->InsertNextTuple(i, own);
  }
  return result;
}

}  // namespace

void add_arrays_of(const std::string& name, std::span<const MeshPiece> pieces, MeshFile& file) {
  for (const Centering centering : {Centering::kCells, Centering::kPoints}) {
    for (const std::string& array : array_names(pieces, centering)) {
      const auto values = joined(name, array, pieces, centering);
      if (values != nullptr) {
        file.arrays.push_back(grid_array(*values, centering));
      } else {
        file.add_remark(
            fmt::format("array '{}' is not read: not all blocks have it as numbers of one type", array));
      }
    }
  }
  auto* names =
      vtkStringArray::SafeDownCast(pieces[0].set->GetFieldData()->GetAbstractArray("material_names"));
  for (vtkIdType i = 0; names != nullptr && i < names->GetNumberOfValues(); ++i)
    file.material_names.push_back(names->GetValue(i));
}

GridArray grid_array(vtkDataArray& source, Centering centering) {
  GridArray array;
  array.name = source.GetName() != nullptr ? source.GetName() : "";
  array.type = type_name(source.GetDataType(), source.GetDataTypeSize());
  array.centering = centering;
  array.components = source.GetNumberOfComponents();
  array.component_names = component_names(source);
  const auto count = static_cast<std::size_t>(source.GetNumberOfValues());
  if (source.GetDataType() == VTK_BIT || !source.HasStandardMemoryLayout()) {
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto components = static_cast<std::size_t>(array.components);
      values[i] =
          source.GetComponent(static_cast<vtkIdType>(i / components), static_cast<int>(i % components));
    }
    set_numbers(std::span<const double>(values), array);
    return array;
  }
  switch (source.GetDataType()) {
    vtkTemplateMacro(
        set_numbers(std::span(static_cast<const VTK_TT*>(source.GetVoidPointer(0)), count), array));
    default:
      fail("array '{}': expected numbers, found {}", array.name, source.GetDataTypeAsString());
  }
  return array;
}

}  // namespace adamas::io
