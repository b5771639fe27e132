#include <algorithm>
#include <iterator>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/geometry/plane_sides.h"
#include "core/geometry/tetrahedron.h"
#include "interfaces/cross_section/cross_section.h"

namespace adamas::interfaces {

namespace {

constexpr std::size_t kChunk = 1024;

/// The mesh, the plane and the chosen field, which all threads read.
struct Job {
  const ResampledMesh& mesh;
  PlaneSides sides;
  std::optional<FieldChoice> field;
  SectionMode mode;
  std::vector<double> distances;  ///< of the mesh's vertices from the plane
};

/// The section of some cells.
struct Part {
  std::vector<SectionPiece> pieces;
  std::vector<Segment> cell_edges, interface_edges;
};

/// A cell being cut.
class CellCutter {
 public:
  CellCutter(const Job& job, Part& part) : job_(job), part_(part) {}

  void cut(std::size_t cell) {
    const auto& vertices = job_.mesh.cells[cell].vertices;
    for (std::size_t i = 0; i < 4; ++i) distances_[i] = job_.distances[vertices[i]];
    if (!find_polygon(vertices)) return;
    cell_ = cell;
    positions_ = job_.mesh.corners(cell);
    const bool has_area = polygon_.size() > 2;
    for (std::size_t i = 0; has_area && i < polygon_.size(); ++i)
      part_.cell_edges.push_back({point(polygon_[i]), point(polygon_[(i + 1) % polygon_.size()])});
    job_.mesh.ownership(cell, ownership_);
    if (ownership_.pure()) {
      if (has_area) add_piece(ownership_.problem.candidates[0].owner, polygon_);
      return;
    }
    keep_owners(ownership_.problem);
    if (has_area) divide_polygon();
    // Cells that touch the plane with an edge only count as well: the interface may lie in the face between
    // two of them.
    contacts_.clear();
    contact_polygons(ownership_.problem, contacts_);
    for (const ContactPolygon& contact : contacts_) add_contact(contact);
  }

 private:
  /// Finds the corners of the plane's part of the cell as weights, in cyclic order; there are fewer than
  /// three where the cell only touches the plane. Returns false where the cell lies on one side.
  bool find_polygon(const std::array<std::uint32_t, 4>& vertices) {
    std::array<std::size_t, 4> up{}, down{};
    std::size_t ups = 0, downs = 0;
    for (std::size_t i = 0; i < 4; ++i) (job_.sides.above(distances_[i]) ? up[ups++] : down[downs++]) = i;
    if (ups == 0 || downs == 0) return false;
    polygon_.clear();
    const auto add = [&](std::size_t a, std::size_t b) {
      // The same order of the ends in every cell, so that the points are the same to the bit.
      if (vertices[b] < vertices[a]) std::swap(a, b);
      const double da = distances_[a], db = distances_[b];
      const double t = da == 0 ? 0 : db == 0 ? 1 : da / (da - db);
      Weights w{};
      w[a] = 1 - t;
      w[b] = t;
      if (polygon_.empty() || w != polygon_.back()) polygon_.push_back(w);
    };
    if (ups == 2) {
      add(up[0], down[0]);
      add(up[0], down[1]);
      add(up[1], down[1]);
      add(up[1], down[0]);
    } else {
      const std::size_t lone = ups == 1 ? up[0] : down[0];
      for (std::size_t i = 0; i < 3; ++i) add(lone, ups == 1 ? down[i] : up[i]);
    }
    if (polygon_.size() > 1 && polygon_.front() == polygon_.back()) polygon_.pop_back();
    return true;
  }

  /// Interfaces may coincide with the plane: who owns the polygon is decided a little beside it.
  void divide_polygon() {
    const Tetrahedron frame(positions_);
    const Vec3 nudge = job_.sides.nudge();
    Weights shift{};
    for (std::size_t i = 0; i < 4; ++i) shift[i] = dot(frame.slopes[i], nudge);
    const auto moved = [&](const Weights& w, double sign) {
      return Weights{w[0] + sign * shift[0], w[1] + sign * shift[1], w[2] + sign * shift[2],
                     w[3] + sign * shift[3]};
    };
    for (Weights& w : polygon_) w = moved(w, 1);
    owned_.clear();
    partition_polygon(ownership_.problem, polygon_, owned_);
    for (OwnedPolygon& piece : owned_) {
      for (Weights& w : piece.corners) w = moved(w, -1);
      add_piece(piece.owner, piece.corners);
    }
  }

  [[nodiscard]] Vec3 point(const Weights& w) const {
    return w[0] * positions_[0] + w[1] * positions_[1] + w[2] * positions_[2] + w[3] * positions_[3];
  }

