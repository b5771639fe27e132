#pragma once

#include <vtkAbstractArray.h>
#include <vtkDataObject.h>
#include <vtkSmartPointer.h>

#include <filesystem>
#include <memory>
#include <string>

#include "core/base/error.h"
#include "core/data/unstructured_mesh.h"

class vtkXMLWriter;
namespace adamas::io {

/// Collects VTK's errors and warnings of the whole process, while it lives, instead of having them printed.
/// VTK must start no threads meanwhile.
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

/// Converts a NamedArray for VTK's XML writers (xml_attribute), and one from its readers; values stay the
/// same bit for bit.
vtkSmartPointer<vtkAbstractArray> to_vtk(const NamedArray& array);
NamedArray from_vtk(vtkAbstractArray& array);

/// Reads a file with a reader of VTK. Throws Error, named after the file, if it is not read in full.
template <class Reader>
vtkSmartPointer<vtkDataObject> read_with_vtk(Reader& reader, const std::string& name,
                                             const VtkMessages& messages) {
  reader.SetFileName(name.c_str());
  reader.Update();
  messages.check(name);
  if (reader.GetErrorCode() != 0) fail("{}: expected a whole file, found a corrupt one", name);
  return reader.GetOutputDataObject(0);
}

/// Reads a file with a reader of this class, which has to know it as its own. `kind`: the format, for
/// messages.
template <class Reader>
vtkSmartPointer<vtkDataObject> read_if_readable(const std::string& name, const std::string& kind,
                                                const VtkMessages& messages) {
  const auto reader = vtkSmartPointer<Reader>::New();
  if (reader->CanReadFile(name.c_str()) == 0) fail("{}: expected {}, found something else", name, kind);
  return read_with_vtk(*reader, name, messages);
}

/// Reads a legacy VTK file with all its arrays. Throws Error, named after the file, if it is not read in
/// full.
vtkSmartPointer<vtkDataObject> read_legacy_vtk(const std::string& name, const VtkMessages& messages);

/// Runs a VTK XML writer whose input is set, binary and compressed, into an OutputFile. Throws Error if the
/// file is not written in full.
void write_with_vtk(const std::filesystem::path& path, vtkXMLWriter& writer);

}  // namespace adamas::io
