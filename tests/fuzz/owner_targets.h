#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <string_view>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/error.h"
#include "core/data/contact_mesh.h"
#include "core/geometry/ownership_problem.h"
#include "tests/fuzz/require.h"
#include "tests/support/tetrahedron_faces.h"

/// Tests who owns what in two tetrahedra that share a face, for values made of any bytes.
namespace adamas::fuzz {

/// Makes problems of bytes. Too few bytes are bad input.
class OwnerBytes {
 public:
  /// With `near_ties` values may differ by round-off; otherwise they differ by at least as much as signed
  /// distances do.
  OwnerBytes(std::string_view bytes, bool near_ties) : bytes_(bytes), near_ties_(near_ties) {}

  [[nodiscard]] std::uint8_t byte() {
    if (bytes_.empty()) fail("expected more bytes, found none");
    const auto result = static_cast<std::uint8_t>(bytes_.front());
    bytes_.remove_prefix(1);
    return result;
  }

  /// Returns a value: often zero, an earlier one, or a neighbour of an earlier one.
  [[nodiscard]] double value() {
    const std::uint8_t code = byte();
    const double sign = (code & 1u) != 0 ? -1 : 1;
    double result = 0;
    switch (code >> 1 & 7u) {
      case 0:
        break;
      case 1:
        result = sign * (code >> 4) / 4;
        break;
      case 2:
        result = earlier(code >> 4);
        break;
      case 3:
        result = earlier(code >> 4);
        result = near_ties_ ? std::nextafter(result, sign * 4) : result + sign * kGrain;
        break;
      case 4:
        result = sign * (1 + (code >> 4)) * kGrain;
        break;
      default:
        result = sign * (byte() * 256 + byte()) / 65536.0;
    }
    values_.push_back(result);
    return result;
  }

 private:
  static constexpr double kGrain = 0x1p-40;

  [[nodiscard]] double earlier(std::size_t back) const {
    return values_.empty() ? 0 : values_[values_.size() - 1 - back % values_.size()];
  }

  std::string_view bytes_;
  bool near_ties_;
  std::vector<double> values_;
};

/// Returns the magnitude of all values of a problem: huge, so small that they are denormal, or neither.
inline double owner_scale(std::uint8_t code) {
  constexpr std::array<double, 4> kScales{1, 1e-30, 0x1p990, 0x1p-1060};
  return kScales[code % kScales.size()];
}

/// Two tetrahedra with common vertices 0, 1, 2 and a fourth vertex of their own, with the same functions.
struct OwnerPair {
  OwnershipProblem first, second;
  bool near_ties = false;  ///< some values may differ by round-off alone
};

inline OwnerPair owner_pair(std::string_view text) {
  if (text.empty()) fail("expected more bytes, found none");
  OwnerPair pair;
  const auto kind = static_cast<std::uint8_t>(text.front());
  pair.near_ties = kind >= 192;
  OwnerBytes bytes(text.substr(1), pair.near_ties);
  const double scale = owner_scale(kind);
  const std::uint32_t candidates = 1 + bytes.byte() % 6u;
  std::uint64_t number = 0;
  for (std::uint32_t c = 0; c < candidates; ++c) {
    pair.first.add_candidate(c);
    pair.second.add_candidate(c);
    const std::uint32_t functions = 1 + bytes.byte() % 4u;
    for (std::uint32_t f = 0; f < functions; ++f) {
      const std::uint64_t key = std::uint64_t{bytes.byte()} << 8 | number++;
      std::array<double, 4> values{};
      for (double& v : values) v = scale * bytes.value();
      pair.first.add_function(values, key);
      values[3] = scale * bytes.value();
      pair.second.add_function(values, key);
    }
  }
  return pair;
}

/// Returns the problem with candidates and functions in the opposite order.
inline OwnershipProblem backwards(const OwnershipProblem& problem) {
  OwnershipProblem result;
  for (auto c = problem.candidates.rbegin(); c != problem.candidates.rend(); ++c) {
    result.add_candidate(c->owner);
    for (std::uint32_t f = c->count; f-- > 0;) {
      const LinearFunction& function = problem.functions[c->first + f];
      result.add_function(function.values, function.key);
    }
  }
  return result;
}

/// Returns a place in the unit tetrahedron.
inline Vec3 owner_place(const Weights& w) { return {w[1], w[2], w[3]}; }

/// Sums by owner: volumes of parts, and the area vectors and enclosed volumes of the surfaces round them.
struct OwnerSums {
  std::map<std::uint32_t, double> volumes, enclosed;
  std::map<std::uint32_t, Vec3> areas;

