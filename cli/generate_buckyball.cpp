#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/figures.h"
#include "cli/generate_commands.h"
#include "cli/option_checks.h"
#include "cli/option_values.h"
#include "core/io/volume_writer.h"
#include "datasets/buckyball.h"

namespace adamas {

namespace {

constexpr SampleType kTypes[] = {SampleType::kUint8, SampleType::kUint16, SampleType::kFloat32};

struct Options {
  std::string dimensions, type = sample_name(kTypes[0]), output;
};

std::vector<std::string> type_names() {
  std::vector<std::string> names;
  for (const SampleType type : kTypes) names.emplace_back(sample_name(type));
  return names;
}

SampleType parse_type(const std::string& name) {
  return *std::find_if(std::begin(kTypes), std::end(kTypes),
                       [&name](SampleType type) { return sample_name(type) == name; });
}

void write_planes(const Buckyball& ball, const std::string& output, VolumeWriter& writer,
                  Progress& progress) {
  std::vector<std::byte> samples(ball.grid().plane_bytes());
  const std::uint64_t planes = ball.grid().dimensions[2];
  for (std::uint64_t k = 0; k < planes; ++k) {
    progress.step("writing " + output, static_cast<double>(k) / static_cast<double>(planes));
    ball.plane(k, samples);
    writer.write_plane(samples);
  }
  writer.finish();
}

/// Writes the file, and that of its samples where it is another; returns their bytes.
std::size_t write_files(const Buckyball& ball, const std::string& output, Session& session) {
  OutputSet& outputs = session.outputs;
  const std::string data = volume_data_file(output).string();
  VolumeWriterOptions options;
  options.array = "buckyball";
  const auto write = [&](const std::filesystem::path& path) {
    VolumeWriter writer(path, ball.grid(), options);
    write_planes(ball, output, writer, session.console);
  };
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

void run(const Options& options, Session& session) {
  const auto n = parse_dimensions("--dimensions", options.dimensions);
  session.outputs.declare("-o", options.output, {".vti", ".nrrd", ".nhdr", ".mha", ".mhd", ".raw"});
  session.outputs.declare("-o", volume_data_file(options.output).string());
  const Buckyball ball({n[0], n[1], n[2]}, parse_type(options.type));
  const std::size_t bytes = write_files(ball, options.output, session);
  const VolumeGrid& grid = ball.grid();
  Figures figures{{"dimensions", n}, {"bytes", bytes}, {"type", options.type}};
  figures["spacing"] = {grid.spacing.x, grid.spacing.y, grid.spacing.z};
  figures["seconds"] = session.console.seconds();
  session.console.print("Buckyball of {} x {} x {} samples, {}, {}\n", n[0], n[1], n[2], options.type,
                        bytes_text(static_cast<double>(bytes)));
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
  session.outputs.commit();
}

}  // namespace

void add_generate_buckyball(CLI::App& generate, Session& session) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      add_command(generate, session, "buckyball", "A volume of Gaussians at the 60 atoms of a buckyball",
                  "adamas generate buckyball --dimensions 256 -o ball.nhdr",
                  [options, &session] { run(*options, session); });
  command->add_option("--dimensions", options->dimensions, "Numbers of samples, or one for all axes")
      ->required()
      ->type_name("X,Y,Z");
  command->add_option("--type", options->type, "Of the samples, whose values fill its range; float32: 0 to 1")
      ->check(one_of(type_names()))
      ->capture_default_str();
  command
      ->add_option("-o,--output", options->output,
                   "The volume: .vti, .nrrd, .mha, .nhdr or .mhd with a .raw beside it, or .raw alone")
      ->required()
      ->type_name("FILE");
}

}  // namespace adamas
