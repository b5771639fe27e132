#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "adamas/progress.h"
#include "interfaces/comparison/piecewise_linear_complex.h"
#include "interfaces/reference_client/child_program.h"

namespace adamas::interfaces {

/// A triangle of interfaces that are to be stitched to a box, with the bodies in front and behind.
struct BodyTriangle {
  std::array<std::uint32_t, 3> points;
  BodyId front, back;
};

/// The complex of interfaces inside a box and the sides of the box, which are triangulated so that they share
/// the edges where interfaces end (docs/method.md, Reference meshes). Points within `tolerance` of a side are
/// moved onto it; triangles that then lie in a side, or have no area, are left out. `body_at` gives the body
/// at the box's boundary where no interface ends. `program` is adamas-reference, which triangulates the
/// sides. Throws Error that begins with `source` if points lie outside the box or the result is not closed;
/// ProgramFailure if the program fails.
PiecewiseLinearComplex stitch_to_box(const std::string& source, std::span<const Vec3> points,
                                     std::span<const BodyTriangle> triangles, const Box3& box,
                                     double tolerance, const std::function<BodyId(const Vec3&)>& body_at,
                                     const std::filesystem::path& program,
                                     const Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
