#pragma once

#include <vtkAbstractArray.h>
#include <vtkSmartPointer.h>

#include <filesystem>
#include <memory>
#include <string>

#include "core/data/unstructured_mesh.h"

class vtkXMLWriter;
namespace adamas::io {

/// While it lives, VTK's errors and warnings of the whole process are kept here instead of printed, and it
/// starts no threads.
class VtkMessages {
 public:
  VtkMessages();
  ~VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

  /// Throws Error, as one line that begins with `name`, if there has been any message.
  void check(const std::string& name) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A NamedArray as VTK's XML writers want it (xml_attribute), and as its readers give it; values bit for bit.
vtkSmartPointer<vtkAbstractArray> to_vtk(const NamedArray& array);
NamedArray from_vtk(vtkAbstractArray& array);

/// Runs a VTK XML writer whose input is set, binary and compressed, into an OutputFile. Throws Error where it
/// is not written in full.
void write_with_vtk(const std::filesystem::path& path, vtkXMLWriter& writer);

}  // namespace adamas::io
