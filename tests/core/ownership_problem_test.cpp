#include "core/geometry/ownership_problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "core/geometry/convex_polyhedron.h"
#include "core/geometry/divider.h"
#include "core/geometry/tetrahedron.h"
#include "tests/support/ownership_problems.h"
#include "tests/support/tetrahedron_faces.h"

namespace adamas {
namespace {

using test::ProblemTraits;

constexpr std::array<ProblemTraits, 4> kTraits{{{false, false}, {true, false}, {false, true}, {true, true}}};

/// Runs a check on random problems of all kinds.
template <class Check>
void on_random_problems(std::uint64_t seed, int count, Check&& check) {
  std::mt19937_64 random(seed);
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE(i);
    const OwnershipProblem problem = test::random_problem(random, kTraits[static_cast<std::size_t>(i) % 4]);
    check(problem, random);
    if (testing::Test::HasFatalFailure()) return;
  }
}

/// Returns the place of a point of the unit tetrahedron: the weights of the last three vertices.
Vec3 place(const Weights& w) { return {w[1], w[2], w[3]}; }

Weights weights_at(const Vec3& p) { return {1 - p.x - p.y - p.z, p.x, p.y, p.z}; }

std::map<std::uint32_t, double> volumes(const OwnershipProblem& problem) {
  std::vector<OwnedTetrahedron> parts;
  partition_tetrahedron(problem, parts);
  std::map<std::uint32_t, double> result;
  for (const OwnedTetrahedron& part : parts) result[part.owner] += volume_fraction(part.corners);
  return result;
}

void expect_volumes_add_up(const OwnershipProblem& problem) {
  double sum = 0;
  for (const auto& [owner, volume] : volumes(problem)) {
    ASSERT_GE(volume, -1e-15);
    sum += volume;
  }
  ASSERT_NEAR(sum, 1, 1e-13);
}

Vec3 area_vector(const std::vector<Vec3>& polygon) {
  Vec3 sum;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    sum += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * sum;
}

std::vector<Vec3> places(const std::vector<Weights>& polygon) {
  std::vector<Vec3> result;
  for (const Weights& w : polygon) result.push_back(place(w));
  return result;
}

std::vector<Vec3> places(const ContactPolygon& polygon) {
  std::vector<Vec3> result;
  for (const auto& corner : polygon.corners) result.push_back(place(corner.weights));
  return result;
}

TEST(Partition, VolumesAddUp) {
  on_random_problems(
      1, 400, [](const OwnershipProblem& problem, std::mt19937_64&) { expect_volumes_add_up(problem); });
}

/// The volumes add up also where functions are equal up to round-off, at vertices or everywhere.
TEST(Partition, VolumesOfNearTiesAddUp) {
  on_random_problems(11, 8000, [](const OwnershipProblem& problem, std::mt19937_64& random) {
    OwnershipProblem near = problem;
    for (LinearFunction& f : near.functions) {
      for (double& value : f.values) {
        constexpr std::array<double, 4> kShifts{0, 1e-13, -1e-15, 4e-16};
        value = std::round(4 * value) / 4 + kShifts[random() % 4];
      }
    }
    expect_volumes_add_up(near);
  });
}

TEST(Partition, PartsBelongToTheGreatestOfTheLeast) {
  std::size_t certain = 0;
  on_random_problems(2, 160, [&](const OwnershipProblem& problem, std::mt19937_64& random) {
    std::vector<OwnedTetrahedron> parts;
    partition_tetrahedron(problem, parts);
    for (const OwnedTetrahedron& part : parts) {
      if (volume_fraction(part.corners) < 1e-9) continue;
      for (int i = 0; i < 4; ++i) {
        const Weights inner = test::random_weights(random);
        Weights w{};
        for (std::size_t c = 0; c < 4; ++c) {
          for (std::size_t v = 0; v < 4; ++v) w[v] += inner[c] * part.corners[c][v];
        }
        const auto brute = test::brute_owner(problem, w, 1e-10);
        certain += brute.certain ? 1 : 0;
        if (brute.certain) {
          ASSERT_EQ(part.owner, brute.owner);
        }
      }
    }
  });
  EXPECT_GT(certain, 2000u);
}

TEST(Partition, OwnersOfPointsAreThoseOfBruteForce) {
  on_random_problems(3, 4000, [](const OwnershipProblem& problem, std::mt19937_64& random) {
    OwnershipProblem fewer = problem;
    drop_dominated(fewer);
    const OwnershipProblem other = test::shuffled(problem, random);
    for (int i = 0; i < 10; ++i) {
      Weights w = test::random_weights(random);
      if (i < 4) w = Weights{}, w[static_cast<std::size_t>(i)] = 1;
      const auto brute = test::brute_owner(problem, w, 0);
      ASSERT_EQ(problem.owner(w), brute.owner);
      ASSERT_EQ(fewer.owner(w), brute.owner);
      ASSERT_EQ(other.owner(w), brute.owner);
    }
  });
}

TEST(Partition, HighFunctionsAreNowhereTheLeast) {
  std::size_t dropped = 0;
  on_random_problems(6, 2000, [&](const OwnershipProblem& problem, std::mt19937_64& random) {
    OwnershipProblem fewer = problem;
    drop_high_functions(fewer);
    ASSERT_EQ(fewer.candidates.size(), problem.candidates.size());
    dropped += problem.functions.size() - fewer.functions.size();
    for (int i = 0; i < 10; ++i) {
      Weights w = test::random_weights(random);
      if (i < 4) w = Weights{}, w[static_cast<std::size_t>(i)] = 1;
      for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
        ASSERT_EQ(fewer.candidates[c].owner, problem.candidates[c].owner);
        ASSERT_EQ(fewer.value(fewer.candidates[c], w), problem.value(problem.candidates[c], w));
      }
      ASSERT_EQ(fewer.owner(w), problem.owner(w));
    }
  });
  EXPECT_GT(dropped, 500u);
}

