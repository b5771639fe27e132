#include "isosurface/extraction/diamond_stencil.h"

#include <gtest/gtest.h>

#include <set>

#include "core/geometry/tetrahedron_contour.h"
#include "core/lattice/diamond.h"

namespace adamas {

using namespace isosurface;

namespace {

using Vertices = std::set<LatticePoint>;

constexpr int kBits = 5;  ///< log2 of the scale of the diamonds here

Diamond diamond_of(LatticePoint q) {
  const LatticePoint middle{1 << 20, 1 << 20, 1 << 20};
  return Diamond(middle + (1 << kBits) * q);
}

Vertices members(const DiamondStencil& stencil, const Diamond& diamond, DiamondStencil::Members set) {
  Vertices result;
  for (std::size_t m = 0; m < stencil.count; ++m) {
    if ((set >> m & 1) != 0) result.insert(diamond.point() + diamond.scale() * stencil.offsets[m]);
  }
  return result;
}

/// Calls `visit` with a diamond of each type.
template <class Visit>
void for_each_type(Visit&& visit) {
  for (int code = 0; code < 64; ++code) {
    const LatticePoint q{code & 3, code >> 2 & 3, code >> 4};
    if (((q.i | q.j | q.k) & 1) != 0) visit(q, DiamondStencil::at(q), diamond_of(q));
  }
}

TEST(DiamondStencil, HasTheTetrahedraOfTheDiamond) {
  for_each_type([](LatticePoint, const DiamondStencil& stencil, const Diamond& diamond) {
    ASSERT_EQ(stencil.phase, diamond.phase());
    ASSERT_EQ(stencil.tetrahedron_count, static_cast<std::size_t>(diamond.tetrahedron_count()));
    for (std::size_t slot = 0; slot < stencil.tetrahedron_count; ++slot) {
      const auto corners = diamond.tetrahedron(static_cast<int>(slot));
      EXPECT_EQ(members(stencil, diamond, stencil.tetrahedra[slot]),
                Vertices(corners.begin(), corners.end()));
    }
  });
}

/// A half is a tetrahedron of a child: the split vertex and three vertices of the one it comes from.
TEST(DiamondStencil, HalvesAreTetrahedraOfTheChildren) {
  for_each_type([](LatticePoint, const DiamondStencil& stencil, const Diamond& diamond) {
    std::multiset<Vertices> halves;
    for (std::size_t n = 0; n < 2 * stencil.child_count; ++n) {
      const DiamondStencil::Half& half = stencil.halves[n];
      const LatticePoint step = stencil.children[n / 2];
      const std::int32_t unit = stencil.phase == 2 ? diamond.scale() / 2 : diamond.scale();
      const Diamond child(diamond.point() + unit * step);
      ASSERT_EQ(child.point(), diamond.child(static_cast<int>(n / 2)));
      std::array<LatticePoint, 4> corners;
      for (std::size_t v = 0; v < 4; ++v)
        corners[v] = diamond.point() + diamond.scale() * stencil.offsets[half.vertices[v]];
      bool found = false;
      for (int slot = 0; slot < child.tetrahedron_count(); ++slot)
        found = found || child.tetrahedron(slot) == corners;
      EXPECT_TRUE(found);
      const Vertices whole = members(stencil, diamond, stencil.tetrahedra[half.slot]);
      Vertices part(corners.begin(), corners.end());
      EXPECT_EQ(members(stencil, diamond, half.members), part);
      EXPECT_EQ(part.erase(diamond.point()), 1u);
      for (const LatticePoint p : part) EXPECT_EQ(whole.count(p), 1u);
      halves.insert(members(stencil, diamond, half.members));
    }
    EXPECT_EQ(halves.size(), 2 * stencil.tetrahedron_count);
    EXPECT_EQ(std::set<Vertices>(halves.begin(), halves.end()).size(), halves.size());
  });
}

TEST(DiamondStencil, CountsTheTrianglesOfContours) {
  for_each_type([](LatticePoint, const DiamondStencil& stencil, const Diamond&) {
    const auto triangles = [](unsigned above) { return int{kTetrahedronContours[above].triangle_count}; };
    for (DiamondStencil::Members above = 0; above < 1u << stencil.count; ++above) {
      int added = 0;
      for (std::size_t slot = 0; slot < stencil.tetrahedron_count; ++slot) {
        unsigned bits = 0, next = 0;
        for (std::size_t m = 0; m < stencil.count; ++m) {
          if ((stencil.tetrahedra[slot] >> m & 1) != 0) bits |= (above >> m & 1) << next++;
        }
        added -= triangles(bits);
      }
      unsigned crossed = 0;
      for (std::size_t n = 0; n < 2 * stencil.child_count; ++n) {
        unsigned bits = 0;
        for (std::size_t v = 0; v < 4; ++v) bits |= (above >> stencil.halves[n].vertices[v] & 1) << v;
        added += triangles(bits);
        crossed |= (triangles(bits) > 0 ? 1u : 0u) << n;
      }
      ASSERT_EQ(stencil.added[above], added);
      ASSERT_EQ(stencil.added_in(0xff, above), added);
      ASSERT_EQ(stencil.crossed[above], crossed);
    }
  });
}

}  // namespace
}  // namespace adamas
