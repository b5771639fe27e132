#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/resampling/interface_comparison.h"
#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// Measures the interfaces that the leaves of a state show against those of the input.
class ShownInterfaces {
 public:
  /// The state must outlive this object.
  explicit ShownInterfaces(ResamplingState& state)
      : state_(state), comparison_(state.source, state.options.interface_error) {}

  /// Changes the wanted distance for later measurements.
  void set_target(double target) { comparison_.set_target(target); }
  /// Extracts the interfaces that the leaves show now and measures them. `each`: triangles that are too far
  /// are found even if no cell may be split for them.
  void measure(bool each = false);
  /// Only extracts; returns the interfaces that were extracted before.
  ExtractedInterfaces extract();
  /// Only measures the interfaces that were extracted last.
  void measure_extracted(bool each = false);
  /// What leaves show, and how far it is from the input's interfaces.
  struct Measured {
    ExtractedInterfaces extracted;
    InterfaceComparison comparison;
  };
  /// Measures the interfaces that the leaves show now, whose polygons must be those that were measured in
  /// `before`, with other corners.
  void measure_moved(const Measured& before);
  /// Extracts the interfaces that the leaves show now and measures them, after vertices have moved and
  /// nothing else has changed since the last measurement, which must have been of each triangle.
  void measure_after_moves();
  /// Returns what was extracted and measured last.
  [[nodiscard]] Measured measured() const { return {extracted_, comparison_}; }
  /// Returns to what was measured before, after the leaves were made to show it again.
  void go_back(Measured measured);
  /// Returns to interfaces that were extracted before, after the leaves were made to show them again.
  void go_back(ExtractedInterfaces extracted);
  /// Returns the interfaces that were extracted last.
  [[nodiscard]] const ExtractedInterfaces& extracted() const { return extracted_; }
  /// Returns a number that is another one for all interfaces that were extracted.
  [[nodiscard]] std::size_t number() const { return number_; }
  /// Returns the last measurement.
  [[nodiscard]] const InterfaceComparison& comparison() const { return comparison_; }
  /// Tightens the bounds of the last measurement for reports.
  [[nodiscard]] InterfaceCertificate finish();
  /// Frees the memory of the extracted interfaces.
  void clear() { extracted_ = {}; }
  /// Returns the leaves where the measured distance is, or may be, greater than wanted.
  [[nodiscard]] std::vector<TetrahedronId> failing_leaves() const;
  /// Returns leaves where the distance is, or may be, greater than wanted among these ones, which are new
  /// since the last measurement. Only interfaces near them are extracted for it, and sample points stand for
  /// all points, so that the next measurement may find others.
  [[nodiscard]] std::vector<TetrahedronId> failing_among(const std::vector<TetrahedronId>& leaves) const;

 private:
  [[nodiscard]] ContactMeshBuilder builder_for(const std::vector<TetrahedronId>& leaves) const;
  [[nodiscard]] InterfaceMesh extract_near(const std::vector<TetrahedronId>& leaves) const;
  void add_leaves_with_far_shown(const std::vector<TetrahedronId>& among,
                                 std::vector<TetrahedronId>& failing) const;
  void for_each_batch(const std::vector<TetrahedronId>& leaves,
                      const std::function<void(std::span<const ContactBuffer>)>& visit) const;
  [[nodiscard]] std::vector<TetrahedronId> leaves_with_far_input() const;

  ResamplingState& state_;
  InterfaceComparison comparison_;
  ExtractedInterfaces extracted_;
  std::size_t number_ = 0;
};

}  // namespace adamas::interfaces
