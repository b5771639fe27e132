#include "cli/volume_output.h"

#include <filesystem>

#include "core/io/volume_writer.h"

namespace adamas {

void add_volume_output(const Command& command, std::string& output) {
  command
      .add_option(
          "-o,--output", output,
          "The volume: .vti, .nrrd, .mha, .nii, .nii.gz, .nhdr or .mhd with a .raw beside it, or .raw alone")
      .required()
      .type_name("FILE");
}

void declare_volume_output(const std::string& output, OutputSet& outputs) {
  outputs.declare("-o", output, {".vti", ".nrrd", ".nhdr", ".mha", ".mhd", ".nii", ".nii.gz", ".raw"});
  outputs.declare("-o", volume_data_file(output).string());
}

std::size_t write_volume_output(const std::string& output, const VolumeGrid& grid, const std::string& array,
                                const std::function<void(const PlaneSink&)>& make, Session& session) {
  OutputSet& outputs = session.outputs;
  VolumeWriterOptions options;
  options.array = array;
  const auto write = [&](const std::filesystem::path& path) {
    VolumeWriter writer(path, grid, options);
    make([&](std::span<const std::byte> samples) { writer.write_plane(samples); });
    writer.finish();
  };
  if (const std::string lost = lost_places(output, grid); !lost.empty()) session.console.note("{}", lost);
  const std::string data = volume_data_file(output).string();
  if (data.empty()) {
    outputs.write(output, write);
    return outputs.bytes(output);
  }
  outputs.write(output, [&](const auto& path) {
    outputs.write(data, [&](const auto& data_path) {
      options.data_file = data_path;
      options.data_name = std::filesystem::path(data).filename().string();
      write(path);
    });
  });
  return outputs.bytes(output) + outputs.bytes(data);
}

}  // namespace adamas
