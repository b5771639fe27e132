#include "cli/flow_series.h"

#include <fmt/format.h>

#include "cli/option_values.h"
#include "cli/usage_error.h"
#include "core/io/series_writer.h"

namespace adamas {

namespace {

constexpr std::size_t kDefaultSteps = 11;
/// More files than this in one go are a slip of the hand.
constexpr std::size_t kMostSteps = 1000;

}  // namespace

FlowSeries::FlowSeries(std::string output, const std::string& steps, double end, OutputSet& outputs)
    : output_(std::move(output)) {
  outputs.declare("-o", output_, {".vtr", ".vti", ".pvd"});
  std::filesystem::path name = output_;
  std::string extension = name.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  is_series_ = extension == ".pvd";
  if (!is_series_) {
    if (!steps.empty()) wrong_usage("--steps: expected a series as well, -o F.pvd, found '-o {}'", output_);
    files_ = {output_};
    times_ = {end};
    return;
  }
  const std::size_t count = steps.empty() ? kDefaultSteps : parse_count("--steps", steps, 2);
  if (count > kMostSteps) wrong_usage("--steps: expected at most {}, found {}", kMostSteps, steps);
  const std::string stem = name.stem().string();
  for (std::size_t i = 0; i < count; ++i) {
    files_.push_back(name.replace_filename(fmt::format("{}_{:04}.vtr", stem, i)).string());
    outputs.declare("-o", files_.back(), {".vtr"});
    times_.push_back(end * static_cast<double>(i) / static_cast<double>(count - 1));
  }
}

void FlowSeries::finish(OutputSet& outputs) {
  if (!is_series_) return;
  std::vector<SeriesEntry> entries;
  for (std::size_t i = 0; i < files_.size(); ++i) {
    entries.push_back({times_[i], std::filesystem::path(files_[i]).filename().string()});
  }
  outputs.write(output_, [&entries](const auto& path) { write_series(path, entries); });
  bytes_ += outputs.bytes(output_);
}

}  // namespace adamas
