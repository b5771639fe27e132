#pragma once

#include <optional>
#include <vector>

#include "interfaces/resampling/body_mending.h"
#include "interfaces/resampling/careful_conservation.h"
#include "interfaces/resampling/conservation.h"
#include "interfaces/resampling/refinement.h"
#include "interfaces/resampling/resampling_state.h"
#include "interfaces/resampling/shown_interfaces.h"
#include "interfaces/resampling/volume_refinement.h"

namespace adamas::interfaces {

/// Measures the interfaces that the leaves of a state show, and splits cells where these are too far from the
/// input's or bodies or volumes differ from the input's; in the end it moves interfaces to conserve volumes.
class Certification {
 public:
  /// All parts must outlive this object.
  Certification(ResamplingState& state, Refinement& refinement, VolumeRefinement& volumes)
      : state_(state),
        refinement_(refinement),
        volumes_(volumes),
        shown_(state),
        mending_(state, refinement, volumes, shown_) {}

  /// Measures and refines until all errors are reached or cannot be; returns why it ended. It may be called
  /// again. Throws Cancelled if the progress requests it.
  RefinementEnd run();
  /// Moves interfaces, after run(), until each body has its volume, if the options want it. Distances and
  /// bodies stay as good as they are: where they would not, interfaces are not moved. Cells are split only
  /// if an error of volumes is wanted that moves alone do not reach. Returns why refinement ended.
  RefinementEnd conserve();
  /// Returns the measured distances, after run(), or after conserve() if volumes are to be conserved.
  [[nodiscard]] const InterfaceCertificate& certificate() const { return certificate_; }
  /// Returns the topology of the input's bodies in the mesh, after run().
  [[nodiscard]] const BodyReport& body_report() const { return mending_.report(); }

 private:
  /// The state of refinement for bodies.
  struct BodyRounds {
    std::optional<ShownBodies> best;
    SplitRecord since_best;  ///< the splits since the bodies were most like the input's
    int rounds_since_best = 0;
    bool mended = false;
    bool best_is_measured = false;  ///< whether distances were last measured when the best bodies were shown
    /// What was shown then, if others were extracted since.
    std::optional<BodyMending::Shown> best_shown;
  };

  RefinementEnd measure_and_refine();
  bool split_failing(std::vector<TetrahedronId> failing);
  RefinementEnd end(RefinementEnd reason, BodyRounds& bodies);
  [[nodiscard]] bool compare_bodies(BodyRounds& bodies);
  [[nodiscard]] std::optional<RefinementEnd> split_for_bodies(BodyRounds& bodies);
  void finish();
  void move_for_volumes();
  bool move_freely(double allowed);
  void move_carefully(CarefulConservation free, const ShownInterfaces::Measured& before, double allowed);
  [[nodiscard]] bool try_moves(CarefulConservation& conservation, const ShownInterfaces::Measured& before,
                               double allowed);
  void limit_moves(CarefulConservation& conservation, const ShownInterfaces::Measured& before, double most,
                   const std::vector<std::uint32_t>& triangles) const;
  [[nodiscard]] double allowed_distance() const;
  [[nodiscard]] bool is_unharmed(const BodyReport& before, double allowed) const;
  [[nodiscard]] std::vector<TetrahedronId> harmed_leaves(const BodyReport& before, Conservation& conservation,
                                                         bool all) const;

  ResamplingState& state_;
  Refinement& refinement_;
  VolumeRefinement& volumes_;
  ShownInterfaces shown_;
  BodyMending mending_;
  InterfaceCertificate certificate_;
  RefinementEnd end_ = RefinementEnd::kReached;
};

}  // namespace adamas::interfaces
