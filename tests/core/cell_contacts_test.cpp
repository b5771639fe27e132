#include "core/data/cell_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/geometry/tetrahedron.h"

namespace adamas {
namespace {

using Ids = std::array<std::uint64_t, 4>;
using Positions = std::array<Vec3, 4>;
constexpr std::uint64_t kNone = ContactBuffer::kNoFunction;

struct Polygon {
  std::uint32_t front, back;
  std::vector<ContactBuffer::Corner> corners;
};

std::vector<Polygon> polygons_of(const ContactBuffer& buffer) {
  std::vector<Polygon> result;
  buffer.for_each_polygon([&](std::uint32_t front, std::uint32_t back, auto corners) {
    result.push_back({front, back, {corners.begin(), corners.end()}});
  });
  return result;
}

std::vector<Polygon> polygons_of(const CellContacts& contacts, const Ids& ids, const Positions& positions) {
  ContactBuffer buffer;
  contacts.add_to(buffer, ids, positions);
  return polygons_of(buffer);
}

/// The digest of a feature whose zeros follow the order of `ids`.
Digest digest_of(const Ids& ids, unsigned zeros, std::span<const std::uint64_t> functions) {
  Ids sorted = ids;
  std::ranges::sort(sorted);
  unsigned sorted_zeros = 0;
  for (std::size_t v = 0; v < 4; ++v) {
    const auto place = std::ranges::find(sorted, ids[v]) - sorted.begin();
    if ((zeros >> v & 1u) != 0) sorted_zeros |= 1u << place;
  }
  return ContactBuffer::digest(sorted, static_cast<std::uint8_t>(sorted_zeros), functions);
}

/// Expects the corners of a polygon, from any one on, in one direction or the other.
void expect_corners(const std::vector<ContactBuffer::Corner>& found, const ContactPolygon& expected,
                    const Ids& ids, const Positions& positions, bool mirrored) {
  const std::size_t count = expected.corners.size();
  ASSERT_EQ(found.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = mirrored ? count - 1 - i : i;
    const auto& corner = expected.corners[at];
    const auto& edge = expected.corners[mirrored ? (at + count - 1) % count : at];
    Vec3 position;
    for (std::size_t v = 0; v < 4; ++v) position += corner.weights[v] * positions[v];
    EXPECT_EQ(found[i].key, digest_of(ids, corner.zero_weights, corner.functions));
    EXPECT_EQ(found[i].leaving, digest_of(ids, edge.line_zero_weights, edge.line_functions));
    EXPECT_LT(distance(found[i].position, position), 1e-15);
  }
}

std::size_t crowded_corners(const std::vector<Polygon>& polygons) {
  std::size_t count = 0;
  for (const Polygon& polygon : polygons)
    count +=
        static_cast<std::size_t>(std::ranges::count(polygon.corners, true, &ContactBuffer::Corner::crowded));
  return count;
}

OwnershipProblem random_problem(std::mt19937_64& random, std::uint32_t owners, std::size_t most_functions) {
  OwnershipProblem problem;
  std::uint64_t key = 0;
  for (std::uint32_t owner = 0; owner < owners; ++owner) {
    problem.add_candidate(3 * owner);
    for (std::size_t f = 1 + random() % most_functions; f > 0; --f) {
      std::array<double, 4> values{};
      for (double& value : values)
        value = static_cast<double>(random() % 9) - 4 + 1e-10 * static_cast<double>(random() % 3);
      problem.add_function(values, 7 * key++);
    }
  }
  return problem;
}

/// What is held of the polygons of random problems is what contact_polygons() says of them.
TEST(CellContacts, HoldThePolygonsOfAProblem) {
  std::mt19937_64 random(11);
  std::size_t sections = 0, corners = 0;
  for (int n = 0; n < 3000; ++n) {
    const bool simple = n % 3 == 0;
    OwnershipProblem problem =
        random_problem(random, simple ? 2 : 2 + static_cast<std::uint32_t>(random() % 5), simple ? 1 : 3);
    keep_owners(problem);
    std::vector<ContactPolygon> contacts;
    contact_polygons(problem, contacts);
    Positions positions{Vec3{0, 0, 0}, Vec3{1, 0.1, 0}, Vec3{0.2, 1, 0}, Vec3{0.1, 0.3, 1}};
    const bool mirrored = n % 2 == 0;
    if (mirrored) std::swap(positions[1], positions[2]);
    Ids ids{3, 5, 8, 13};
    std::ranges::shuffle(ids, random);
    const CellContacts held(ids, positions, problem, contacts);
    ASSERT_EQ(held.polygon_count(), contacts.size());
    EXPECT_EQ(held.empty(), contacts.empty());
    const std::vector<Polygon> found = polygons_of(held, ids, positions);
    ASSERT_EQ(found.size(), contacts.size());
    std::size_t count = 0;
    for (std::size_t p = 0; p < found.size(); ++p) {
      EXPECT_EQ(found[p].front, contacts[p].front);
      EXPECT_EQ(found[p].back, contacts[p].back);
      expect_corners(found[p].corners, contacts[p], ids, positions, mirrored);
      count += found[p].corners.size();
    }
    EXPECT_EQ(held.corner_count(), count);
    corners += count;
    if (problem.functions.size() == 2 && contacts.size() == 1) ++sections;
    // The buffer's own way for two functions does without CellContacts; corners may begin elsewhere.
    ContactBuffer buffer;
    buffer.add(ids, positions, problem);
    EXPECT_EQ(crowded_corners(polygons_of(buffer)), crowded_corners(found));
  }
  EXPECT_GT(sections, 500u);
  EXPECT_GT(corners, 10000u);
}

/// Polygons are the same ones wherever their corners are, and others if a function or an owner is another
/// one.
TEST(CellContacts, TellTheSamePolygons) {
  std::mt19937_64 random(5);
  const Ids ids{1, 2, 3, 4};
  const Positions positions{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  std::size_t compared = 0;
  for (int n = 0; n < 200; ++n) {
    OwnershipProblem problem = random_problem(random, n % 2 == 0 ? 2 : 4, n % 2 == 0 ? 1 : 2);
    keep_owners(problem);
    std::vector<ContactPolygon> contacts;
    contact_polygons(problem, contacts);
    if (contacts.empty()) continue;
    const CellContacts held(ids, positions, problem, contacts);
    const std::vector<CellContacts> copies(2, held);
    EXPECT_TRUE(copies[1].has_polygons_of(held));
    EXPECT_FALSE(held.has_polygons_of({}));
    std::vector<ContactPolygon> moved = contacts;
    for (auto& corner : moved.back().corners) std::ranges::reverse(corner.weights);
    EXPECT_TRUE(held.has_polygons_of(CellContacts(ids, positions, problem, moved)));
    std::vector<ContactPolygon> other = contacts;
    other.back().back += 1;
    EXPECT_FALSE(held.has_polygons_of(CellContacts(ids, positions, problem, other)));
    other = contacts;
    other.front().corners.front().functions[0] += 1;
    EXPECT_FALSE(held.has_polygons_of(CellContacts(ids, positions, problem, other)));
    ++compared;
  }
  EXPECT_GT(compared, 100u);
}

/// More features than 16 bits number are held too.
TEST(CellContacts, HoldMoreFeaturesThan16BitsNumber) {
  const Ids ids{2, 1, 4, 3};
  const Positions positions{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  OwnershipProblem problem;
  for (std::uint32_t owner = 0; owner < 3; ++owner) {
    problem.add_candidate(owner);
    problem.add_function({0, 0, 0, 0}, owner);
  }
  constexpr std::uint64_t kPolygons = 25000;
  std::vector<ContactPolygon> contacts(kPolygons);
  for (std::uint64_t p = 0; p < kPolygons; ++p) {
    contacts[p].front = static_cast<std::uint32_t>(p % 2);
    contacts[p].back = 2;
    for (std::uint64_t c = 0; c < 3; ++c) {
      const double w = static_cast<double>(3 * p + c) / (3 * kPolygons);
      contacts[p].corners.push_back(
          {{w, 1 - w, 0, 0}, {3 * p + c, 1u << 20, 1u << 21, kNone}, 0, {p, 3 * p + c, kNone}, 2});
    }
  }
  const std::vector<Polygon> found =
      polygons_of(CellContacts(ids, positions, problem, contacts), ids, positions);
  ASSERT_EQ(found.size(), kPolygons);
  for (std::size_t p = 0; p < kPolygons; ++p)
    expect_corners(found[p].corners, contacts[p], ids, positions, false);
}

}  // namespace
}  // namespace adamas
