#include "core/io/volume_series.h"

#include "core/io/input_formats.h"

namespace adamas::io {

VolumeSeries find_volume_series(const std::filesystem::path& path, const std::string& array) {
  const InputFormat* format = find_input_format(path);
  if (format == nullptr || format->find_series == nullptr) return {};
  return format->find_series(path, array);
}

}  // namespace adamas::io