  void add_piece(std::uint32_t owner, const std::vector<Weights>& corners) {
    SectionPiece piece;
    piece.body = BodyId(owner);
    piece.material = job_.mesh.table.material(piece.body);
    piece.cell = cell_;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (i > 0 && corners[i] == corners[i - 1]) continue;
      piece.corners.push_back(point(corners[i]));
      if (job_.field) piece.values.push_back(value(piece.body, corners[i]));
    }
    Vec3 turn;
    for (std::size_t i = 2; i < piece.corners.size(); ++i)
      turn += cross(piece.corners[i - 1] - piece.corners[0], piece.corners[i] - piece.corners[0]);
    if (squared_norm(turn) == 0) return;
    if (dot(turn, job_.sides.normal()) < 0) {
      std::reverse(piece.corners.begin(), piece.corners.end());
      std::reverse(piece.values.begin(), piece.values.end());
    }
    part_.pieces.push_back(std::move(piece));
  }

  [[nodiscard]] double value(BodyId body, const Weights& w) {
    const FieldInfo& info = job_.mesh.fields[job_.field->field];
    components_.clear();
    for (std::size_t c = 0; c < static_cast<std::size_t>(info.components); ++c) {
      components_.push_back(job_.mode == SectionMode::kPlain
                                ? job_.mesh.plain_value(cell_, info.offset + c, w)
                                : job_.mesh.value(cell_, body, info.offset + c, w));
    }
    return job_.field->scalar(components_);
  }

  /// Where a contact passes the plane, a little beside it as the pieces are.
  void add_contact(const ContactPolygon& contact) {
    const Vec3 nudge = job_.sides.nudge();
    const double beside = dot(nudge, job_.sides.normal());
    const auto distance = [&](const Weights& w) {
      return w[0] * distances_[0] + w[1] * distances_[1] + w[2] * distances_[2] + w[3] * distances_[3] -
             beside;
    };
    Segment segment;
    std::size_t found = 0;
    const std::size_t n = contact.corners.size();
    for (std::size_t i = 0; i < n && found < 2; ++i) {
      const Weights &p = contact.corners[i].weights, &q = contact.corners[(i + 1) % n].weights;
      const double dp = distance(p), dq = distance(q);
      if ((dp > 0) == (dq > 0)) continue;
      segment[found++] = PlaneSides::crossing(point(p), dp, point(q), dq) - nudge;
    }
    if (found == 2) part_.interface_edges.push_back(segment);
  }

  const Job& job_;
  Part& part_;
  std::size_t cell_ = 0;
  std::array<double, 4> distances_{};
  std::array<Vec3, 4> positions_;
  std::vector<Weights> polygon_;
  CellOwnership ownership_;
  std::vector<OwnedPolygon> owned_;
  std::vector<ContactPolygon> contacts_;
  std::vector<double> components_;
};

void check_choice(const ResampledMesh& mesh, const FieldChoice& choice) {
  if (choice.field >= mesh.fields.size())
    fail("{}: expected a field below {}, found {}", mesh.source, mesh.fields.size(), choice.field);
  const FieldInfo& info = mesh.fields[choice.field];
  if (choice.component && *choice.component >= static_cast<std::size_t>(info.components)) {
    fail("{}: field '{}': expected a component below {}, found {}", mesh.source, info.name, info.components,
         *choice.component);
  }
}

template <class T>
void append(std::vector<T>& to, std::vector<T>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

CrossSection cross_section(const ResampledMesh& mesh, const Plane& plane,
                           const std::optional<FieldChoice>& field, SectionMode mode) {
  if (field) check_choice(mesh, *field);
  Job job{mesh, PlaneSides(plane, mesh.box, mesh.source), field, mode, {}};
  job.distances.resize(mesh.points.size());
  parallel_for(mesh.points.size(), std::size_t{1} << 14,
               [&](std::size_t i) { job.distances[i] = job.sides.distance(mesh.points[i]); });
  std::vector<Part> parts((mesh.cells.size() + kChunk - 1) / kChunk);
  parallel_chunks(mesh.cells.size(), kChunk, [&](std::size_t first, std::size_t last) {
    CellCutter cutter(job, parts[first / kChunk]);
    for (std::size_t cell = first; cell < last; ++cell) cutter.cut(cell);
  });
  CrossSection section;
  for (Part& part : parts) {
    append(section.pieces, part.pieces);
    append(section.cell_edges, part.cell_edges);
    append(section.interface_edges, part.interface_edges);
  }
  make_unique(section.cell_edges);
  make_unique(section.interface_edges);
  section.material_area.assign(mesh.materials.size(), 0);
  for (const SectionPiece& piece : section.pieces) {
    const double area = polygon_area(piece.corners);
    section.material_area[piece.material] += area;
    section.area += area;
  }
  return section;
}

}  // namespace adamas::interfaces