  void add_surface(std::uint32_t owner, const std::vector<Vec3>& polygon, double sign) {
    Vec3 area;
    for (std::size_t i = 0; i < polygon.size(); ++i)
      area += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
    areas[owner] += 0.5 * sign * area;
    // The sum is six times the volume, a third of height times area.
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
      enclosed[owner] += sign * dot(polygon[0], cross(polygon[i], polygon[i + 1]));
  }
};

template <class Corners>
std::vector<Vec3> owner_places(const Corners& corners) {
  std::vector<Vec3> places;
  for (const Weights& w : corners) places.push_back(owner_place(w));
  return places;
}

inline OwnerSums owner_sums(const OwnershipProblem& problem) {
  OwnerSums sums;
  std::vector<OwnedTetrahedron> parts;
  partition_tetrahedron(problem, parts);
  for (const OwnedTetrahedron& part : parts) {
    const double volume = volume_fraction(part.corners);
    require(volume >= -1e-9, "a part that is inside out");
    sums.volumes[part.owner] += volume;
  }
  for (std::size_t opposite = 0; opposite < 4; ++opposite) {
    std::vector<OwnedPolygon> pieces;
    partition_polygon(problem, test::outward_face(opposite), pieces);
    for (const OwnedPolygon& piece : pieces) sums.add_surface(piece.owner, owner_places(piece.corners), 1);
  }
  std::vector<ContactPolygon> contacts;
  contact_polygons(problem, contacts);
  for (const ContactPolygon& contact : contacts) {
    require(contact.corners.size() >= 3 && contact.front != contact.back, "no polygon between two");
    std::vector<Weights> corners;
    for (const auto& corner : contact.corners) {
      for (const double w : corner.weights) require(w >= 0 && w <= 1, "a corner outside of the tetrahedron");
      corners.push_back(corner.weights);
    }
    sums.add_surface(contact.back, owner_places(corners), 1);
    sums.add_surface(contact.front, owner_places(corners), -1);
  }
  return sums;
}

/// Requires that the interfaces of both tetrahedra are closed in the interior: for each owner every edge runs
/// as often one way as the other, except on the six outer faces.
inline void require_closed(const InterfaceMesh& mesh) {
  const auto on_face = [&](std::uint32_t point, int face) {
    const Vec3& p = mesh.points[point];
    const std::array<double, 4> distances{p.x, p.y, 1 - p.x - p.y - p.z, 1 - p.x - p.y + p.z};
    return std::abs(distances[static_cast<std::size_t>(face)]) < 1e-9;
  };
  std::map<std::array<std::uint32_t, 3>, int> runs;
  for (const InterfaceTriangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t.points[i], b = t.points[(i + 1) % 3];
      const int way = a < b ? 1 : -1;
      runs[{t.front.value, std::min(a, b), std::max(a, b)}] += way;
      runs[{t.back.value, std::min(a, b), std::max(a, b)}] -= way;
    }
  }
  for (const auto& [edge, sum] : runs) {
    bool outer = sum == 0;
    for (int face = 0; face < 4; ++face) outer = outer || (on_face(edge[1], face) && on_face(edge[2], face));
    require(outer, "interfaces that are open inside");
  }
}

/// Requires that volumes add up, parts are positively oriented, contacts close and enclose them, the order of
/// candidates does not matter, and interfaces continue across the common face.
inline void owner_kernel(std::string_view bytes) {
  constexpr double kRoundOff = 1e-9;
  const OwnerPair pair = owner_pair(bytes);
  for (const OwnershipProblem& problem : {pair.first, pair.second}) {
    OwnerSums sums = owner_sums(problem);
    OwnerSums other = owner_sums(backwards(problem));
    OwnershipProblem kept = problem;
    keep_owners(kept);
    OwnerSums fewer = owner_sums(kept);
    double whole = 0;
    for (const auto& candidate : problem.candidates) {
      const std::uint32_t owner = candidate.owner;
      whole += sums.volumes[owner];
      // Which one of two functions that are equal up to round-off is greater is decided by round-off too.
      if (pair.near_ties) continue;
      require(std::abs(sums.volumes[owner] - other.volumes[owner]) < kRoundOff,
              "another order, other volumes");
      require(std::abs(sums.volumes[owner] - fewer.volumes[owner]) < kRoundOff,
              "fewer owners, other volumes");
      require(norm(sums.areas[owner]) < kRoundOff, "a part that is not closed");
      require(std::abs(sums.enclosed[owner] - sums.volumes[owner]) < kRoundOff, "another volume enclosed");
    }
    require(std::abs(whole - 1) < kRoundOff, "volumes that do not add up");
  }
  ContactMeshBuilder builder(kWeldTolerance);
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  ContactBuffer above, below;
  above.add({0, 1, 2, 3}, {a, b, c, Vec3{0, 0, 1}}, pair.first);
  below.add({0, 1, 2, 4}, {a, b, c, Vec3{0, 0, -1}}, pair.second);
  builder.append(above);
  builder.append(below);
  require_closed(builder.finish());
}

}  // namespace adamas::fuzz
