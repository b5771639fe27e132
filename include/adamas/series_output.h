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

/// Properties of a series of files that its options leave open.
struct SeriesForm {
  std::string ending;     ///< ending of the files of the steps: ".vtr"
  std::size_t steps = 0;  ///< number of steps where none is given
};

/// The files with the states of a process in time: one file with the last state, or a series F.pvd with
/// F_0000.vtr, F_0001.vtr, ... beside it.
class SeriesOutput {
 public:
  /// Declares the outputs of states that are evenly spaced in time: a list F.pvd has those from 0 to `end`,
  /// any other file only that at `end`. `steps`: the number of states in a series, from 2 to 1000; none: that
  /// of the form. `endings`: those that the one file may have, and .pvd where there may be a series. Throws
  /// Error (kUsage), whose messages call the options -o and --steps.
  SeriesOutput(const std::filesystem::path& output, std::optional<std::size_t> steps, double end,
               const SeriesForm& form, const std::vector<const char*>& endings, OutputSet& outputs);

  /// Declares the outputs of steps at these times, whose files end in `ending` (where a name has no ending of
  /// its own): a list F.pvd and its files, or, for a pattern as F_%04d.png, only the files, numbered from
  /// `first` on. Throws Error (kUsage) for a name that is neither.
  SeriesOutput(const std::filesystem::path& output, std::vector<double> times, const std::string& ending,
               OutputSet& outputs, std::size_t first = 0);

  /// Writes one file under the name given.
  using Writer = std::function<void(const std::filesystem::path&)>;
  /// Calls `make` with each time in ascending order, and the function that it returns with the file to write;
  /// then writes the list. The progress covers the whole series and names the number of the step.
  void write(const std::function<Writer(double, Progress&)>& make, OutputSet& outputs, Progress& progress);

  /// Writes the file of one step.
  void write(std::size_t step, const Writer& writer, OutputSet& outputs);
  /// Writes the list of a series, after the files of all steps.
  void write_list(OutputSet& outputs);
  /// Removes a step from the series: it gets no file, and the list does not name it.
  void leave_out(std::size_t step, OutputSet& outputs);

  /// Returns whether there is a list .pvd.
  [[nodiscard]] bool is_series() const { return is_series_; }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// Returns the number of bytes of all files together, once they are written.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  std::string output_;
  bool is_series_ = false;
  std::vector<std::string> files_;  ///< file names; those of steps that are left out are empty
  std::vector<double> times_;
  std::size_t bytes_ = 0;
};

}  // namespace adamas
