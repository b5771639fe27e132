#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "adamas/comparison.h"
#include "adamas/error_target.h"
#include "adamas/export.h"
#include "adamas/input.h"
#include "adamas/progress.h"
#include "adamas/resample.h"

namespace adamas ADAMAS_API {

/// The size of elements of Mesh_3 is searched until the distance of interfaces is that of the resampled mesh
/// within this part of it, in at most so many trials.
inline constexpr double kSizingTolerance = 0.05;
inline constexpr int kMostSizingTrials = 12;
/// The least address space of another generator in bytes: with less it could not even load its libraries.
inline constexpr std::size_t kLeastMesherMemory = std::size_t{64} << 20;

/// The meshes that are compared.
struct CompareOptions {
  /// Errors that are wanted of the resampled mesh, a group of rows for each; none: the error of `resampling`.
  std::vector<ErrorTarget> interface_errors{};
  ResampleOptions resampling{};
  bool tetgen = true, mesh3 = true;           ///< other generators
  std::string tetgen_switches = "zpq1.414Q";  ///< z and p are needed
  double time_limit = 300;  ///< seconds for one mesh of another generator, all trials and measuring together
  std::size_t memory_limit = std::size_t{8} << 30;  ///< bytes of address space of another generator

  /// Throws Error (kUsage) where a value is out of range.
  void check() const;
  /// Returns the number of meshes of other generators. `labels`: whether the input has labels, which Mesh_3
  /// is given as well.
  [[nodiscard]] std::size_t reference_count(bool labels) const;
};

/// Compares the resampled mesh of an input with meshes of TetGen and CGAL's Mesh_3 at equal distance of the
/// interfaces (docs/method.md, Reference meshes). The program adamas-reference makes these meshes; it is
/// found as find_reference_program() of adamas/verify.h does.
class MeshComparison {
 public:
  /// Checks the options, finds the program, and makes the input's interfaces. Throws Error as resample()
  /// does, as CompareOptions::check() does, and where the program is not found.
  MeshComparison(const Input& input, const CompareOptions& options = {},
                 Progress& progress = SilentProgress::instance());
  MeshComparison(MeshComparison&&) noexcept;
  MeshComparison& operator=(MeshComparison&&) noexcept;
  ~MeshComparison();

  /// Returns the name of the input in messages.
  [[nodiscard]] const std::string& name() const;

  /// Makes and measures the meshes, group by group; that of TetGen with the input's interfaces, which belongs
  /// to no error, comes in the first group. `finished` is called with each row as soon as it is there. A
  /// generator that fails gives a row with its reason. Throws Cancelled where the progress says so.
  [[nodiscard]] std::vector<ComparisonRow> run(const std::function<void(const ComparisonRow&)>& finished = {},
                                               Progress& progress = SilentProgress::instance()) const;

 private:
  struct Contents;
  std::unique_ptr<Contents> contents_;
};

}  // namespace adamas
