#include <gtest/gtest.h>

#include <random>

#include "core/data/cell_contacts.h"
#include "core/data/contact_mesh.h"
#include "core/geometry/tetrahedron.h"
#include "tests/support/closed_surface.h"
#include "tests/support/ownership_problems.h"

namespace adamas {
namespace {

/// How the vertices of a lattice get the values of the functions.
enum class Data {
  kGeneric,
  kZeros,      ///< every third value is zero
  kNearZeros,  ///< every third value is zero up to round-off
  kLabels,     ///< one function per owner, which is 1 at the points with its label, else 0
  kHalves      ///< multiples of one half
};

/// A lattice of n^3 cubes, each of six tetrahedra round its diagonal, with functions that have random values
/// at its points. There are `owners` regions; the function of each is the least of one to three functions.
class RandomLattice {
 public:
  RandomLattice(std::uint64_t seed, std::uint32_t n, std::uint32_t owners, Data data) : n_(n), random_(seed) {
    std::vector<std::uint32_t> labels((n_ + 1) * (n_ + 1) * (n_ + 1));
    for (std::uint32_t& label : labels) label = static_cast<std::uint32_t>(random_() % owners);
    for (std::uint32_t owner = 0; owner < owners; ++owner) {
      std::vector<std::size_t> functions;
      const std::size_t count = data == Data::kLabels ? 1 : 1 + random_() % 3;
      for (std::size_t f = 0; f < count; ++f) {
        functions.push_back(values_.size());
        values_.push_back(random_values(data));
        if (data != Data::kLabels) continue;
        for (std::size_t p = 0; p < labels.size(); ++p) values_.back()[p] = labels[p] == owner ? 1 : 0;
      }
      functions_.push_back(functions);
    }
  }

  [[nodiscard]] Box3 box() const { return {{0, 0, 0}, {1, 1, 1}}; }
  [[nodiscard]] std::uint32_t owners() const { return static_cast<std::uint32_t>(functions_.size()); }
  [[nodiscard]] std::uint32_t point(const std::array<std::uint32_t, 3>& p) const {
    return p[0] + (n_ + 1) * (p[1] + (n_ + 1) * p[2]);
  }
  [[nodiscard]] std::uint32_t last_point() const { return point({n_, n_, n_}); }
  [[nodiscard]] Vec3 position(std::uint32_t p) const {
    const double h = 1.0 / n_;
    return {h * (p % (n_ + 1)), h * (p / (n_ + 1) % (n_ + 1)), h * (p / ((n_ + 1) * (n_ + 1)))};
  }
  [[nodiscard]] OwnershipProblem problem(const std::array<std::uint32_t, 4>& corners) const {
    OwnershipProblem problem;
    for (std::uint32_t owner = 0; owner < owners(); ++owner) {
      problem.add_candidate(owner);
      for (const std::size_t f : functions_[owner]) {
        problem.add_function(
            {values_[f][corners[0]], values_[f][corners[1]], values_[f][corners[2]], values_[f][corners[3]]},
            f);
      }
    }
    return problem;
  }
  /// Calls visit(corners) for all tetrahedra, positively oriented or not.
  template <class Visit>
  void for_each_tetrahedron(Visit&& visit) const {
    std::array<int, 3> path{0, 1, 2};
    for (std::uint32_t k = 0; k < n_; ++k) {
      for (std::uint32_t j = 0; j < n_; ++j) {
        for (std::uint32_t i = 0; i < n_; ++i) {
          do {
            std::array<std::uint32_t, 3> at{i, j, k};
            std::array<std::uint32_t, 4> corners{point(at)};
            for (std::size_t step = 0; step < 3; ++step) {
              ++at[static_cast<std::size_t>(path[step])];
              corners[step + 1] = point(at);
            }
            visit(corners);
          } while (std::next_permutation(path.begin(), path.end()));
        }
      }
    }
  }

