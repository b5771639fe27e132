#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/meshes.h"
#include "adamas/progress.h"

namespace adamas ADAMAS_API {

/// Bounds by CGAL of the two-sided Hausdorff distance between two sets of interfaces: the greatest distance
/// of a point of either from the other. It is no less than `lower` and no more than `upper`; both are
/// infinite where only one of the two has no triangles in the domain.
struct CgalVerdict {
  double lower = 0, upper = 0;   ///< in units of length
  double seconds = 0;            ///< duration (wall clock)
  double processor_seconds = 0;  ///< of adamas-reference and this program

  /// Returns the bounds with four digits: "0.0123 to 0.0124".
  [[nodiscard]] std::string text() const;
  /// Compares the bounds with those that were measured otherwise: `found`, which is no more than the
  /// distance, and `certified`, which is no less (MeasuredDistance and CertifiedDistance have both). Returns
  /// a sentence that has all four where not all can hold; none where they agree.
  [[nodiscard]] std::optional<std::string> contradiction(double found, double certified) const;
};

/// The bound that verify_by_cgal() gets from `adamas resample --verify-by cgal`, as a part of the wanted
/// interface error.
inline constexpr double kVerifyPrecision = 0.01;

/// Limits of verify_by_cgal, and the domain.
struct VerifyOptions {
  /// Points outside of this box count for nothing: they need not be near the other interfaces. None: all
  /// points count.
  std::optional<Box3> domain;
  double seconds = 0;            ///< time limit (wall clock); 0: no limit
  std::size_t memory_bytes = 0;  ///< limit of the address space of adamas-reference; 0: no limit
};

/// Measures how far two sets of interfaces are from each other, whatever their materials, independently of
/// the distances that resample() certifies: by CGAL's bounded_error_Hausdorff_distance, with an error of half
/// of `bound`, so that the verdict's bounds are no more than `bound` (and some billionths of the size of
/// everything) apart. The program adamas-reference does it, since this is under the GPL; it is installed
/// beside this library and looked for where set_reference_program() or the environment variable
/// ADAMAS_REFERENCE_PROGRAM says, beside the running program, in ../libexec of that, or in its installation
/// folder. Throws Error where `bound` is not positive, a triangle has the index of no point, a coordinate is
/// not finite, or the program is not found or fails; Cancelled where the progress says so, and then the
/// program is ended.
CgalVerdict verify_by_cgal(const InterfaceTriangles& a, const InterfaceTriangles& b, double bound,
                           const VerifyOptions& options = {},
                           Progress& progress = SilentProgress::instance());

/// Returns the path of the program adamas-reference. Throws Error where it does not exist, and, beginning
/// with `purpose`, the task that needs it, where this build is without it.
std::filesystem::path find_reference_program(const std::string& purpose);

/// Sets the path of adamas-reference, whatever the environment variable ADAMAS_REFERENCE_PROGRAM says, which
/// has the same effect; it is looked for again where the path is empty. Programs that do not lie beside it or
/// in the folder bin of the same prefix call this once, before it is needed. In CMake the path is
/// $<TARGET_FILE:adamas::reference>.
void set_reference_program(const std::filesystem::path& program);

}  // namespace adamas
