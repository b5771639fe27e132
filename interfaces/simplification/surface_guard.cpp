#include "interfaces/simplification/surface_guard.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/distance/triangle_distance.h"
#include "interfaces/network/domain_faces.h"
#include "interfaces/network/triangle_contacts.h"

namespace adamas::interfaces {

namespace {

/// The least cosine of the angle between a triangle and the triangles that it replaces.
constexpr double kLeastCosine = 0.1;
/// The normal of a triangle with an angle below this, in degrees, is not reliable.
constexpr double kSliver = 1;
/// If the number of triangles with small angles falls, their least angle may fall to this part.
constexpr double kWorse = 0.3;
/// The part of the limit for points of the original surface, since points between them may be a little
/// farther away.
constexpr double kAtPoints = 0.97;
/// The greatest number of pieces into which an edge is divided for that.
constexpr double kMostPieces = 4;
/// The least angle of any new triangle.
constexpr double kAlmostFlat = 1e-3;

Box3 box_of(const std::array<Vec3, 3>& corners) {
  Box3 box;
  for (const Vec3& p : corners) box.extend(p);
  return box;
}

Vec3 area_normal(const std::array<Vec3, 3>& c) { return cross(c[1] - c[0], c[2] - c[0]); }

}  // namespace

double smallest_angle(const std::array<Vec3, 3>& corners) {
  double smallest = 180;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 a = corners[(i + 1) % 3] - corners[i], b = corners[(i + 2) % 3] - corners[i];
    smallest = std::min(smallest, std::atan2(norm(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi);
  }
  return smallest;
}

SurfaceGuard::SurfaceGuard(std::vector<Vec3> points, std::vector<ClosestPointTree::Triangle> triangles,
                           std::vector<std::uint32_t> interfaces, std::vector<std::uint32_t> patches,
                           std::vector<NearField>& fields, const Options& options)
    : options_(options),
      points_(std::move(points)),
      originals_(points_),
      faces_(std::move(triangles)),
      interfaces_(std::move(interfaces)),
      patches_(std::move(patches)),
      fields_(fields),
      limit_parts_(points_.size(), 1.0),
      moved_(points_.size(), 0),
      covered_(faces_.size()) {
  for (const Vec3& p : points_) sides_.push_back(domain_faces_at(options.domain, p));
  std::vector<Box3> boxes;
  boxes.reserve(faces_.size());
  for (std::uint32_t f = 0; f < faces_.size(); ++f) boxes.push_back(box_of(corners_now(f)));
  boxes_ = BoxTree(boxes);
  cover_edges();
}

/// Adds points along edges that are longer than the limit to the points to which the surface must stay close.
void SurfaceGuard::cover_edges() {
  for (std::uint32_t f = 0; f < faces_.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = faces_[f][c], b = faces_[f][(c + 1) % 3];
      const double length = distance(points_[a], points_[b]);
      // The two triangles at an edge run along it in opposite directions.
      if (b < a || length <= options_.limit) continue;
      const double pieces = std::min(std::ceil(length / options_.limit), kMostPieces);
      for (double i = 1; i < pieces; ++i) {
        covered_[f].push_back(static_cast<std::uint32_t>(originals_.size()));
        originals_.push_back(points_[a] + (i / pieces) * (points_[b] - points_[a]));
      }
    }
  }
}

SurfaceGuard::Corners SurfaceGuard::corners_after(const SurfaceChange::Face& face,
                                                  const SurfaceChange& change) const {
  return {place(face.corners[0], change), place(face.corners[1], change), place(face.corners[2], change)};
}

SurfaceGuard::Corners SurfaceGuard::corners_now(std::uint32_t face) const {
  const auto& c = faces_[face];
  return {points_[c[0]], points_[c[1]], points_[c[2]]};
}

double SurfaceGuard::smallest_angle(std::span<const std::uint32_t> faces) const {
  double smallest = 180;
  for (const std::uint32_t f : faces)
    smallest = std::min(smallest, interfaces::smallest_angle(corners_now(f)));
  return smallest;
}

double SurfaceGuard::limit_at(std::span<const std::uint32_t> faces) const {
  double part = 1;
  for (const std::uint32_t f : faces) {
    for (const std::uint32_t p : faces_[f]) part = std::min(part, limit_parts_[p]);
  }
  return part * options_.limit;
}

/// The number of triangles with an angle below the wanted one, and the least angle of all triangles.
struct SurfaceGuard::Shapes {
  std::size_t bad = 0;
  double smallest = 180;
  void add(const Corners& corners, double wanted) {
    const double angle = interfaces::smallest_angle(corners);
    smallest = std::min(smallest, angle);
    if (angle < wanted) ++bad;
  }
};

bool SurfaceGuard::shapes_allowed(const SurfaceChange& change) const {
  Shapes before, after;
  for (const SurfaceChange::Face& face : change.faces)
    after.add(corners_after(face, change), change.least_angle);
  if (after.smallest < std::max(change.angle_above, kAlmostFlat)) return false;
  if (after.bad == 0) return true;
  for (const std::uint32_t f : change.old_faces) before.add(corners_now(f), change.least_angle);
  return after.smallest >= before.smallest ||
         (after.bad < before.bad && after.smallest >= kWorse * before.smallest);
}

/// Returns whether triangles turn too much against their old normals or against the mean normal of the
/// triangles that they replace.
bool SurfaceGuard::turns_over(const SurfaceChange& change) const {
  for (const SurfaceChange::Face& face : change.faces) {
    const Vec3 after = normalized(area_normal(corners_after(face, change)));
    const Corners before = corners_now(face.face);
    if (interfaces::smallest_angle(before) > kSliver &&
        dot(after, normalized(area_normal(before))) < kLeastCosine)
      return true;
    Vec3 whole;
    for (const std::uint32_t f : change.old_faces) {
      if (patches_[f] == patches_[face.face]) whole += area_normal(corners_now(f));
    }
    if (dot(after, normalized(whole)) < kLeastCosine) return true;
  }
  return false;
}

bool SurfaceGuard::is_old_edge(const SurfaceChange& change, std::uint32_t patch, std::uint32_t a,
                               std::uint32_t b) const {
  const auto has = [this](std::uint32_t face, std::uint32_t p) {
    return std::find(faces_[face].begin(), faces_[face].end(), p) != faces_[face].end();
  };
  return std::any_of(change.old_faces.begin(), change.old_faces.end(),
                     [&](std::uint32_t f) { return patches_[f] == patch && has(f, a) && has(f, b); });
}

/// Returns whether all new edges inside an interface stay out of the sides of the domain.
bool SurfaceGuard::stays_off_domain_sides(const SurfaceChange& change) const {
  for (const SurfaceChange::Face& face : change.faces) {
    const auto& c = face.corners;
    if ((sides_[c[0]] & sides_[c[1]] & sides_[c[2]]) != 0) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = c[i], b = c[(i + 1) % 3];
      if ((sides_[a] & sides_[b]) == 0 || is_old_edge(change, patches_[face.face], a, b)) continue;
      if (!change.line) return false;
      const auto& [p, q] = *change.line;
      if (!((a == p && b == q) || (a == q && b == p))) return false;
    }
  }
  return true;
}

