#include "interfaces/mesh_reconstruction/mesh_interfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/data/contact_mesh.h"
#include "interfaces/reconstruction/region_parts.h"

namespace adamas::interfaces {

namespace {

using Index = MeshSubdivision::Index;

/// A face lies on a side of the box if its points are this near to it, in relation to the box's diagonal.
constexpr double kOnSide = 1e-9;
/// A face is plane if its points are this near to a plane, in relation to its size.
constexpr double kPlane = 1e-9;

MaterialId outside_of(const IdVector<MaterialId, std::string>& materials) {
  const auto found = std::ranges::find(materials, kOutside);
  return MaterialId(static_cast<std::size_t>(found - materials.begin()));
}

/// Finds the faces at the boundary of a mesh that are interfaces to the outside: those inside the box.
class Boundary {
 public:
  explicit Boundary(const PolyhedralMesh& mesh)
      : mesh_(mesh), fills_box_(mesh.fills_box()), tolerance_(kOnSide * mesh.box().diagonal()) {}

  /// Throws Error, with the name, if the cells fill the box, but some of them share only parts of faces.
  void check(const std::string& name) const {
    if (!fills_box_) return;
    std::size_t count = 0;
    Vec3 first;
    for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
      if (mesh_.cells_of_face(f)[1] != PolyhedralMesh::kNone || is_on_side(static_cast<Index>(f))) continue;
      if (count++ == 0) first = mesh_.face_center(f);
    }
    if (count == 0) return;
    fail(
        "{}: expected cells that share whole faces, found {} faces inside the mesh that one cell alone has, "
        "the "
        "first at {:.6g},{:.6g},{:.6g}",
        name, count, first.x, first.y, first.z);
  }
  [[nodiscard]] bool has_outside(Index face) const {
    return !fills_box_ && mesh_.cells_of_face(face)[1] == PolyhedralMesh::kNone && !is_on_side(face);
  }

 private:
  [[nodiscard]] bool is_on_side(Index face) const {
    const std::span<const Index> points = mesh_.face(face);
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {mesh_.box().min[axis], mesh_.box().max[axis]}) {
        const auto is_there = [&](Index p) { return std::abs(mesh_.points()[p][axis] - side) <= tolerance_; };
        if (std::ranges::all_of(points, is_there)) return true;
      }
    }
    return false;
  }

  const PolyhedralMesh& mesh_;
  bool fills_box_;
  double tolerance_;
};

/// Extracts contacts of materials in cells, and of materials with the outside at faces.
class Extraction {
 public:
  Extraction(const MeshValues& values, std::uint16_t outside)
      : values_(values), subdivision_(values.subdivision()), outside_(outside) {}

  void add_cell(Index cell, ContactBuffer& buffer) const {
    thread_local std::vector<CornerValues> found;
    thread_local OwnershipProblem problem;
    subdivision_.for_each_tetrahedron(cell, [&](const std::array<Index, 4>& corners) {
      const std::uint16_t first = values_.owner(corners[0]);
      if (std::all_of(corners.begin() + 1, corners.end(), [&](Index p) { return values_.owner(p) == first; }))
        return;
      values_.find_materials(corners, found);
      problem.clear();
      for (const CornerValues& material : found) {
        problem.add_candidate(material.number);
        problem.add_function(material.values, material.number);
      }
      keep_owners(problem);
      add_contacts(corners, problem, buffer);
    });
  }

