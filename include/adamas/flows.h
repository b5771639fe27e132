#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "adamas/progress.h"
#include "adamas/volume.h"

namespace adamas ADAMAS_API {

// Simulations of flows of several compressible materials (docs/method.md, "The flow solver"). Their results
// do not depend on the number of threads.

/// The mass of each material, by its number, and the energy of all together, in the units of the flow.
struct FlowTotals {
  std::vector<double> masses;
  double energy = 0;
};

/// The state of a flow as a whole.
struct FlowState {
  double time = 0;
  std::size_t steps = 0;  ///< number of solver steps since the start
  /// Number of cells that were computed with first order in place of second.
  std::size_t first_order_cells = 0;
  std::vector<std::string> materials;
  FlowTotals start;    ///< totals in the box at the time 0
  FlowTotals inside;   ///< totals in the box now
  FlowTotals entered;  ///< totals that have entered through the faces of the box, less those that left
};

/// The impact of a projectile on a block; lengths in cm, times in microseconds, masses in grams.
struct ImpactOptions {
  std::array<std::size_t, 3> cells{32, 32, 52};
  /// The box of the data; x = 0 or y = 0 is a plane of symmetry where the box begins with it.
  Box3 box{{0, 0, -16}, {12, 12, 4.8}};
  double speed = 1.2;  ///< the speed of the projectile, downwards: 12 km/s
};

/// The time at which the crater, its lip and the wave in the block are well apart.
inline constexpr double kImpactTime = 5;
/// The greatest speed of an impact; beyond it metals do not behave as stiffened gases.
inline constexpr double kGreatestImpactSpeed = 10;

/// Returns whether a box contains (0, 0, 0), where the axis meets the block, in its inside or on its low
/// sides in x and y.
bool holds_impact(const Box3& box);

/// A tungsten cylinder of radius 1 and height 1.6 that has just come down on a tantalum block, which fills
/// z < 0 for |x|, |y| < 9, in air so thin that it counts as empty: the materials "projectile", "block" and
/// "empty".
class ImpactSimulation {
 public:
  /// Prepares the flow at the time 0. Throws Error for a box that does not hold the impact, a speed out of
  /// range, and cells that are none or more than fit in memory.
  explicit ImpactSimulation(const ImpactOptions& options = {});
  ImpactSimulation(ImpactSimulation&&) noexcept;
  ImpactSimulation& operator=(ImpactSimulation&&) noexcept;
  ~ImpactSimulation();

  /// Advances the flow to a time. Throws Error, naming the cell and the time, where the flow leaves what the
  /// laws of the materials can describe, and Cancelled.
  void advance_to(double time, Progress& progress = SilentProgress::instance());
  [[nodiscard]] FlowState state() const;
  /// Returns the flow as it is now: volume fractions, the field "density" of each material in g/cm3, and
  /// "pressure" in Mbar and "velocity" in cm/us, which materials share. Fractions below 0.001 become zero and
  /// the others of the cell take their room; the flow itself stays as it is.
  [[nodiscard]] OwnedGridData data() const;

 private:
  struct Contents;
  std::unique_ptr<Contents> contents_;
};

/// A shock in air that strikes a rippled interface with sulphur hexafluoride, in metres, seconds, kilograms.
struct MixingOptions {
  /// The numbers of cells, which are cubes; along z, where the shock goes, the tube is kMixingLength long.
  std::array<std::size_t, 3> cells{64, 64, 64};
  std::uint64_t seed = 0;  ///< seed of the ripples' phases
  double mach = 2;         ///< Mach number of the shock
  /// Root of the mean square of the ripples, as a part of the tube's greater width or, where that is less, of
  /// its length.
  double ripples = 0.012;
};

inline constexpr double kMixingLength = 0.1;
/// The time at which the ripples have become a layer of turns and fingers.
inline constexpr double kMixingTime = 1e-3;
/// The fewest cells along z that separate the shock, the interface and the ends.
inline constexpr std::size_t kFewestMixingCells = 8;
inline constexpr double kGreatestMixingMach = 10;

/// A field of a flow as samples at the centres of its cells, with one scale for all times.
struct SampledField {
  std::string name, unit;
  double slope = 1, intercept = 0;     ///< a value is slope * sample + intercept
  double least = 0, greatest = 0;      ///< the least and the greatest value of all times that were sampled
  std::uint64_t cut_off = 0;           ///< number of samples of all times whose values were beyond the scale
  std::span<const std::byte> samples;  ///< the samples of the last time, as in Volume; the flow owns them
};

/// The flow behind such a shock, seen from where the interface, once struck, has no mean velocity: the
/// materials "air" and "sulphur hexafluoride" (docs/generated_data.md).
class MixingSimulation {
 public:
  /// Prepares the flow at the time 0. `type`: the type of the samples, kUint8, kUint16 or kFloat32. Throws
  /// Error for fewer cells along z than kFewestMixingCells, more cells than fit in memory, and a Mach number
  /// that is not above 1 and up to kGreatestMixingMach.
  explicit MixingSimulation(const MixingOptions& options = {}, SampleType type = SampleType::kUint8);
  MixingSimulation(MixingSimulation&&) noexcept;
  MixingSimulation& operator=(MixingSimulation&&) noexcept;
  ~MixingSimulation();

  /// Advances the flow to a time, as ImpactSimulation does, and samples the fields there.
  void advance_to(double time, Progress& progress = SilentProgress::instance());
  [[nodiscard]] FlowState state() const;
  [[nodiscard]] const VolumeGrid& grid() const;
  /// Returns the entropy and the density at the time of the last call of advance_to().
  [[nodiscard]] std::vector<SampledField> fields() const;

 private:
  struct Contents;
  std::unique_ptr<Contents> contents_;
};

}  // namespace adamas