bool SurfaceGuard::stays_near_original(const SurfaceChange& change, double limit) {
  return std::all_of(change.faces.begin(), change.faces.end(), [&](const SurfaceChange::Face& face) {
    return fields_[interfaces_[face.face]].within(corners_after(face, change), limit);
  });
}

/// Assigns the points that the old triangles cover to the nearest new ones, patch by patch; returns whether
/// all are near enough.
bool SurfaceGuard::original_stays_near(const SurfaceChange& change, double limit) {
  covered_after_.assign(change.faces.size(), {});
  std::vector<std::uint32_t> done, points;
  for (const std::uint32_t first : change.old_faces) {
    const std::uint32_t patch = patches_[first];
    if (std::find(done.begin(), done.end(), patch) != done.end()) continue;
    done.push_back(patch);
    points.clear();
    for (const std::uint32_t f : change.old_faces) {
      if (patches_[f] == patch) points.insert(points.end(), covered_[f].begin(), covered_[f].end());
    }
    if (change.dropped && moved_[*change.dropped] == 0) points.push_back(*change.dropped);
    if (change.move && moved_[change.move->point] == 0) points.push_back(change.move->point);
    for (const std::uint32_t p : points) {
      double least = limit * limit;
      std::size_t nearest = change.faces.size();
      for (std::size_t i = 0; i < change.faces.size(); ++i) {
        if (patches_[change.faces[i].face] != patch) continue;
        const double d =
            closest_on_triangle(originals_[p], corners_after(change.faces[i], change)).squared_distance;
        if (d <= least) least = d, nearest = i;
      }
      if (nearest == change.faces.size()) return false;
      covered_after_[nearest].push_back(p);
    }
  }
  return true;
}

/// Returns whether an unchanged triangle has no contact with a new one.
bool SurfaceGuard::has_no_contact(const SurfaceChange& change, const SurfaceChange::Face& face,
                                  std::uint32_t other) const {
  const auto& c = faces_[other];
  std::array<std::uint32_t, 3> shared{};
  std::size_t count = 0;
  for (const std::uint32_t p : face.corners) {
    if (std::find(c.begin(), c.end(), p) != c.end()) shared[count++] = p;
  }
  // A new edge that exists elsewhere already would join separate parts.
  if (count == 2 && !is_old_edge(change, patches_[face.face], shared[0], shared[1])) return false;
  return !in_contact({face.corners, corners_after(face, change)}, {c, corners_now(other)});
}

