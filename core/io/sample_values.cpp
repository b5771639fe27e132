#include "core/io/sample_values.h"

#include <cstring>

#include "core/io/stored_type.h"

namespace adamas::io {

void find_values(const VolumeGrid& grid, std::span<const std::byte> samples, std::vector<float>& values) {
  visit_stored_type(stored_type(grid.type), [&]<class Sample>(Sample) {
    values.resize(samples.size() / sizeof(Sample));
    for (std::size_t n = 0; n < values.size(); ++n) {
      Sample sample;
      std::memcpy(&sample, samples.data() + n * sizeof(Sample), sizeof(Sample));
      values[n] = static_cast<float>(grid.value(static_cast<double>(sample)));
    }
  });
}

}  // namespace adamas::io
