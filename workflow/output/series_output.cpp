#include "adamas/series_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "adamas/file_names.h"
#include "adamas/series.h"
#include "core/base/error.h"
#include "core/io/volume_stack.h"

namespace adamas {

using namespace io;

namespace {

/// A greater number of files is regarded as a typing error.
constexpr std::size_t kMostSteps = 1000;

/// The progress of one step as a part of that of all steps.
class StepProgress final : public Progress {
 public:
  StepProgress(Progress& all, std::size_t step, std::size_t count) : all_(all), step_(step), count_(count) {}

  void report(std::string_view stage, double fraction) override {
    const double done = static_cast<double>(step_) + std::clamp(fraction, 0.0, 1.0);
    const std::string text =
        count_ > 1 ? fmt::format("{}, step {} of {}", stage, step_ + 1, count_) : std::string(stage);
    all_.report(text, done / static_cast<double>(count_));
  }
  void note(NoteKind kind, std::string_view text) override { all_.note(kind, text); }
  [[nodiscard]] bool wants_all_notes() const override { return all_.wants_all_notes(); }
  [[nodiscard]] bool cancelled() const override { return all_.cancelled(); }

 private:
  Progress& all_;
  std::size_t step_, count_;
};

}  // namespace

SeriesOutput::SeriesOutput(const std::filesystem::path& output, std::optional<std::size_t> steps, double end,
                           const SeriesForm& form, const std::vector<const char*>& endings,
                           OutputSet& outputs)
    : output_(output.string()), is_series_(file_extension(output_) == ".pvd") {
  outputs.declare("-o", output_, endings);
  if (!is_series_) {
    if (steps) wrong_usage("--steps: expected a series as well, -o F.pvd, found '-o {}'", output_);
    files_ = {output_};
    times_ = {end};
    return;
  }
  const std::size_t count = steps.value_or(form.steps);
  if (count < 2) wrong_usage("--steps: expected a whole number of at least 2, found '{}'", count);
  if (count > kMostSteps) wrong_usage("--steps: expected at most {}, found {}", kMostSteps, count);
  const std::filesystem::path list = output_;
  for (std::size_t i = 0; i < count; ++i) {
    files_.push_back((list.parent_path() / step_file(list, i, form.ending)).string());
    outputs.declare("-o", files_.back());
    times_.push_back(end * static_cast<double>(i) / static_cast<double>(count - 1));
  }
}

SeriesOutput::SeriesOutput(const std::filesystem::path& output, std::vector<double> times,
                           const std::string& ending, OutputSet& outputs, std::size_t first)
    : output_(output.string()), is_series_(file_extension(output_) == ".pvd"), times_(std::move(times)) {
  const std::filesystem::path list = output_;
  if (is_series_) outputs.declare("-o", output_);
  for (std::size_t i = 0; i < times_.size(); ++i) {
    const std::string name =
        is_series_ ? step_file(list, first + i, ending) : numbered_name(list.filename().string(), first + i);
    if (name.empty())
      wrong_usage("-o: expected a list of steps (.pvd) or a pattern of names, as F_%04d{}, found '{}'",
                  ending, output_);
    files_.push_back((list.parent_path() / name).string());
    outputs.declare("-o", files_.back(), {ending.c_str()});
  }
}

void SeriesOutput::write(std::size_t step, const Writer& writer, OutputSet& outputs) {
  outputs.write(files_[step], writer);
  bytes_ += outputs.bytes(files_[step]);
}

void SeriesOutput::leave_out(std::size_t step, OutputSet& outputs) {
  outputs.leave_out(files_[step]);
  files_[step].clear();
}

void SeriesOutput::write(const std::function<Writer(double, Progress&)>& make, OutputSet& outputs,
                         Progress& progress) {
  for (std::size_t i = 0; i < files_.size(); ++i) {
    StepProgress part(progress, i, files_.size());
    const Writer writer = make(times_[i], part);
    part.step("writing " + files_[i], 1);
    write(i, writer, outputs);
  }
  write_list(outputs);
}

void SeriesOutput::write_list(OutputSet& outputs) {
  if (!is_series_) return;
  std::vector<SeriesEntry> entries;
  for (std::size_t i = 0; i < files_.size(); ++i) {
    if (files_[i].empty()) continue;
    entries.push_back({times_[i], std::filesystem::path(files_[i]).filename().string()});
  }
  outputs.write(output_, [&entries](const auto& path) { write_series(path, entries); });
  bytes_ += outputs.bytes(output_);
}

}  // namespace adamas
