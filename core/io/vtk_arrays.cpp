#include "core/io/vtk_arrays.h"

#include <fmt/format.h>
#include <vtkDataArray.h>

#include <span>

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

}  // namespace

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