TEST(Partition, TheOrderOfCandidatesChangesNothing) {
  on_random_problems(4, 120, [](const OwnershipProblem& problem, std::mt19937_64& random) {
    const OwnershipProblem other = test::shuffled(problem, random);
    auto mine = volumes(problem), its = volumes(other);
    OwnershipProblem fewer = problem;
    drop_dominated(fewer);
    auto left = volumes(fewer);
    for (const auto& candidate : problem.candidates) {
      ASSERT_NEAR(mine[candidate.owner], its[candidate.owner], 1e-13);
      ASSERT_NEAR(mine[candidate.owner], left[candidate.owner], 1e-13);
    }
  });
}

/// Candidates that are left out of a problem owned nothing.
TEST(Partition, KeptOwnersOwnTheSame) {
  std::size_t fewer = 0;
  on_random_problems(10, 400, [&](const OwnershipProblem& problem, std::mt19937_64& random) {
    OwnershipProblem kept = problem;
    keep_owners(kept);
    fewer += kept.functions.size() < problem.functions.size() ? 1 : 0;
    auto mine = volumes(problem), its = volumes(kept);
    for (const auto& candidate : problem.candidates)
      ASSERT_NEAR(mine[candidate.owner], its[candidate.owner], 1e-13);
    for (int i = 0; i < 20; ++i) {
      const Weights w = test::random_weights(random);
      ASSERT_EQ(kept.owner(w), problem.owner(w));
    }
    std::vector<ContactPolygon> all, some;
    contact_polygons(problem, all);
    contact_polygons(kept, some);
    const auto area = [](const std::vector<ContactPolygon>& contacts) {
      double sum = 0;
      for (const ContactPolygon& c : contacts) sum += norm(area_vector(places(c)));
      return sum;
    };
    ASSERT_NEAR(area(all), area(some), 1e-12);
  });
  EXPECT_GT(fewer, 200u);
}

