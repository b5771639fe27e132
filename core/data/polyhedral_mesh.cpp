#include "core/data/polyhedral_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "core/base/error.h"
#include "core/base/median.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "core/geometry/length_limits.h"

namespace adamas::inline core {

namespace {

using Index = PolyhedralMesh::Index;

/// The part of the box's volume by which cells that fill it may differ from it.
constexpr double kRoundOff = 1e-9;

/// Returns whether b has the points of a in the same order round the face, in the other order (-1), or
/// neither (0).
int order_of(std::span<const Index> a, std::span<const Index> b) {
  if (a.size() != b.size()) return 0;
  const auto start = std::ranges::find(b, a[0]);
  if (start == b.end()) return 0;
  const auto first = static_cast<std::size_t>(start - b.begin()), n = a.size();
  bool same = true, other = true;
  for (std::size_t i = 1; i < n; ++i) {
    same = same && a[i] == b[(first + i) % n];
    other = other && a[i] == b[(first + n - i) % n];
  }
  // A triangle of two equal points has both; it has no area either.
  return same ? 1 : other ? -1 : 0;
}

}  // namespace

PolyhedralMesh PolyhedralMesh::make(const std::string& name, std::vector<Vec3> points,
                                    std::vector<Index> face_points, const std::vector<Index>& face_ends,
                                    const std::vector<Index>& cell_ends) {
  if (cell_ends.empty()) fail("{}: expected cells, found none", name);
  PolyhedralMesh mesh;
  mesh.points_ = std::move(points);
  for (const Index p : face_points) {
    if (p >= mesh.points_.size())
      fail("{}: expected points below {}, found a cell at point {}", name, mesh.points_.size(), p);
    if (!is_finite(mesh.points_[p])) fail("{}: expected finite coordinates, found none at point {}", name, p);
    mesh.box_.extend(mesh.points_[p]);
  }
  check_lengths(name, mesh.box_);
  mesh.join_faces(name, face_points, face_ends, cell_ends);
  mesh.find_points_of_cells();
  mesh.turn_outwards(name);
  return mesh;
}

/// Makes one face of the faces of two cells that have the same points. Faces keep the order round them of the
/// first cell that has them.
void PolyhedralMesh::join_faces(const std::string& name, const std::vector<Index>& points,
                                const std::vector<Index>& ends, const std::vector<Index>& cell_ends) {
  std::unordered_multimap<std::uint64_t, Index> known;  // by the sum of the points' hashes
  known.reserve(ends.size() / 2);
  cell_ends_.reserve(cell_ends.size());
  cell_faces_.reserve(ends.size());
  Index f = 0;
  for (Index cell = 0; cell < cell_ends.size(); ++cell) {
    if (f >= cell_ends[cell]) fail("{}: expected cells with faces, found none of cell {}", name, cell);
    for (; f < cell_ends[cell]; ++f) {
      const std::span<const Index> own = part(points, ends, f);
      if (own.size() < 3)
        fail("{}: cell {}: expected faces of three points and more, found {}", name, cell, own.size());
      std::uint64_t key = 0;
      for (const Index p : own)
        key += ((p + 1) * 0x9e3779b97f4a7c15ull) ^ ((p + 1) * 0xc2b2ae3d27d4eb4full >> 29);
      const auto [begin, end] = known.equal_range(key);
      auto at = begin;
      while (at != end && order_of(face(at->second), own) == 0) ++at;
      if (at == end) {
        const auto number = static_cast<Index>(face_ends_.size());
        known.emplace(key, number);
        face_points_.insert(face_points_.end(), own.begin(), own.end());
        face_ends_.push_back(static_cast<Index>(face_points_.size()));
        face_cells_.push_back({cell, kNone});
        cell_faces_.push_back(number);
        continue;
      }
      std::array<Index, 2>& cells = face_cells_[at->second];
      if (cells[1] != kNone) {
        fail("{}: expected faces of two cells at most, found one of the cells {}, {} and {}", name, cells[0],
             cells[1], cell);
      }
      cells[1] = cell;
      cell_faces_.push_back(at->second);
    }
    cell_ends_.push_back(static_cast<Index>(cell_faces_.size()));
  }
}

void PolyhedralMesh::find_points_of_cells() {
  std::vector<Index> counts(points_.size() + 1, 0);
  std::vector<Index> own;
  cell_centers_.reserve(cell_count());
  for (std::size_t c = 0; c < cell_count(); ++c) {
    own.clear();
    for (const Index f : faces_of_cell(c)) own.insert(own.end(), face(f).begin(), face(f).end());
    sort_unique(own);
    Vec3 sum;
    for (const Index p : own) {
      sum += points_[p];
      ++counts[p];
    }
    cell_centers_.push_back((1.0 / static_cast<double>(own.size())) * sum);
    cell_points_.insert(cell_points_.end(), own.begin(), own.end());
    cell_point_ends_.push_back(static_cast<Index>(cell_points_.size()));
  }
  point_ends_.resize(points_.size());
  std::partial_sum(counts.begin(), counts.end() - 1, point_ends_.begin());
  std::vector<Index> next(points_.size(), 0);
  for (std::size_t p = 1; p < next.size(); ++p) next[p] = point_ends_[p - 1];
  point_cells_.resize(cell_points_.size());
  for (Index c = 0; c < cell_count(); ++c) {
    for (const Index p : points_of_cell(c)) point_cells_[next[p]++] = c;
  }
}

Vec3 PolyhedralMesh::face_center(std::size_t f) const {
  Vec3 sum;
  for (const Index p : face(f)) sum += points_[p];
  return (1.0 / static_cast<double>(face(f).size())) * sum;
}

Vec3 PolyhedralMesh::face_area(std::size_t f) const {
  const std::span<const Index> points = face(f);
  const Vec3 center = face_center(f);
  Vec3 sum;
  for (std::size_t i = 0; i < points.size(); ++i)
    sum += 0.5 * cross(points_[points[i]] - center, points_[points[(i + 1) % points.size()]] - center);
  return sum;
}

/// Returns the volume of the tetrahedra from the centre of a cell to the triangles of a face as it is stored.
double PolyhedralMesh::volume_below(std::size_t cell, std::size_t f) const {
  const std::span<const Index> own = face(f);
  const Vec3 center = face_center(f), from = cell_centers_[cell];
  double sum = 0;
  for (std::size_t i = 0; i < own.size(); ++i)
    sum += signed_volume(from, center, points_[own[i]], points_[own[(i + 1) % own.size()]]);
  return sum;
}

/// Turns faces so that they are counter-clockwise as seen from outside their first cells, and computes the
/// volumes of cells.
void PolyhedralMesh::turn_outwards(const std::string& name) {
  // All faces of a closed surface are turned the same way if each edge is passed once in each direction.
  std::vector<signed char> ways(cell_faces_.size(), 0);  // by face of a cell: 1 as stored, -1 the other way
  cell_volumes_.assign(cell_count(), 0);
  parallel_for(cell_count(), 256, [&](std::size_t c) {
    const std::span<const Index> faces = faces_of_cell(c);
    const std::size_t first = static_cast<std::size_t>(faces.data() - cell_faces_.data());
    struct Side {
      std::uint64_t edge;
      std::uint32_t face;
      int way;
    };
    thread_local std::vector<Side> sides;
    thread_local std::vector<std::uint32_t> open;
    sides.clear();
    for (std::uint32_t n = 0; n < faces.size(); ++n) {
      const std::span<const Index> own = face(faces[n]);
      for (std::size_t i = 0; i < own.size(); ++i) {
        const Index a = own[i], b = own[(i + 1) % own.size()];
        sides.push_back({std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), n, a < b ? 1 : -1});
      }
    }
    std::ranges::sort(sides, {}, [](const Side& s) { return std::pair(s.edge, s.face); });
    for (std::size_t i = 0; i < sides.size(); i += 2) {
      const bool paired = i + 1 < sides.size() && sides[i].edge == sides[i + 1].edge &&
                          (i + 2 == sides.size() || sides[i + 2].edge != sides[i].edge);
      if (!paired)
        fail("{}: expected closed cells, found cell {} with an edge of one or three faces", name, c);
    }
    // Faces beyond edges are turned like the first one, one after another.
    signed char* const way = ways.data() + first;
    way[0] = 1;
    open.assign(1, 0);
    while (!open.empty()) {
      const std::uint32_t n = open.back();
      open.pop_back();
      for (std::size_t i = 0; i < sides.size(); i += 2) {
        for (const std::size_t one : {i, i + 1}) {
          const Side &here = sides[one], &there = sides[one ^ 1u];
          if (here.face != n || way[there.face] != 0) continue;
          way[there.face] = static_cast<signed char>(here.way == there.way ? -way[n] : way[n]);
          open.push_back(there.face);
        }
      }
    }
    double sum = 0;
    for (std::size_t n = 0; n < faces.size(); ++n) {
      if (way[n] == 0) fail("{}: expected cells in one piece, found several in cell {}", name, c);
      sum += way[n] * volume_below(c, faces[n]);
    }
    cell_volumes_[c] = sum;
  });
  turn_alike(name, ways);
  for (std::size_t c = 0, n = 0; c < cell_count(); ++c) {
    for (const Index f : faces_of_cell(c)) {
      if (face_cells_[f][0] == c && ways[n] < 0) {
        const Index begin = f == 0 ? 0 : face_ends_[f - 1];
        std::reverse(face_points_.begin() + begin, face_points_.begin() + face_ends_[f]);
      }
      ++n;
    }
  }
}

