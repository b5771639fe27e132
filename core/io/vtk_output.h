#pragma once

#include <filesystem>

class vtkXMLWriter;

namespace adamas {

/// Runs a VTK XML writer whose input is set, binary and compressed, into an OutputFile. Throws Error where it
/// is not written in full.
void write_with_vtk(const std::filesystem::path& path, vtkXMLWriter& writer);

}  // namespace adamas
