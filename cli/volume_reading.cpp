#include "cli/volume_reading.h"

#include <utility>

#include "core/io/input_file.h"
#include "core/io/input_formats.h"

namespace adamas::cli {

using namespace io;

void give_raw_options(VolumeInput& volume, InputArguments& input) {
  if (input.names_materials() && !volume.stack) input.raw = std::exchange(volume.raw, {});
}

VolumeReader open_volume_input(const VolumeInput& input, Session& session) {
  return io::open_volume_input(input, session.outputs, session.console);
}

std::optional<VolumeReader> find_volume(const InputArguments& input, VolumeInput volume, Session& session) {
  const InputFormat* format = find_format_by_name(input.path);
  volume.path = input.path;
  const bool no_grid = format != nullptr && format->gives_volumes() && !format->gives_grids();
  if (!volume.option().empty() || no_grid) return open_volume_input(volume, session);
  if (!input.grid_option().empty() || format == nullptr || !format->several_times) return {};
  // The names of pictures of high dynamic range end in .hdr as well as those of NIfTI's headers.
  if (read_beginning(input.path).starts_with("#?")) return {};
  // A file of colours or vectors is not a volume; data sets of HDF5 have no such header, and are one each.
  if (format->read_header != nullptr && format->read_header(input.path).arrays.front().source.components != 1)
    return {};
  return open_volume_input(volume, session);
}

}  // namespace adamas::cli
