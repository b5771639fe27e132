#include "workflow/input/find_volume.h"

#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/volume_input.h"

namespace adamas::workflow {

using namespace io;

namespace {

/// Whether a file is read as a volume although no option says so.
bool is_volume_by_itself(const std::string& path, bool grid_wanted) {
  const InputFormat* format = find_format_by_name(path);
  if (format != nullptr && format->gives_volumes() && !format->gives_grids()) return true;
  if (grid_wanted || format == nullptr || !format->several_times) return false;
  // The names of pictures of high dynamic range end in .hdr as well as those of NIfTI's headers.
  if (read_beginning(path).starts_with("#?")) return false;
  // A file of colours or vectors is not a volume; data sets of HDF5 have no such header, and are one each.
  return format->read_header == nullptr || format->read_header(path).arrays.front().source.components == 1;
}

}  // namespace

std::optional<VolumeReader> find_volume(const VolumeInput& volume, bool grid_wanted, OutputSet& outputs,
                                        Progress& progress) {
  if (volume.option().empty() && !is_volume_by_itself(volume.path, grid_wanted)) return {};
  return open_volume_input(volume, outputs, progress);
}

}  // namespace adamas::workflow
