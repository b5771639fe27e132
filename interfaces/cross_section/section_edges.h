#pragma once

#include <array>
#include <vector>

#include "core/data/interface_mesh.h"
#include "core/geometry/plane_sides.h"

namespace adamas::interfaces {

/// A line between two points.
using Segment = std::array<Vec3, 2>;

/// The segment with the end first that has the smaller x, then y, then z.
Segment directed(const Segment& segment);
/// An order of directed segments.
bool comes_before(const Segment& a, const Segment& b);

/// Puts each segment that has a length there once, whichever way it runs, in an order that depends on the
/// segments alone.
void make_unique(std::vector<Segment>& segments);

/// Where a plane cuts the triangles of interfaces, each line once (the original interfaces of D figure 3.7).
/// `box`: the domain that decides ties and that the plane must cut; throws Error as PlaneSides does.
std::vector<Segment> section_edges(const InterfaceMesh& mesh, const Plane& plane, const Box3& box);

}  // namespace adamas::interfaces
