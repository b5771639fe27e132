#include "core/io/vtk_output.h"

#include <vtkXMLWriter.h>

#include "core/base/error.h"
#include "core/io/output_stream.h"
#include "core/io/vtk_messages.h"

namespace adamas {

void write_with_vtk(const std::filesystem::path& path, vtkXMLWriter& writer) {
  const VtkMessages messages;
  writer.SetDataModeToAppended();
  writer.EncodeAppendedDataOff();
  writer.SetCompressorTypeToZLib();
  writer.SetHeaderTypeToUInt64();
  // VTK does not report every short write, so the bytes go to the file here.
  writer.WriteToOutputStringOn();
  OutputStream out(path);
  const int written = writer.Write();
  messages.check(path.string());
  if (written == 0) fail("{}: could not be written", path.string());
  const std::string bytes = writer.GetOutputString();
  out.write(bytes);
  out.finish();
}

}  // namespace adamas