 private:
  std::vector<double> random_values(Data data) {
    std::uniform_real_distribution<double> value(-1, 1);
    std::vector<double> values((n_ + 1) * (n_ + 1) * (n_ + 1));
    for (double& v : values) {
      v = value(random_);
      const bool zero = random_() % 3 == 0;
      if (zero && data == Data::kZeros) v = 0;
      if (zero && data == Data::kNearZeros) v *= 1e-15;
      if (data == Data::kHalves) v = 0.5 * std::round(2 * v);
    }
    return values;
  }

  std::uint32_t n_;
  std::mt19937_64 random_;
  std::vector<std::vector<double>> values_;
  std::vector<std::vector<std::size_t>> functions_;
};

struct Extracted {
  InterfaceMesh mesh;
  std::vector<double> volumes;  ///< volumes of the parts
};

Extracted extract(const RandomLattice& lattice) {
  ContactMeshBuilder builder(1e-11);
  Extracted result;
  result.volumes.assign(lattice.owners(), 0);
  lattice.for_each_tetrahedron([&](const std::array<std::uint32_t, 4>& c) {
    OwnershipProblem problem = lattice.problem(c);
    const std::array<Vec3, 4> x{lattice.position(c[0]), lattice.position(c[1]), lattice.position(c[2]),
                                lattice.position(c[3])};
    drop_dominated(problem);
    std::vector<OwnedTetrahedron> parts;
    partition_tetrahedron(problem, parts);
    const double volume = std::abs(signed_volume(x[0], x[1], x[2], x[3]));
    for (const auto& part : parts) result.volumes[part.owner] += volume * volume_fraction(part.corners);
    ContactBuffer buffer;
    buffer.add({c[0], c[1], c[2], c[3]}, x, problem);
    builder.append(buffer);
  });
  result.mesh = builder.finish();
  return result;
}

void expect_laws(const RandomLattice& lattice, Data data) {
  const Extracted found = extract(lattice);
  const auto triangles = test::sided_by_material(found.mesh);
  const auto edges = test::check_edges(found.mesh.points, triangles, lattice.box(), 2e-11);
  ASSERT_GT(edges.inner_edges, 0u);
  EXPECT_EQ(edges.open, 0u) << edges.first;
  EXPECT_EQ(edges.lonely, 0u) << edges.first;
  EXPECT_EQ(edges.degenerate, 0u);
  if (data == Data::kGeneric) {
    EXPECT_EQ(edges.uneven, 0u);
  }
  // Where functions differ by round-off over a whole cell, volumes may differ too.
  if (data == Data::kNearZeros) return;
  // Several owners may own the last point.
  const std::uint32_t far = lattice.last_point();
  const OwnershipProblem last = lattice.problem({far, far, far, far});
  const double greatest = test::brute_owner(last, {1, 0, 0, 0}, 0).value;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t corner = 0; corner < lattice.owners(); ++corner) {
    if (test::candidate_value(last, corner, {1, 0, 0, 0}) < greatest) continue;
    const auto enclosed =
        test::enclosed_volumes(found.mesh.points, triangles, lattice.owners(), lattice.box(), corner, 2e-11);
    double error = 0;
    for (std::size_t owner = 0; owner < enclosed.size(); ++owner)
      error = std::max(error, std::abs(enclosed[owner] - found.volumes[owner]));
    least = std::min(least, error);
  }
  EXPECT_LT(least, 1e-9);
}

void expect_laws_of_many(Data data, int count) {
  for (int seed = 0; seed < count; ++seed) {
    SCOPED_TRACE(seed);
    expect_laws(
        RandomLattice(static_cast<std::uint64_t>(seed), 3, 2 + static_cast<std::uint32_t>(seed % 4), data),
        data);
  }
}

/// Two owners with one function each give the points, the triangles and the features of the general way.
TEST(ContactMesh, TwoOwnersAreOnesOfMany) {
  std::mt19937_64 random(7);
  std::size_t triangles = 0;
  for (int n = 0; n < 400; ++n) {
    OwnershipProblem problem;
    for (std::uint32_t owner = 0; owner < 2; ++owner) {
      problem.add_candidate(owner);
      std::array<double, 4> values{};
      for (double& value : values) value = static_cast<double>(random() % 5) - 2;
      problem.add_function(values, n % 3 == 0 ? 1 - owner : n % 3 == 1 ? owner : 4);
    }
    std::array<Vec3, 4> places{Vec3{0, 0, 0}, Vec3{1, 0.1, 0}, Vec3{0.2, 1, 0}, Vec3{0.1, 0.3, 1}};
    if (n % 2 == 0) std::swap(places[1], places[2]);
    const std::array<std::uint64_t, 4> ids{3, 5, 8, 13};
    std::vector<ContactPolygon> contacts;
    contact_polygons(problem, contacts);
    std::array<ContactBuffer, 2> buffers;
    buffers[0].add(ids, places, problem);
    CellContacts(ids, places, problem, contacts).add_to(buffers[1], ids, places);
    std::array<InterfaceMesh, 2> meshes;
    std::array<std::vector<Digest>, 2> keys;
    for (std::size_t i = 0; i < 2; ++i) {
      ContactMeshBuilder builder(1e-12);
      builder.append(buffers[i]);
      meshes[i] = builder.finish(&keys[i]);
    }
    ASSERT_EQ(meshes[0].triangles, meshes[1].triangles) << n;
    ASSERT_EQ(keys[0], keys[1]) << n;
    ASSERT_EQ(meshes[0].points.size(), meshes[1].points.size()) << n;
    for (std::size_t p = 0; p < meshes[0].points.size(); ++p)
      ASSERT_EQ(distance(meshes[0].points[p], meshes[1].points[p]), 0) << n;
    triangles += meshes[0].triangles.size();
  }
  EXPECT_GT(triangles, 200u);
}

/// Buffers appended at once give what they give one after another, and many cells what they give in one
/// buffer.
TEST(ContactMesh, BuffersMayBeAppendedAtOnce) {
  const RandomLattice lattice(3, 12, 4, Data::kHalves);
  std::vector<ContactBuffer> buffers;
  ContactBuffer joint;
  lattice.for_each_tetrahedron([&](const std::array<std::uint32_t, 4>& c) {
    const OwnershipProblem problem = lattice.problem(c);
    const std::array<Vec3, 4> x{lattice.position(c[0]), lattice.position(c[1]), lattice.position(c[2]),
                                lattice.position(c[3])};
    buffers.emplace_back().add({c[0], c[1], c[2], c[3]}, x, problem);
    joint.add({c[0], c[1], c[2], c[3]}, x, problem);
  });
  std::array<ContactMeshBuilder, 3> builders{ContactMeshBuilder(1e-11), ContactMeshBuilder(1e-11),
                                             ContactMeshBuilder(1e-11)};
  std::vector<const ContactBuffer*> all;
  for (const ContactBuffer& buffer : buffers) {
    builders[0].append(buffer);
    all.push_back(&buffer);
  }
  builders[1].append(all);
  builders[2].append(joint);
  std::array<std::vector<Digest>, 3> keys;
  const InterfaceMesh expected = builders[0].finish(keys.data());
  EXPECT_GT(expected.triangles.size(), 5000u);
  for (std::size_t b = 1; b < 3; ++b) {
    const InterfaceMesh mesh = builders[b].finish(&keys[b]);
    ASSERT_EQ(mesh.triangles, expected.triangles) << b;
    ASSERT_EQ(keys[b], keys[0]) << b;
    for (std::size_t p = 0; p < mesh.points.size(); ++p)
      ASSERT_EQ(distance(mesh.points[p], expected.points[p]), 0) << b;
  }
}

TEST(ContactMesh, RandomLatticesAreClosed) { expect_laws_of_many(Data::kGeneric, 10); }
TEST(ContactMesh, LatticesWithZerosAreClosed) { expect_laws_of_many(Data::kZeros, 10); }
TEST(ContactMesh, LatticesWithNearZerosAreClosed) { expect_laws_of_many(Data::kNearZeros, 10); }
TEST(ContactMesh, LatticesOfLabelsAreClosed) { expect_laws_of_many(Data::kLabels, 10); }
TEST(ContactMesh, LatticesOfHalvesAreClosed) { expect_laws_of_many(Data::kHalves, 10); }

}  // namespace
}  // namespace adamas