bool SurfaceGuard::free_of_contact(const SurfaceChange& change) const {
  for (std::size_t i = 0; i < change.faces.size(); ++i) {
    const SurfaceChange::Face& face = change.faces[i];
    const Corners corners = corners_after(face, change);
    bool clear = true;
    boxes_.for_each_touching(box_of(corners), [&](std::uint32_t other) {
      if (std::find(change.old_faces.begin(), change.old_faces.end(), other) == change.old_faces.end())
        clear = has_no_contact(change, face, other);
      return clear;
    });
    if (!clear) return false;
    for (std::size_t j = 0; j < i; ++j) {
      const SurfaceChange::Face& other = change.faces[j];
      if (in_contact({face.corners, corners}, {other.corners, corners_after(other, change)})) return false;
    }
  }
  return true;
}

/// Returns whether no triangle passes through another one. Triangles without contact before and after may do
/// so, for example when a thin body is inverted. Therefore the tetrahedra between the old and the new
/// triangles must be empty.
bool SurfaceGuard::passes_through_no_triangle(const SurfaceChange& change) const {
  const auto changes = [&](std::uint32_t f) {
    if (std::find(change.old_faces.begin(), change.old_faces.end(), f) == change.old_faces.end())
      return false;
    return std::none_of(change.faces.begin(), change.faces.end(), [&](const SurfaceChange::Face& face) {
      return face.face == f && corners_after(face, change) == corners_now(f);
    });
  };
  for (const SurfaceChange::Face& face : change.faces) {
    const Corners after = corners_after(face, change);
    Corners before = corners_now(face.face);
    ClosestPointTree::Triangle numbers = faces_[face.face];
    // The old corners are rotated so that most of them equal the new ones.
    const auto kept = [&] {
      return static_cast<int>(before[0] == after[0]) + static_cast<int>(before[1] == after[1]) +
             static_cast<int>(before[2] == after[2]);
    };
    for (int turn = 0; turn < 3 && kept() < 2; ++turn) {
      std::rotate(before.begin(), before.begin() + 1, before.end());
      std::rotate(numbers.begin(), numbers.begin() + 1, numbers.end());
    }
    std::size_t moved = 0;
    while (moved < 3 && before[moved] == after[moved]) ++moved;
    if (moved == 3) continue;
    // A point that moves has one number, so its old position gets a special one.
    constexpr std::uint32_t kBefore = 0xffffffffu;
    const bool moves = change.move && change.move->point == numbers[moved];
    const std::uint32_t number = moves ? kBefore : numbers[moved];
    const std::size_t i = (moved + 1) % 3, j = (moved + 2) % 3;
    Box3 box = box_of(after);
    box.extend(before[moved]);
    bool empty = true;
    boxes_.for_each_touching(box, [&](std::uint32_t other) {
      if (changes(other)) return true;
      const PlacedTriangle there{faces_[other], corners_now(other)};
      for (const std::size_t side : {i, j}) {
        empty = empty && !in_contact({{number, face.corners[moved], face.corners[side]},
                                      {before[moved], after[moved], after[side]}},
                                     there);
      }
      for (std::size_t c = 0; c < 3 && empty; ++c) {
        const auto& own = face.corners;
        if (there.points[c] != number && std::find(own.begin(), own.end(), there.points[c]) == own.end())
          empty = !tetrahedron_contains({before[moved], after[moved], after[i], after[j]}, there.corners[c]);
      }
      return empty;
    });
    if (!empty) return false;
  }
  return true;
}

bool SurfaceGuard::allows(const SurfaceChange& change) {
  const double limit = limit_at(change.old_faces);
  return limit > 0 && shapes_allowed(change) && !turns_over(change) && stays_off_domain_sides(change) &&
         original_stays_near(change, kAtPoints * limit) && stays_near_original(change, limit) &&
         free_of_contact(change) && passes_through_no_triangle(change);
}

void SurfaceGuard::apply(const SurfaceChange& change) {
  if (change.move) {
    points_[change.move->point] = change.move->to;
    moved_[change.move->point] = 1;
  }
  for (const std::uint32_t f : change.old_faces) {
    covered_[f].clear();
    const bool stays = std::any_of(change.faces.begin(), change.faces.end(),
                                   [f](const SurfaceChange::Face& face) { return face.face == f; });
    if (!stays) boxes_.set(f, Box3{});
  }
  for (std::size_t i = 0; i < change.faces.size(); ++i) {
    const SurfaceChange::Face& face = change.faces[i];
    faces_[face.face] = face.corners;
    boxes_.set(face.face, box_of(corners_now(face.face)));
    covered_[face.face] = std::move(covered_after_[i]);
  }
}

}  // namespace adamas::interfaces
