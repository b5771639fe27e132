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

/// What CGAL finds of the two-sided Hausdorff distance between two sets of interfaces: the greatest distance
/// of a point of either from the other. It is no less than `lower` and no more than `upper`; both are
/// infinite where one of the two alone has no triangles in the domain.
struct CgalVerdict {
  double lower = 0, upper = 0;  ///< in units of length
  double seconds = 0;           ///< by the clock
};

/// What verify_by_cgal may take, and what counts.
struct VerifyOptions {
  /// Only what lies in this box counts: points outside of it need not be near the other interfaces. None: all
  /// points count.
  std::optional<Box3> domain;
  double seconds = 0;            ///< the greatest time by the clock; 0: no limit
  std::size_t memory_bytes = 0;  ///< the greatest address space of adamas-reference; 0: no limit
};

/// Measures how far two sets of interfaces are from each other, whatever their materials, independently of
/// the distances that resample() certifies: by CGAL's AABB trees, where triangles are divided until the
/// figures are no more than `bound` (and some billionths of the size of everything) apart. The program
/// adamas-reference does it, since these trees are under the GPL; it is installed beside this library and
/// looked for beside the running program, in ../libexec of that, where it was to be installed, or where the
/// environment variable ADAMAS_REFERENCE_PROGRAM says. Throws Error where `bound` is not positive, a triangle
/// has a point that is not there, a coordinate is not finite, or the program is not found or fails; Cancelled
/// where the progress says so, and then the program is ended.
CgalVerdict verify_by_cgal(const InterfaceTriangles& a, const InterfaceTriangles& b, double bound,
                           const VerifyOptions& options = {},
                           Progress& progress = SilentProgress::instance());

/// Returns where the program adamas-reference lies. Throws Error where it is not there, and, beginning with
/// `purpose`, what it is needed for, where this build is without it.
std::filesystem::path find_reference_program(const std::string& purpose);

/// Says where adamas-reference lies, for programs that do not lie beside it or in the folder bin of the same
/// prefix; to be called once, before it is needed. In CMake the path is $<TARGET_FILE:adamas::reference>; the
/// environment variable ADAMAS_REFERENCE_PROGRAM says the same.
void set_reference_program(const std::filesystem::path& program);

}  // namespace adamas