  /// Adds the contacts of a cell with the outside at a face. `sole`: the number of its one material, if the
  /// cell is not active.
  void add_face(Index face, std::optional<std::uint16_t> sole, ContactBuffer& buffer) const {
    const std::span<const Index> points = subdivision_.mesh().face(face);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::array<Index, 3> corners{subdivision_.face_center(face), points[i],
                                         points[(i + 1) % points.size()]};
      std::uint16_t owner = sole.value_or(0);
      bool whole = true;
      if (!sole) {
        owner = values_.owner(corners[0]);
        whole = values_.owner(corners[1]) == owner && values_.owner(corners[2]) == owner;
      }
      whole ? add_whole(corners, owner, !sole, buffer) : add_shared(corners, buffer);
    }
  }

 private:
  /// Adds the contacts of a tetrahedron of the subdivision. The buffer turns polygons by the sign of its
  /// volume, but what counts is the order of its corners, also where a cell is tangled.
  void add_contacts(const std::array<Index, 4>& corners, const OwnershipProblem& problem,
                    ContactBuffer& buffer) const {
    std::array<std::uint64_t, 4> ids{};
    std::array<Vec3, 4> positions{}, places{};
    for (std::size_t c = 0; c < 4; ++c) ids[c] = corners[c], positions[c] = subdivision_.position(corners[c]);
    const std::array<std::size_t, 4> order = ContactBuffer::ascending(ids);
    bool odd = false;
    for (std::size_t i = 0; i < 4; ++i) {
      places[i] = positions[order[i]];
      for (std::size_t j = i + 1; j < 4; ++j) odd = odd != (order[j] < order[i]);
    }
    if (odd == (signed_volume(places[0], places[1], places[2], places[3]) < 0))
      return buffer.add(ids, positions, problem);
    thread_local ContactBuffer turned;
    thread_local std::vector<ContactBuffer::Corner> polygon;
    turned.clear();
    turned.add(ids, positions, problem);
    turned.for_each_polygon(
        [&](std::uint32_t front, std::uint32_t back, std::span<const ContactBuffer::Corner> old) {
          const std::size_t count = old.size();
          polygon.clear();
          for (std::size_t i = 0; i < count; ++i) {
            polygon.push_back(old[count - 1 - i]);
            // The edge to the next corner is the one that arrived at this corner before.
            polygon.back().leaving = old[(2 * count - 2 - i) % count].leaving;
          }
          buffer.add_polygon(front, back, polygon);
        });
  }

  /// The place of the point beyond a face among the ids of its tetrahedron: its id is the greatest.
  static constexpr std::size_t kBeyond = 3;
  static constexpr std::uint64_t kBeyondId = std::numeric_limits<std::uint64_t>::max() - 1;
  static constexpr unsigned kNotBeyond = 1u << kBeyond;

  /// The corners of a triangle in the order of their ids, and whether that turns it round.
  struct Sorted {
    std::array<Index, 3> corners;
    bool turned;
    [[nodiscard]] std::array<std::uint64_t, 4> ids() const {
      return {corners[0], corners[1], corners[2], kBeyondId};
    }
  };
  static Sorted sorted(std::array<Index, 3> corners) {
    bool turned = false;
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 1)}) {
      auto &low = corners[static_cast<std::size_t>(a)], &high = corners[static_cast<std::size_t>(b)];
      if (low <= high) continue;
      std::swap(low, high);
      turned = !turned;
    }
    return {corners, turned};
  }

  /// Adds a triangle that belongs to one material; its corners run counter-clockwise seen from outside.
  void add_whole(const std::array<Index, 3>& corners, std::uint16_t owner, bool crowded,
                 ContactBuffer& buffer) const {
    const Sorted by_id = sorted(corners);
    const auto place = [&](Index p) {
      return static_cast<unsigned>(std::ranges::find(by_id.corners, p) - by_id.corners.begin());
    };
    std::array<ContactBuffer::Corner, 3> polygon{};
    for (std::size_t i = 0; i < 3; ++i) {
      const unsigned here = place(corners[i]), next = place(corners[(i + 1) % 3]);
      const auto zeros_but = [](unsigned kept) { return static_cast<std::uint8_t>(0xfu & ~kept); };
      polygon[i] = {ContactBuffer::digest(by_id.ids(), zeros_but(1u << here), {}),
                    subdivision_.position(corners[i]),
                    ContactBuffer::digest(by_id.ids(), zeros_but(1u << here | 1u << next), {}), crowded};
    }
    buffer.add_polygon(outside_, owner, polygon);
  }

  /// Adds the parts of a triangle that several materials have. They are found as contacts with the outside in
  /// a tetrahedron beyond the triangle: towards its apex all materials fall to one value in the same way, and
  /// the outside rises above them, so that what the outside touches is the cone of what materials own in the
  /// triangle; features of the cone stand for those of the triangle.
  void add_shared(const std::array<Index, 3>& corners, ContactBuffer& buffer) const {
    thread_local std::vector<CornerValues> found;
    thread_local OwnershipProblem problem;
    thread_local std::vector<ContactPolygon> contacts;
    const Sorted by_id = sorted(corners);
    const auto& [a, b, c] = by_id.corners;
    values_.find_materials({a, b, c, a}, found);
    problem.clear();
    double most = 0;
    for (const CornerValues& material : found) {
      const auto& v = material.values;
      problem.add_candidate(material.number);
      problem.add_function({v[0], v[1], v[2], 0}, material.number);
      most = std::max({most, std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
    }
    problem.add_candidate(outside_);
    problem.add_function({-2 * most, -2 * most, -2 * most, most}, outside_);
    keep_owners(problem);
    contacts.clear();
    contact_polygons(problem, contacts);
    std::vector<ContactBuffer::Corner> polygon;
    for (const ContactPolygon& contact : contacts) {
      if (contact.front != outside_ && contact.back != outside_) continue;
      polygon.clear();
      const std::size_t count = contact.corners.size();
      for (std::size_t i = 0; i < count; ++i) {
        const auto& corner = contact.corners[by_id.turned ? count - 1 - i : i];
        const auto& edge = by_id.turned ? contact.corners[(2 * count - 2 - i) % count] : corner;
        polygon.push_back({digest_on_face(by_id, corner.functions, corner.zero_weights),
                           position_on_face(by_id, corner.weights),
                           digest_on_face(by_id, edge.line_functions, edge.line_zero_weights), true});
      }
      buffer.add_polygon(contact.front, contact.back, polygon);
    }
  }

  /// The feature of the triangle that one of the tetrahedron beyond it stands for: without the outside.
  template <std::size_t kCount>
  [[nodiscard]] ContactBuffer::Key digest_on_face(const Sorted& by_id,
                                                  const std::array<std::uint64_t, kCount>& functions,
                                                  std::uint8_t zeros) const {
    std::vector<std::uint64_t> kept;
    for (const std::uint64_t f : functions) {
      if (f != ContactBuffer::kNoFunction && f != outside_) kept.push_back(f);
    }
    // A material alone is no feature.
    if (kept.size() < 2) kept.clear();
    return ContactBuffer::digest(by_id.ids(), static_cast<std::uint8_t>(zeros | kNotBeyond), kept);
  }

  [[nodiscard]] Vec3 position_on_face(const Sorted& by_id, const Weights& weights) const {
    Vec3 sum;
    double all = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      sum += weights[i] * subdivision_.position(by_id.corners[i]);
      all += weights[i];
    }
    return (1 / all) * sum;
  }

  const MeshValues& values_;
  const MeshSubdivision& subdivision_;
  std::uint32_t outside_;
};