/// Returns a problem of two to four candidates with one function each; many values are equal.
OwnershipProblem simple_problem(std::mt19937_64& random) {
  OwnershipProblem problem;
  const std::size_t count = 2 + random() % 3;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<double, 4> values{};
    for (double& value : values)
      value = random() % 3 == 0 ? static_cast<double>(random() % 3) - 1
                                : static_cast<double>(random() % 2001) / 1000 - (i < 2 ? 1 : 1.8);
    problem.add_candidate(static_cast<std::uint32_t>(i));
    problem.add_function(values, 10 - 3 * i + random() % 3);
  }
  return problem;
}

/// Most problems are between two candidates with one function each, for which there is a short way.
TEST(Partition, TwoCandidatesGetTheSameTetrahedraTheShortWay) {
  std::mt19937_64 random(17);
  Divider<ConvexPolyhedron> divider;
  for (int i = 0; i < 20000; ++i) {
    const OwnershipProblem problem = simple_problem(random);
    std::vector<OwnedTetrahedron> found, wanted;
    partition_tetrahedron(problem, found);
    divider.divide(problem, ConvexPolyhedron::unit(),
                   [&](std::uint32_t owner, const ConvexPolyhedron& part, const auto&) {
                     part.for_each_tetrahedron([&](const std::array<Weights, 4>& corners) {
                       wanted.push_back({owner, corners});
                     });
                   });
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t t = 0; t < found.size(); ++t) {
      ASSERT_EQ(found[t].owner, wanted[t].owner);
      ASSERT_EQ(found[t].corners, wanted[t].corners);
    }
  }
}

/// Candidates that own a part are kept, and those that own and touch nothing are not.
TEST(Partition, KeptOwnersOfSimpleProblemsAreThoseWithParts) {
  std::mt19937_64 random(18);
  for (int i = 0; i < 5000; ++i) {
    const OwnershipProblem problem = simple_problem(random);
    OwnershipProblem kept = problem;
    keep_owners(kept);
    std::vector<std::uint32_t> owners;
    for (const auto& candidate : kept.candidates) {
      ASSERT_EQ(candidate.count, 1u);
      ASSERT_EQ(kept.functions[candidate.first].values,
                problem.functions[problem.candidates[candidate.owner].first].values);
      owners.push_back(candidate.owner);
    }
    ASSERT_TRUE(std::is_sorted(owners.begin(), owners.end()));
    for (const auto& [owner, volume] : volumes(problem)) {
      if (volume > 1e-9) {
        ASSERT_TRUE(std::binary_search(owners.begin(), owners.end(), owner));
      }
    }
  }
}

TEST(Partition, PolygonsAreDividedLikeTheTetrahedron) {
  on_random_problems(5, 2000, [](const OwnershipProblem& problem, std::mt19937_64& random) {
    const Weights a = test::random_weights(random), b = test::random_weights(random),
                  c = test::random_weights(random);
    Weights d{};
    for (std::size_t v = 0; v < 4; ++v) d[v] = 0.6 * a[v] + 0.7 * c[v] - 0.3 * b[v];
    const std::vector<Weights> polygon{a, b, c, d};
    std::vector<OwnedPolygon> parts;
    partition_polygon(problem, polygon, parts);
    const Vec3 whole = area_vector(places(polygon));
    Vec3 sum;
    for (const OwnedPolygon& part : parts) {
      const auto corners = places(part.corners);
      const Vec3 area = area_vector(corners);
      sum += area;
      // Polygons are convex and have the orientation of the whole contact.
      ASSERT_GE(dot(area, whole), -1e-14);
      if (norm(area) < 1e-7) continue;
      std::exponential_distribution<double> weight;
      Vec3 p;
      double total = 0;
      for (const Vec3& corner : corners) {
        const double w = weight(random);
        p += w * corner;
        total += w;
      }
      const auto brute = test::brute_owner(problem, weights_at((1 / total) * p), 1e-10);
      if (brute.certain) {
        ASSERT_EQ(part.owner, brute.owner);
      }
    }
    ASSERT_LT(norm(sum - whole), 1e-13);
  });
}

