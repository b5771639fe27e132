#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "adamas/output_set.h"
#include "adamas/progress.h"
#include "adamas/volume_input.h"
#include "core/io/volume_reader.h"
#include "timevarying/series_builder.h"

namespace adamas::workflow {

/// Throws Error, which says how the grid of a step differs from that of the others.
[[noreturn]] void refuse_grid(const std::string& name, const VolumeGrid& found, const std::string& first,
                              const VolumeGrid& wanted);

/// Steps of a series, opened one after another as they are asked for. Throws Error where a step has another
/// grid than the first.
class StoredSteps {
 public:
  StoredSteps(std::vector<VolumeInputStep> steps, OutputSet& outputs, Progress& progress);
  ~StoredSteps();
  StoredSteps(const StoredSteps&) = delete;
  StoredSteps& operator=(const StoredSteps&) = delete;

  [[nodiscard]] const VolumeGrid& grid() const { return grid_; }
  /// Returns the type of the numbers that samples are read from, of which restoring loses nothing.
  [[nodiscard]] StoredType number_type() const { return number_type_; }
  /// Returns the source of a store; this object must outlive it.
  [[nodiscard]] SeriesSource source();
  /// Closes the last step and writes notes about all steps.
  void finish();
  [[nodiscard]] std::uint64_t input_bytes() const { return input_bytes_; }
  /// Returns the name of the array of the first step; empty where the file has none.
  [[nodiscard]] const std::string& array() const { return array_; }
  [[nodiscard]] std::size_t count() const { return steps_.size(); }
  /// Returns the numbers of samples that are no finite numbers, for the steps that have such samples.
  [[nodiscard]] const std::map<std::uint32_t, std::uint64_t>& infinite_samples() const { return infinite_; }

 private:
  class Open;
  /// Returns whether numbers are of a type that samples do not have.
  [[nodiscard]] bool keeps_numbers() const;
  void open(std::uint32_t n);
  void close();
  /// Notes which array is taken where a file has several and none was named.
  void note_array(const VolumeInputStep& step, const io::VolumeSource& source);

  std::vector<VolumeInputStep> steps_;
  OutputSet& outputs_;
  Progress& progress_;
  VolumeGrid grid_;
  StoredType number_type_ = StoredType::kUint8;
  std::unique_ptr<Open> open_;
  std::uint32_t opened_ = 0;
  std::uint64_t input_bytes_ = 0;
  std::map<std::uint32_t, std::uint64_t> infinite_;
  std::string array_, noted_array_, last_note_;
  std::vector<std::pair<double, std::string>> changes_;  ///< greatest changes of numbers, and notes of them
};

}  // namespace adamas::workflow
