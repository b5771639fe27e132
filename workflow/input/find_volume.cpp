#include "workflow/input/find_volume.h"

#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/volume_input.h"

namespace adamas::workflow {

using namespace io;

namespace {

/// Returns whether a file is read as a volume although no option says so.
bool is_volume_by_itself(const std::string& path, bool grid_wanted) {
  const InputFormat* format = find_format_by_name(path);
  if (format != nullptr && format->gives_volumes() && !format->gives_grids()) return true;
  if (grid_wanted || format == nullptr || !format->several_times) return false;
  // Pictures of high dynamic range have the extension .hdr, as NIfTI's headers do.
  if (read_beginning(path).starts_with("#?")) return false;
  // A file of colours or vectors is not a volume. HDF5 has no such header; each of its data sets is a volume.
  return format->read_header == nullptr || format->read_header(path).arrays.front().source.components == 1;
}

}  // namespace

std::optional<VolumeReader> find_volume(const VolumeInput& volume, bool grid_wanted, OutputSet& outputs,
                                        Progress& progress) {
  if (volume.option().empty() && !is_volume_by_itself(volume.path, grid_wanted)) return {};
  return open_volume_input(volume, outputs, progress);
}

}  // namespace adamas::workflow