/// The contacts of each owner together with its share of the faces are closed, and enclose the volume of its
/// parts.
void expect_enclosed_parts(const OwnershipProblem& problem) {
  std::map<std::uint32_t, Vec3> closure;
  std::map<std::uint32_t, double> enclosed;
  const auto add = [&](std::uint32_t owner, const std::vector<Vec3>& polygon, double sign) {
    const Vec3 area = sign * area_vector(polygon);
    closure[owner] += area;
    enclosed[owner] += 2 * dot(polygon.front(), area);  // a third of six times the volume
  };
  for (std::size_t opposite = 0; opposite < 4; ++opposite) {
    std::vector<OwnedPolygon> parts;
    partition_polygon(problem, test::outward_face(opposite), parts);
    for (const OwnedPolygon& part : parts) add(part.owner, places(part.corners), 1);
  }
  std::vector<ContactPolygon> contacts;
  contact_polygons(problem, contacts);
  for (const ContactPolygon& contact : contacts) {
    ASSERT_GE(contact.corners.size(), 3u);
    ASSERT_NE(contact.front, contact.back);
    add(contact.back, places(contact), 1);
    add(contact.front, places(contact), -1);
  }
  auto parts = volumes(problem);
  for (const auto& candidate : problem.candidates) {
    ASSERT_LT(norm(closure[candidate.owner]), 1e-12);
    ASSERT_NEAR(enclosed[candidate.owner], parts[candidate.owner], 1e-12);
  }
}

TEST(ContactPolygons, FacesAndContactsEncloseTheParts) {
  on_random_problems(
      6, 160, [](const OwnershipProblem& problem, std::mt19937_64&) { expect_enclosed_parts(problem); });
}

TEST(ContactPolygons, LieWhereTheirOwnersAreEqualAndGreatest) {
  std::size_t points = 0;
  on_random_problems(7, 400, [&](const OwnershipProblem& problem, std::mt19937_64& random) {
    std::vector<ContactPolygon> contacts;
    contact_polygons(problem, contacts);
    std::exponential_distribution<double> weight;
    for (const ContactPolygon& contact : contacts) {
      Weights w{};
      double total = 0;
      for (const auto& corner : contact.corners) {
        const double part = weight(random);
        total += part;
        for (std::size_t v = 0; v < 4; ++v) w[v] += part * corner.weights[v];
      }
      for (double& x : w) x /= total;
      double greatest = -1e300, front = 0, back = 0;
      for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
        const double value = test::candidate_value(problem, c, w);
        greatest = std::max(greatest, value);
        if (problem.candidates[c].owner == contact.front) front = value;
        if (problem.candidates[c].owner == contact.back) back = value;
      }
      ASSERT_NEAR(front, greatest, 1e-12);
      ASSERT_NEAR(back, greatest, 1e-12);
      ++points;
    }
  });
  EXPECT_GT(points, 1000u);
}

/// Returns whether a line through the tetrahedron crosses a polygon: 1 inside, 0 at its border or nearly
/// there, -1 not at all. `t` becomes the place of the crossing.
int passes(const std::vector<Vec3>& polygon, const Vec3& from, const Vec3& to, double& t) {
  const Vec3 area = area_vector(polygon);
  const double a = dot(from - polygon[0], area), b = dot(to - polygon[0], area);
  if (norm(area) < 1e-10 || std::abs(a - b) < 1e-9 * norm(area)) return 0;
  t = a / (a - b);
  const Vec3 p = from + t * (to - from);
  double least = 1e300;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &u = polygon[i], &v = polygon[(i + 1) % polygon.size()];
    if (distance(u, v) < 1e-12) continue;
    least = std::min(least, dot(cross(v - u, p - u), area) / (norm(area) * distance(u, v)));
  }
  return t <= 0 || t >= 1 || least < -1e-8 ? -1 : least > 1e-8 ? 1 : 0;
}

/// What each owner gains at a place on a line. Functions with the same values have parts without thickness
/// between them, so that a line may cross several contacts at one place.
struct Net {
  double t;
  std::map<std::uint32_t, int> gained;
};