/// Returns whether a face is plane and convex, without corners on its edges, so that triangles from any of
/// its points divide it.
bool is_plane(const PolyhedralMesh& mesh, std::span<const Index> points) {
  Vec3 normal, center;
  for (const Index p : points) center += mesh.points()[p];
  center *= 1.0 / static_cast<double>(points.size());
  double size = 0;
  const auto place = [&](std::size_t i) { return mesh.points()[points[i % points.size()]]; };
  for (std::size_t i = 0; i < points.size(); ++i) {
    normal += cross(place(i) - center, place(i + 1) - center);
    size = std::max(size, norm(place(i) - center));
  }
  normal = normalized(normal);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(std::abs(dot(place(i) - center, normal)) <= kPlane * size)) return false;
    const Vec3 turn = cross(place(i + 1) - place(i), place(i + 2) - place(i + 1));
    if (!(dot(turn, normal) > kPlane * size * size)) return false;
  }
  return true;
}

}  // namespace

IdVector<MaterialId, std::string> materials_with_outside(const MeshData& data) {
  IdVector<MaterialId, std::string> materials = data.materials;
  if (!data.mesh.fills_box() && std::ranges::find(materials, kOutside) == materials.end())
    materials.push_back(kOutside);
  return materials;
}

InterfaceMesh interfaces_of_values(const MeshData& data, const MeshValues& values, Progress& progress) {
  const PolyhedralMesh& mesh = data.mesh;
  const IdVector<MaterialId, std::string> materials = materials_with_outside(data);
  const auto outside = static_cast<std::uint16_t>(values.material_count());
  const Extraction extraction(values, outside);
  const Boundary boundary(mesh);
  boundary.check(data.source);
  std::vector<char> is_active(mesh.cell_count(), 0);
  for (const Index c : values.active_cells()) is_active[c] = 1;
  constexpr std::size_t kBatch = 4096, kChunk = 64;
  ContactMeshBuilder builder(kWeldTolerance * mesh.box().diagonal());
  for (std::size_t begin = 0; begin < mesh.cell_count(); begin += kBatch) {
    progress.step("reconstructing interfaces",
                  static_cast<double>(begin) / static_cast<double>(mesh.cell_count()));
    const std::size_t count = std::min(kBatch, mesh.cell_count() - begin);
    std::vector<ContactBuffer> buffers((count + kChunk - 1) / kChunk);
    parallel_for(buffers.size(), 1, [&](std::size_t n) {
      const std::size_t end = begin + std::min(count, (n + 1) * kChunk);
      for (auto c = static_cast<Index>(begin + n * kChunk); c < end; ++c) {
        if (is_active[c] != 0) extraction.add_cell(c, buffers[n]);
        for (const Index f : mesh.faces_of_cell(c)) {
          if (!boundary.has_outside(f)) continue;
          extraction.add_face(f, is_active[c] != 0 ? std::nullopt : std::optional(values.sole(c)),
                              buffers[n]);
        }
      }
    });
    std::vector<const ContactBuffer*> all;
    for (const ContactBuffer& buffer : buffers) all.push_back(&buffer);
    builder.append(all);
  }
  const LoopProgress stage(progress, "joining interfaces");
  InterfaceMesh result = builder.finish();
  result.source = data.source;
  result.materials = materials;
  const auto named = [&](MaterialId number) {
    return number.value == outside ? outside_of(materials)
                                   : values.material(static_cast<std::uint16_t>(number.value));
  };
  for (InterfaceTriangle& t : result.triangles) t.front = named(t.front), t.back = named(t.back);
  // A material called kOutside is one with what is beyond it.
  std::erase_if(result.triangles, [](const InterfaceTriangle& t) { return t.front == t.back; });
  drop_unused_points(result);
  return result;
}

