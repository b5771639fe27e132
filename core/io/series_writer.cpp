#include "core/io/series_writer.h"

#include <fmt/format.h>

#include "core/io/output_stream.h"
#include "core/io/xml_file.h"

namespace adamas {

void write_series(const std::filesystem::path& path, const std::vector<SeriesEntry>& entries) {
  OutputStream stream(path);
  stream.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n");
  for (const SeriesEntry& entry : entries) {
    stream.write(fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", entry.time,
                             xml_attribute(entry.file)));
  }
  stream.write("  </Collection>\n</VTKFile>\n");
  stream.finish();
}

}  // namespace adamas
