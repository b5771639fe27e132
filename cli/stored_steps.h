#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cli/volume_options.h"
#include "core/io/volume_series.h"
#include "timevarying/series_builder.h"

namespace adamas::cli {

/// A step that is to be stored: the volume that it is, and what messages call it.
struct InputStep {
  double time = 0;
  std::string name;
  VolumeInput input;
};

/// The steps that the inputs of `store` stand for.
struct InputSteps {
  std::vector<InputStep> steps;
  io::StepTimes times = io::StepTimes::kCounted;
  std::string remark{};  ///< as of VolumeSeries
};

/// Those of several files, of a pattern or a list (find_series), or of the series that one file is
/// (find_volume_series), unless an option says which time of it; else the one volume. Throws Error.
InputSteps find_input_steps(const std::vector<std::string>& inputs, const VolumeInput& options);

/// Says in what a step's grid is another than that of others.
[[noreturn]] void refuse_grid(const std::string& name, const VolumeGrid& found, const std::string& first,
                              const VolumeGrid& wanted);

/// Steps of a series, opened one after another as they are asked for. All have the grid of the first; Throws
/// Error where one has not.
class StoredSteps {
 public:
  StoredSteps(std::vector<InputStep> steps, Session& session);
  ~StoredSteps();
  StoredSteps(const StoredSteps&) = delete;
  StoredSteps& operator=(const StoredSteps&) = delete;

  [[nodiscard]] const VolumeGrid& grid() const { return grid_; }
  /// What a store is built of; this has to outlive it.
  [[nodiscard]] timevarying::SeriesSource source();
  /// Closes the last step and notes what there is to say of all.
  void finish();
  [[nodiscard]] std::uint64_t input_bytes() const { return input_bytes_; }
  /// What the array of the first step is called; empty where nothing says.
  [[nodiscard]] const std::string& array() const { return array_; }
  [[nodiscard]] std::size_t count() const { return steps_.size(); }
  /// How many samples are no finite numbers, of the steps that have such.
  [[nodiscard]] const std::map<std::uint32_t, std::uint64_t>& infinite_samples() const { return infinite_; }

 private:
  class Open;
  void open(std::uint32_t n);
  void close();
  /// Says which array is taken where a file has several and none was named.
  void note_array(const InputStep& step, const io::VolumeSource& source);

  std::vector<InputStep> steps_;
  Session& session_;
  VolumeGrid grid_;
  std::unique_ptr<Open> open_;
  std::uint32_t opened_ = 0;
  std::uint64_t input_bytes_ = 0;
  std::map<std::uint32_t, std::uint64_t> infinite_;
  std::string array_, noted_array_, last_note_;
  std::vector<std::pair<double, std::string>> losses_;  ///< of digits, by how much at most, and a note
};

}  // namespace adamas::cli