InterfaceMesh interfaces_of_labels(const MeshData& data) {
  const PolyhedralMesh& mesh = data.mesh;
  InterfaceMesh result;
  result.source = data.source;
  result.materials = materials_with_outside(data);
  const MaterialId outside = outside_of(result.materials);
  const Boundary boundary(mesh);
  boundary.check(data.source);
  result.points = mesh.points();
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto& [first, second] = mesh.cells_of_face(f);
    const MaterialId back(data.labels[first]);
    if (second == PolyhedralMesh::kNone && !boundary.has_outside(f)) continue;
    const MaterialId front = second == PolyhedralMesh::kNone ? outside : MaterialId(data.labels[second]);
    if (front == back) continue;
    const std::span<const Index> points = mesh.face(f);
    if (is_plane(mesh, points)) {
      const auto lowest = static_cast<std::size_t>(std::ranges::min_element(points) - points.begin());
      for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        result.triangles.push_back(
            {{points[lowest], points[(lowest + i) % points.size()], points[(lowest + i + 1) % points.size()]},
             front,
             back});
      }
      continue;
    }
    const auto center = static_cast<std::uint32_t>(result.points.size());
    result.points.push_back(mesh.face_center(f));
    for (std::size_t i = 0; i < points.size(); ++i)
      result.triangles.push_back({{center, points[i], points[(i + 1) % points.size()]}, front, back});
  }
  drop_unused_points(result);
  return result;
}

}  // namespace adamas::interfaces