void count(std::vector<Net>& nets, double t, std::uint32_t before, std::uint32_t after) {
  auto found =
      std::find_if(nets.begin(), nets.end(), [t](const Net& net) { return std::abs(net.t - t) < 1e-8; });
  if (found == nets.end()) found = nets.insert(nets.end(), {t, {}});
  --found->gained[before];
  ++found->gained[after];
}

/// Along random lines the owners, found by brute force, change where the line crosses a contact between the
/// two, and nowhere else.
TEST(ContactPolygons, AreWhatLinesCross) {
  std::size_t crossings = 0;
  on_random_problems(8, 500, [&](const OwnershipProblem& problem, std::mt19937_64& random) {
    std::vector<ContactPolygon> contacts;
    contact_polygons(problem, contacts);
    std::vector<std::vector<Vec3>> polygons;
    for (const ContactPolygon& contact : contacts) polygons.push_back(places(contact));
    for (int line = 0; line < 10; ++line) {
      const Weights from = test::random_weights(random), to = test::random_weights(random);
      bool doubtful = false;
      std::vector<Net> nets;
      for (const auto& change : test::owner_changes(problem, from, to, doubtful))
        count(nets, change.t, change.before, change.after);
      for (std::size_t c = 0; c < contacts.size() && !doubtful; ++c) {
        double t = 0;
        const int side = passes(polygons[c], place(from), place(to), t);
        if (side == 0) doubtful = true;
        if (side <= 0) continue;
        const bool to_front = dot(place(to) - place(from), area_vector(polygons[c])) > 0;
        // The changes that brute force has counted are subtracted.
        count(nets, t, to_front ? contacts[c].front : contacts[c].back,
              to_front ? contacts[c].back : contacts[c].front);
        ++crossings;
      }
      if (doubtful) continue;
      for (const Net& net : nets) {
        for (const auto& [owner, sum] : net.gained) ASSERT_EQ(sum, 0) << "owner " << owner << " at " << net.t;
      }
    }
  });
  EXPECT_GT(crossings, 1000u);
}

/// The area vectors between pairs of owners, towards the greater one, and the total areas.
using Areas = std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<Vec3, double>>;

Areas contact_areas(const std::vector<ContactPolygon>& contacts) {
  Areas result;
  for (const ContactPolygon& contact : contacts) {
    const Vec3 area = area_vector(places(contact));
    auto& [towards, all] = result[std::minmax(contact.front, contact.back)];
    towards += contact.front < contact.back ? -area : area;
    all += norm(area);
  }
  return result;
}

Areas contact_areas(const OwnershipProblem& problem) {
  std::vector<ContactPolygon> contacts;
  contact_polygons(problem, contacts);
  return contact_areas(contacts);
}

void expect_same_areas(Areas mine, Areas its) {
  its.insert(mine.begin(), mine.end());
  for (const auto& [pair, area] : its) {
    ASSERT_LT(norm(area.first - mine[pair].first), 1e-12);
    ASSERT_NEAR(area.second, mine[pair].second, 1e-12);
  }
}

TEST(ContactPolygons, TheOrderOfCandidatesChangesNothing) {
  on_random_problems(9, 300, [](const OwnershipProblem& problem, std::mt19937_64& random) {
    expect_same_areas(contact_areas(problem), contact_areas(test::shuffled(problem, random)));
  });
}

/// Where there are many functions only some pairs are tried. Further candidates that own nothing make many
/// functions, and do not change the contacts.
TEST(ContactPolygons, AreTheSameOfManyFunctions) {
  on_random_problems(10, 400, [](const OwnershipProblem& problem, std::mt19937_64&) {
    OwnershipProblem crowded = problem;
    for (std::uint32_t i = 0; i < 50; ++i) {
      crowded.add_candidate(1000 + i);
      for (std::uint32_t k = 0; k < 4; ++k)
        crowded.add_function({-10.0 - i, -10.0 - k, -20.0 + 0.1 * i, -30.0}, 100000 + 4 * i + k);
    }
    expect_same_areas(contact_areas(problem), contact_areas(crowded));
  });
}

