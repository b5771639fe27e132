#include "adamas/volume_output.h"

#include "core/base/notes.h"
#include "core/io/volume_writer.h"

namespace adamas {

using namespace io;

void declare_volume_output(const std::filesystem::path& output, OutputSet& outputs) {
  outputs.declare("-o", output.string(),
                  {".vti", ".nrrd", ".nhdr", ".mha", ".mhd", ".nii", ".nii.gz", ".raw"});
  outputs.declare("-o", volume_data_file(output).string());
}

void note_lost(const std::filesystem::path& output, const VolumeGrid& grid, Progress& progress) {
  if (const std::string lost = lost_places(output, grid); !lost.empty()) progress.note(NoteKind::kLoss, lost);
  if (writes_values(output, grid)) {
    note(progress,
         "{}: values, {:.9g} times the samples plus {:.9g}, are written as float32: samples with their scale "
         "are written to .nii and .nii.gz only",
         output.string(), grid.slope, grid.intercept);
  }
}

StoredType written_type(const std::filesystem::path& output, const VolumeGrid& grid, StoredType numbers) {
  return writes_values(output, grid) ? StoredType::kFloat32 : numbers;
}

std::size_t write_volume_output(const std::filesystem::path& output, const VolumeGrid& grid,
                                StoredType numbers, const std::string& array,
                                const std::function<void(const PlaneSink&)>& make, OutputSet& outputs) {
  VolumeWriterOptions options;
  options.array = array;
  options.numbers = numbers;
  const auto write = [&](const std::filesystem::path& path) {
    VolumeWriter writer(path, grid, options);
    make([&](std::span<const std::byte> samples) { writer.write_plane(samples); });
    writer.finish();
  };
  const std::string header = output.string(), data = volume_data_file(output).string();
  if (data.empty()) {
    outputs.write(header, write);
    return outputs.bytes(header);
  }
  outputs.write(header, [&](const auto& path) {
    outputs.write(data, [&](const auto& data_path) {
      options.data_file = data_path;
      options.data_name = std::filesystem::path(data).filename().string();
      write(path);
    });
  });
  return outputs.bytes(header) + outputs.bytes(data);
}

}  // namespace adamas