/// Turns the cells of each connected part so that every face lies between its cells, and the part has a
/// volume above 0.
void PolyhedralMesh::turn_alike(const std::string& name, std::vector<signed char>& ways) {
  const auto place = [&](Index cell, Index face) {
    const std::span<const Index> faces = faces_of_cell(cell);
    const auto first = static_cast<std::size_t>(faces.data() - cell_faces_.data());
    return first + static_cast<std::size_t>(std::ranges::find(faces, face) - faces.begin());
  };
  const auto turn = [&](Index cell) {
    const std::span<const Index> faces = faces_of_cell(cell);
    const auto first = static_cast<std::size_t>(faces.data() - cell_faces_.data());
    for (std::size_t n = 0; n < faces.size(); ++n)
      ways[first + n] = static_cast<signed char>(-ways[first + n]);
    cell_volumes_[cell] = -cell_volumes_[cell];
  };
  std::vector<char> known(cell_count(), 0);
  std::vector<Index> part, open;
  for (Index start = 0; start < cell_count(); ++start) {
    if (known[start] != 0) continue;
    part.clear();
    open.assign(1, start);
    known[start] = 1;
    while (!open.empty()) {
      const Index cell = open.back();
      open.pop_back();
      part.push_back(cell);
      for (const Index f : faces_of_cell(cell)) {
        const Index other = neighbour(cell, f);
        if (other == kNone) continue;
        const bool alike = ways[place(cell, f)] == -ways[place(other, f)];
        if (known[other] != 0) {
          if (!alike)
            fail("{}: expected cells apart from each other, found {} and {} on one side of their face", name,
                 cell, other);
          continue;
        }
        if (!alike) turn(other);
        known[other] = 1;
        open.push_back(other);
      }
    }
    double volume = 0;
    for (const Index cell : part) volume += cell_volumes_[cell];
    if (!(std::abs(volume) > 0))
      fail("{}: expected cells with a volume, found none round cell {}", name, start);
    if (volume > 0) continue;
    for (const Index cell : part) turn(cell);
  }
  tangled_ =
      static_cast<std::size_t>(std::ranges::count_if(cell_volumes_, [](double v) { return !(v > 0); }));
}

double PolyhedralMesh::typical_size() const {
  std::vector<double> volumes = cell_volumes_;
  return std::cbrt(std::abs(median(volumes)));
}

bool PolyhedralMesh::fills_box() const {
  const double sum = std::accumulate(cell_volumes_.begin(), cell_volumes_.end(), 0.0);
  return std::abs(sum - box_.volume()) <= kRoundOff * box_.volume();
}

}  // namespace adamas::inline core
