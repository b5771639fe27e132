#include "interfaces/simplification/near_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/hash.h"
#include "core/distance/triangle_distance.h"

namespace adamas::interfaces {

namespace {

constexpr double kCellsPerReach = 2;
constexpr std::size_t kFirstSize = 64;
/// The greatest number of cells along a side of the surface's box: their numbers have 21 bits.
constexpr double kMostCells = 1 << 20;
/// Pieces are cut if they extend over an edge by more than this part of a cell.
constexpr double kLeastCut = 0.05;
/// The greatest number of pieces of a triangle: kMostPieces plus kPiecesPerCell for each area of a cell's
/// face.
constexpr double kMostPieces = 256, kPiecesPerCell = 64;

std::uint64_t bits(double cell) {
  return static_cast<std::uint64_t>(std::clamp(cell, 0.0, 2 * kMostCells - 1));
}

}  // namespace

NearField::NearField(const ClosestPointTree& tree, double reach)
    : tree_(tree), reach_(reach), cubes_(kFirstSize) {
  const Box3& bounds = tree.bounds();
  cell_ = std::max(reach / kCellsPerReach, bounds.diagonal() / kMostCells);
  const double margin = 2 * (reach + cell_);
  origin_ = bounds.min - Vec3{margin, margin, margin};
}

std::size_t NearField::slot_of(std::uint64_t cube) const {
  const std::size_t mask = cubes_.size() - 1;
  std::size_t slot = (fibonacci_hash(cube) >> 20) & mask;
  while (cubes_[slot].cube != cube && cubes_[slot].cube != kNoCube) slot = (slot + 1) & mask;
  return slot;
}

void NearField::grow() {
  const std::vector<Seen> before = std::exchange(cubes_, std::vector<Seen>(2 * cubes_.size()));
  for (const Seen& seen : before) {
    if (seen.cube != kNoCube) cubes_[slot_of(seen.cube)] = seen;
  }
}

const NearField::Seen& NearField::seen_from(const Vec3& p, Vec3& center) {
  const Vec3 scaled = (1 / cell_) * (p - origin_);
  const Vec3 cell{std::floor(scaled.x), std::floor(scaled.y), std::floor(scaled.z)};
  center = origin_ + cell_ * (cell + Vec3{0.5, 0.5, 0.5});
  const std::uint64_t cube = bits(cell.x) << 42 | bits(cell.y) << 21 | bits(cell.z);
  const std::size_t slot = slot_of(cube);
  if (cubes_[slot].cube == cube) return cubes_[slot];
  // Beyond this distance, the whole cube is out of reach.
  const auto closest = tree_.closest(center, reach_ + cell_);
  const Seen seen = closest ? Seen{cube, std::sqrt(closest->squared_distance), closest->triangle}
                            : Seen{cube, std::numeric_limits<double>::infinity(), 0};
  cubes_[slot] = seen;
  if (2 * ++cube_count_ <= cubes_.size()) return cubes_[slot];
  grow();
  return cubes_[slot_of(cube)];
}

bool NearField::near_triangle(const Piece& piece, std::uint32_t triangle, double limit) const {
  const auto& target = tree_.triangle(triangle);
  return std::all_of(piece.corners.begin(), piece.corners.end(), [&](const Vec3& p) {
    return closest_on_triangle(p, target).squared_distance <= limit * limit;
  });
}

/// Judges a piece. `triangle` is set to one near the piece if the verdict is open.
NearField::Verdict NearField::judge(const Piece& piece, double limit, std::uint32_t& triangle) {
  const auto& [a, b, c] = piece.corners;
  const Vec3 middle = 1.0 / 3 * (a + b + c);
  const double radius =
      std::sqrt(std::max({squared_norm(a - middle), squared_norm(b - middle), squared_norm(c - middle)}));
  Vec3 center;
  const Seen seen = seen_from(middle, center);
  const double offset = distance(middle, center);
  if (seen.distance - offset > limit) return Verdict::kFar;
  if (seen.distance + offset + radius <= limit) return Verdict::kNear;
  if (near_triangle(piece, seen.triangle, limit)) return Verdict::kNear;
  triangle = seen.triangle;
  if (radius > 0.5 * cell_) return Verdict::kOpen;
  const auto closest = tree_.closest(middle, limit);
  if (!closest) return Verdict::kFar;
  if (std::sqrt(closest->squared_distance) + radius <= limit) return Verdict::kNear;
  return near_triangle(piece, closest->triangle, limit) ? Verdict::kNear : Verdict::kOpen;
}

/// Cuts a piece in two at the edge of a triangle over which it extends farthest; the inner part is then near
/// that triangle alone. Returns false if it does not extend much over any edge.
bool NearField::cut(const Piece& piece, const std::array<Vec3, 3>& triangle) {
  const Vec3 normal = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  std::array<double, 3> best{};
  double reach = kLeastCut * cell_;
  bool found = false;
  for (std::size_t e = 0; e < 3; ++e) {
    const Vec3 outwards = normalized(cross(triangle[(e + 1) % 3] - triangle[e], normal));
    std::array<double, 3> beyond;
    for (std::size_t i = 0; i < 3; ++i) beyond[i] = dot(piece.corners[i] - triangle[e], outwards);
    const auto [least, most] = std::minmax_element(beyond.begin(), beyond.end());
    if (std::min(-*least, *most) <= reach) continue;
    reach = std::min(-*least, *most), best = beyond, found = true;
  }
  if (!found) return false;
  // This is the corner that is alone on its side; the others follow in their order.
  std::size_t alone = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if ((best[i] > 0) != (best[(i + 1) % 3] > 0) && (best[i] > 0) != (best[(i + 2) % 3] > 0)) alone = i;
  }
  const std::size_t j = (alone + 1) % 3, k = (alone + 2) % 3;
  const Vec3 &a = piece.corners[alone], &b = piece.corners[j], &c = piece.corners[k];
  const Vec3 p = a + best[alone] / (best[alone] - best[j]) * (b - a);
  const Vec3 q = a + best[alone] / (best[alone] - best[k]) * (c - a);
  for (const Piece& part : {Piece{{a, p, q}}, Piece{{p, b, c}}, Piece{{p, c, q}}}) open_.push_back(part);
  return true;
}

