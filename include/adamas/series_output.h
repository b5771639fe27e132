#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adamas/export.h"
#include "adamas/output_set.h"
#include "adamas/progress.h"

namespace adamas ADAMAS_API {

/// Describes a series of files where its options leave it open.
struct SeriesForm {
  std::string ending;     ///< ending of the files of the steps: ".vtr"
  std::size_t steps = 0;  ///< number of steps where none is given
};

/// The files with the states of something that goes on in time: one file with the last state, or a series
/// F.pvd with F_0000.vtr, F_0001.vtr, ... beside it.
class SeriesOutput {
 public:
  /// Declares the outputs of states that are evenly spaced in time: a list F.pvd has those from 0 to `end`,
  /// any other file that of `end` alone. `steps`: the number of states in a series, from 2 to 1000; none:
  /// that of the form. `endings`: those that the one file may have, and .pvd where there may be a series.
  /// Throws Error (kUsage), whose messages call the options -o and --steps.
  SeriesOutput(const std::filesystem::path& output, std::optional<std::size_t> steps, double end,
               const SeriesForm& form, const std::vector<const char*>& endings, OutputSet& outputs);

  /// Declares the outputs of steps at these times, whose files end in `ending` (where a name has no ending of
  /// its own): those of a list F.pvd, or, of a pattern as F_%04d.png, the files alone, numbered from `first`
  /// on. Throws Error (kUsage) for a name that is neither.
  SeriesOutput(const std::filesystem::path& output, std::vector<double> times, const std::string& ending,
               OutputSet& outputs, std::size_t first = 0);

  /// Writes one file under the name given.
  using Writer = std::function<void(const std::filesystem::path&)>;
  /// Calls `make` with each time in ascending order, and the function that it returns with the file to write;
  /// then writes the list. Progress is that of the whole series, with the number of the step.
  void write(const std::function<Writer(double, Progress&)>& make, OutputSet& outputs, Progress& progress);

  /// Writes the file of one step.
  void write(std::size_t step, const Writer& writer, OutputSet& outputs);
  /// Writes the list of a series, where the files of all steps are written.
  void write_list(OutputSet& outputs);
  /// Marks a step that the series does not have: there is no file of it, and the list does not name it.
  void leave_out(std::size_t step, OutputSet& outputs);

  /// Whether there is a list .pvd.
  [[nodiscard]] bool is_series() const { return is_series_; }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// The number of bytes of all files together, once they are written.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  std::string output_;
  bool is_series_ = false;
  std::vector<std::string> files_;  ///< empty names of steps that are left out
  std::vector<double> times_;
  std::size_t bytes_ = 0;
};

}  // namespace adamas
