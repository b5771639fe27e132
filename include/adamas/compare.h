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

/// The element size of Mesh_3 is searched until its interface distance differs from that of the resampled
/// mesh by at most this part of it, in at most so many trials.
inline constexpr double kSizingTolerance = 0.05;
inline constexpr int kMostSizingTrials = 12;
/// The least limit of another generator's address space in bytes: with less it could not load its libraries.
inline constexpr std::size_t kLeastMesherMemory = std::size_t{64} << 20;

/// Options that say which meshes are compared.
struct CompareOptions {
  /// The interface errors of the resampled mesh, each with a group of rows; empty: the error of `resampling`.
  std::vector<ErrorTarget> interface_errors{};
  ResampleOptions resampling{};
  bool tetgen = true, mesh3 = true;           ///< compare with these generators
  std::string tetgen_switches = "zpq1.414Q";  ///< the switches of TetGen; z and p are needed
  /// Time limit in seconds for one mesh of another generator, all trials and measuring together.
  double time_limit = 300;
  std::size_t memory_limit = std::size_t{8} << 30;  ///< limit of another generator's address space in bytes

  /// Throws Error (kUsage) where a value is out of range.
  void check() const;
  /// Returns the number of meshes of other generators. `labels`: whether the input has labels, which are a
  /// further input of Mesh_3.
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
