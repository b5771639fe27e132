#include "cli/volume_reading.h"

#include <utility>

namespace adamas::cli {

using namespace io;

void give_raw_options(VolumeInput& volume, InputArguments& input) {
  if (input.names_materials() && !volume.stack) input.raw = std::exchange(volume.raw, {});
}

VolumeReader open_volume_input(const VolumeInput& input, Session& session) {
  return io::open_volume_input(input, session.outputs, session.console);
}

}  // namespace adamas::cli
