#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/command.h"
#include "core/io/multi_material_writer.h"
#include "datasets/flow/flow_output.h"

namespace adamas {

/// The data that come of a flow: the last ones alone, or F.pvd with F_0000.vtr, F_0001.vtr, ... beside it,
/// evenly spaced in time from the start to the end.
class FlowSeries {
 public:
  /// Declares the outputs. `steps` is the value of --steps, or empty. Throws UsageError and Error.
  FlowSeries(std::string output, const std::string& steps, double end, OutputSet& outputs);

  /// Lets the flow go on to each of the times and writes what it is then.
  template <std::size_t N>
  void write(FlowSolver<N>& flow, const FlowUnits& units, Session& session) {
    for (std::size_t i = 0; i < files_.size(); ++i) {
      flow.advance_to(times_[i], session.console, times_.back());
      session.console.step("writing " + files_[i], times_[i] / times_.back());
      const MultiMaterialData data = flow_data(flow, output_, units);
      session.outputs.write(files_[i], [&data](const auto& path) { write_multi_material_data(path, data); });
      bytes_ += session.outputs.bytes(files_[i]);
    }
    finish(session.outputs);
  }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// Of all files together, once they are written.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  void finish(OutputSet& outputs);

  std::string output_;
  bool is_series_ = false;
  std::vector<std::string> files_;
  std::vector<double> times_;
  std::size_t bytes_ = 0;
};

}  // namespace adamas