void NearField::halve(const Piece& piece) {
  std::size_t i = 0;
  double most = -1;
  for (std::size_t e = 0; e < 3; ++e) {
    const double length = squared_norm(piece.corners[(e + 1) % 3] - piece.corners[e]);
    if (length > most) most = length, i = e;
  }
  const Vec3 &p = piece.corners[i], &q = piece.corners[(i + 1) % 3], &r = piece.corners[(i + 2) % 3];
  const Vec3 half = 0.5 * (p + q);
  open_.push_back({{p, half, r}});
  open_.push_back({{half, q, r}});
}

bool NearField::within(const std::array<Vec3, 3>& corners, double limit) {
  const double area = 0.5 * norm(cross(corners[1] - corners[0], corners[2] - corners[0]));
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, distance(corners[i], corners[(i + 1) % 3]));
  double budget = kMostPieces + kPiecesPerCell * (area / (cell_ * cell_) + longest / cell_);
  open_.assign(1, {corners});
  while (!open_.empty()) {
    const Piece piece = open_.back();
    open_.pop_back();
    std::uint32_t triangle = ClosestPointTree::kNoTriangle;
    const Verdict verdict = judge(piece, limit, triangle);
    if (verdict == Verdict::kNear) continue;
    if (verdict == Verdict::kFar || --budget < 0) return false;
    // Pieces are cut along large triangles; triangles that are small relative to the reach are not worth it.
    const auto& target = tree_.triangle(triangle);
    const bool great =
        squared_norm(target[1] - target[0]) + squared_norm(target[2] - target[0]) > reach_ * reach_;
    if (!great || !cut(piece, target)) halve(piece);
  }
  return true;
}

}  // namespace adamas::interfaces