/// Returns a problem of some hundred candidates with up to four functions each, about half of which own
/// something: each has what is nearest to its site, less what its other functions cut off. `ties`: sites are
/// on a lattice, so that many candidates are equal at points and on lines.
OwnershipProblem foam_problem(std::mt19937_64& random, bool ties) {
  OwnershipProblem problem;
  std::uniform_real_distribution<double> coordinate(-0.25, 1), slope(-0.1, 0.1);
  for (std::uint32_t i = 0; i < 300; ++i) {
    Vec3 site{coordinate(random), coordinate(random), coordinate(random)};
    if (ties) site = {std::round(8 * site.x) / 8, std::round(8 * site.y) / 8, std::round(8 * site.z) / 8};
    const double at_origin = -dot(site, site);
    problem.add_candidate(i);
    for (std::uint64_t k = 0; k < 1 + random() % 4; ++k) {
      std::array<double, 4> values{at_origin, at_origin + 2 * site.x, at_origin + 2 * site.y,
                                   at_origin + 2 * site.z};
      for (double& value : values)
        value += k == 0 ? 0 : ties ? std::round(20 * slope(random)) / 16 : slope(random);
      problem.add_function(values, 4 * ((i * 7) % 300) + k);
    }
  }
  return problem;
}

/// With hundreds of candidates each part is compared with few of them. What is kept has the same owners and
/// contacts as all candidates, by brute force at points.
TEST(Partition, HundredsOfCandidatesOwnTheSameWhenFewAreCompared) {
  std::mt19937_64 random(21);
  for (int i = 0; i < 6; ++i) {
    SCOPED_TRACE(i);
    const OwnershipProblem problem = foam_problem(random, i % 2 == 1);
    OwnershipProblem kept = problem;
    keep_owners(kept);
    ASSERT_GT(kept.candidates.size(), 40u);
    ASSERT_LT(kept.candidates.size(), 200u);
    ASSERT_GT(kept.functions.size(), 80u);
    for (int k = 0; k < 2000; ++k) {
      const Weights w = test::random_weights(random);
      ASSERT_EQ(kept.owner(w), test::brute_owner(problem, w, 0).owner);
    }
    expect_volumes_add_up(kept);
    auto mine = volumes(problem), its = volumes(kept);
    for (const auto& candidate : problem.candidates)
      ASSERT_NEAR(mine[candidate.owner], its[candidate.owner], 1e-13);
    expect_enclosed_parts(kept);
    expect_same_areas(contact_areas(problem), contact_areas(kept));
    expect_same_areas(contact_areas(kept), contact_areas(test::shuffled(kept, random)));
  }
}

/// One division for what owns something and for where it touches leaves the same problem, and shows the same
/// contacts as a division of what is left.
TEST(ContactPolygons, AreTheSameAsOfWhatIsKept) {
  const auto expect_same = [](const OwnershipProblem& problem) {
    OwnershipProblem kept = problem, at_once = problem;
    keep_owners(kept);
    std::vector<ContactPolygon> contacts;
    keep_owners(at_once, contacts);
    const auto of_candidate = [](const auto& c) { return std::tuple(c.owner, c.first, c.count); };
    const auto of_function = [](const LinearFunction& f) { return std::pair(f.key, f.values); };
    ASSERT_TRUE(std::ranges::equal(kept.candidates, at_once.candidates, {}, of_candidate, of_candidate));
    ASSERT_TRUE(std::ranges::equal(kept.functions, at_once.functions, {}, of_function, of_function));
    expect_same_areas(contact_areas(kept), contact_areas(contacts));
  };
  on_random_problems(11, 400,
                     [&](const OwnershipProblem& problem, std::mt19937_64&) { expect_same(problem); });
  std::mt19937_64 random(22);
  for (int i = 0; i < 6; ++i) expect_same(foam_problem(random, i % 2 == 1));
}

}  // namespace
}  // namespace adamas
