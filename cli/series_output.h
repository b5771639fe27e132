#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "adamas/progress.h"
#include "cli/command.h"

namespace adamas::cli {

/// What a command that makes series does where the options leave it open.
struct SeriesForm {
  std::string ending;     ///< of the files of a series: ".vtr"
  std::size_t steps = 0;  ///< of a series
};

/// The files with the states of something that goes on in time: either one file with the last state, or a
/// series F.pvd with F_0000.vtr, F_0001.vtr, ... beside it, which are evenly spaced in time from 0 to the
/// end.
class SeriesOutput {
 public:
  /// Declares the outputs. `steps` is the value of --steps, or empty; `endings` are those of the one file,
  /// and .pvd where there may be a series. Throws Error.
  SeriesOutput(std::string output, const std::string& steps, double end, const SeriesForm& form,
               const std::vector<const char*>& endings, OutputSet& outputs);

  /// A series of steps at these times, whose files end in `ending` (where a name has no ending of its own):
  /// those of a list F.pvd, or, of a pattern as F_%04d.png, the files alone, numbered from `first` on.
  /// Declares the outputs. Throws Error (kUsage) for a name that is neither.
  SeriesOutput(std::string output, std::vector<double> times, const std::string& ending, OutputSet& outputs,
               std::size_t first = 0);

  /// Writes one file under the name given.
  using Writer = std::function<void(const std::filesystem::path&)>;
  /// Calls `make` with each time, in order, and what it returns with the file to write. Progress is that of
  /// the whole, with the number of the step.
  void write(const std::function<Writer(double, Progress&)>& make, Session& session);

  /// Writes the file of one step, and the list where all are written.
  void write(std::size_t step, const Writer& writer, OutputSet& outputs);
  void write_list(OutputSet& outputs);
  /// The series has no such step: there is no file of it, and the list does not name it.
  void leave_out(std::size_t step, OutputSet& outputs);

  [[nodiscard]] bool is_series() const { return is_series_; }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// The bytes of all files together, once they are written.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  std::string output_;
  bool is_series_ = false;
  std::vector<std::string> files_;  ///< empty names of steps that are left out
  std::vector<double> times_;
  std::size_t bytes_ = 0;
};

/// Adds --steps and -o of such a command; `single` tells the one file.
void add_series_output(const Command& command, const std::string& single, const SeriesForm& form,
                       std::string& output, std::string& steps);

}  // namespace adamas::cli
