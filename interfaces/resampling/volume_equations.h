#pragma once

#include <vector>

#include "interfaces/resampling/exchanged_volumes.h"

namespace adamas::interfaces {

/// Volumes agree if they differ by at most this, relative to the domain's volume.
constexpr double kVolumesAgree = 2e-11;
/// A step of Newton's method is idle if it has left more than this part of what the bodies lack that are
/// solved for.
constexpr double kIdlePart = 0.7;
/// A volume that is at most this part of the greatest one that was missing before a step has not failed: the
/// steps of other bodies change it, too.
constexpr double kSmallPart = 0.1;
/// Sums of missing volumes that differ by this part are equal.
constexpr double kVolumeRoundOff = 1e-9;
/// The greatest number of times that a step is computed anew because interfaces would be moved too far.
constexpr int kMostStops = 4;

/// What is known of a body's volume while interfaces are moved.
struct UnknownVolume {
  double missing = 0;  ///< the body's volume in the input, scaled, minus that in the mesh
  double damping = 0;  ///< makes the body's steps smaller
  int failures = 0;    ///< the last steps that have not brought the body nearer to its volume
  BodyId heir;         ///< the body that gets what this one cannot have; none if that gets lost

  [[nodiscard]] bool is_given_up() const;
  void give_up();
  /// Changes the damping after a step that leaves this volume missing. `small`: what is no failure.
  void judge(double now, double small);
};
using UnknownVolumes = IdVector<BodyId, UnknownVolume>;

/// Returns, for each body, the largest one of those that exchange volume with it, directly or not; for one
/// that is alone, itself. Those that are given up count as smaller.
IdVector<BodyId, BodyId> largest_bodies(const std::vector<Exchange>& exchanges,
                                        const UnknownVolumes& unknowns,
                                        const IdVector<BodyId, double>& wanted);
/// Returns the offsets with which bodies gain their missing volumes, to first order. Those that are given up
/// keep the volumes that they have. Of bodies that exchange volume with each other, directly or not, the
/// largest one has no offset: it gets what the others leave.
IdVector<BodyId, double> offsets(const std::vector<Exchange>& exchanges, const UnknownVolumes& unknowns,
                                 const IdVector<BodyId, double>& wanted);

}  // namespace adamas::interfaces
