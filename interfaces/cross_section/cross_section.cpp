#include "interfaces/cross_section/cross_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/geometry/plane_sides.h"
#include "core/geometry/tetrahedron.h"
#include "interfaces/cross_section/trapezoidal_decomposition.h"
#include "interfaces/network/box_tree.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

namespace {

bool comes_before(const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

/// Returns the segment with its lexicographically smaller end first.
Segment directed(const Segment& segment) {
  return comes_before(segment[1], segment[0]) ? Segment{segment[1], segment[0]} : segment;
}

/// Returns whether a directed segment comes before another one.
bool comes_before(const Segment& a, const Segment& b) {
  return a[0] == b[0] ? comes_before(a[1], b[1]) : comes_before(a[0], b[0]);
}

/// Removes segments without a length and duplicates, independent of their direction, and sorts the rest.
void make_unique(std::vector<Segment>& segments) {
  std::erase_if(segments, [](const Segment& s) { return s[0] == s[1]; });
  for (Segment& s : segments) s = directed(s);
  std::sort(segments.begin(), segments.end(),
            [](const Segment& a, const Segment& b) { return comes_before(a, b); });
  segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
}

/// Throws Error that names `source` if a field or its component does not exist.
template <class Fields>
void check_choice(const FieldChoice& choice, const Fields& fields, const std::string& source) {
  if (choice.field >= fields.size())
    fail("{}: expected a field below {}, found {}", source, fields.size(), choice.field);
  const auto& field = fields[choice.field];
  if (choice.component && *choice.component >= static_cast<std::size_t>(field.components)) {
    fail("{}: field '{}': expected a component below {}, found {}", source, field.name, field.components,
         *choice.component);
  }
}

template <class T>
void append(std::vector<T>& to, std::vector<T>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

std::vector<Segment> section_edges(const InterfaceMesh& mesh, const Plane& plane, const Box3& box) {
  const PlaneSides sides(plane, box, mesh.source);
  std::vector<double> distances(mesh.points.size());
  for (std::size_t i = 0; i < distances.size(); ++i) distances[i] = sides.distance(mesh.points[i]);
  std::vector<Segment> segments;
  for (const InterfaceTriangle& t : mesh.triangles) {
    Segment segment;
    std::size_t found = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint32_t a = t.points[i], b = t.points[(i + 1) % 3];
      if (sides.above(distances[a]) == sides.above(distances[b])) continue;
      // The ends are ordered by their places, so that the points are equal to the bit in every triangle and
      // in every part of the mesh.
      if (comes_before(mesh.points[b], mesh.points[a])) std::swap(a, b);
      segment[found++] = PlaneSides::crossing(mesh.points[a], distances[a], mesh.points[b], distances[b]);
    }
    if (found == 2) segments.push_back(segment);
  }
  make_unique(segments);
  return segments;
}

namespace {

constexpr std::size_t kChunk = 1024;

/// The mesh, the plane and the chosen field, which are shared by all threads.
struct Job {
  const ResampledMesh& mesh;
  PlaneSides sides;
  std::optional<FieldChoice> field;
  SectionMode mode;
  std::vector<double> distances;  ///< the distances of the mesh's vertices from the plane
};

/// The section of a range of cells.
struct Part {
  std::vector<SectionPiece> pieces;
  std::vector<Segment> cell_edges, interface_edges;
};

/// Cuts one cell after another.
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
  /// three if the cell only touches the plane. Returns false if the cell lies on one side.
  bool find_polygon(const std::array<std::uint32_t, 4>& vertices) {
    std::array<std::size_t, 4> up{}, down{};
    std::size_t ups = 0, downs = 0;
    for (std::size_t i = 0; i < 4; ++i) (job_.sides.above(distances_[i]) ? up[ups++] : down[downs++]) = i;
    if (ups == 0 || downs == 0) return false;
    polygon_.clear();
    const auto add = [&](std::size_t a, std::size_t b) {
      // The ends are ordered equally in every cell, so that the points are equal to the bit.
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

  /// Divides the polygon between its owners. Since interfaces may coincide with the plane, owners are found a
  /// little off it.
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

  /// Adds the line in which a contact cuts the plane, moved a little off the plane as the pieces are.
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

}  // namespace

CrossSection cross_section(const ResampledMesh& mesh, const Plane& plane,
                           const std::optional<FieldChoice>& field, SectionMode mode) {
  if (field) check_choice(*field, mesh.fields, mesh.source);
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

namespace {

/// The part of a site's cell between two coordinates of an axis.
struct Interval {
  double low, high;
  std::size_t site;
};

std::vector<Interval> intervals(const RectilinearGrid& grid, int axis) {
  const auto& x = grid.nodes[static_cast<std::size_t>(axis)];
  std::vector<Interval> list;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    if (grid.centering == Centering::kCells) {
      list.push_back({x[i], x[i + 1], i});
      continue;
    }
    const double middle = 0.5 * (x[i] + x[i + 1]);
    list.push_back({x[i], middle, i});
    list.push_back({middle, x[i + 1], i + 1});
  }
  return list;
}

class GridSection {
 public:
  GridSection(const MultiMaterialData& data, const Plane& plane, const std::optional<FieldChoice>& field)
      : data_(data), sides_(plane, data.grid.domain(), data.source), choice_(field) {
    for (int axis = 0; axis < 3; ++axis)
      intervals_[static_cast<std::size_t>(axis)] = intervals(data.grid, axis);
    if (!field) return;
    check_choice(*field, data.fields, data.source);
    field_ = &data.fields[field->field];
  }

  [[nodiscard]] std::size_t layers() const { return intervals_[2].size(); }

  void cut_layer(std::size_t layer, std::vector<SectionPiece>& pieces) const {
    const Interval& z = intervals_[2][layer];
    const Vec3 low = data_.grid.domain().min, high = data_.grid.domain().max;
    if (!meets({{low.x, low.y, z.low}, {high.x, high.y, z.high}})) return;
    std::vector<Vec3> corners;
    for (const Interval& y : intervals_[1]) {
      const auto [from, to] = sides_.bounds_along(0, {{low.x, y.low, z.low}, {high.x, y.high, z.high}});
      auto x = std::ranges::lower_bound(intervals_[0], from, {}, &Interval::high);
      for (; x != intervals_[0].end() && x->low <= to; ++x) {
        cut_box(sides_, {{x->low, y.low, z.low}, {x->high, y.high, z.high}}, corners);
        if (!corners.empty()) pieces.push_back(piece(corners, {x->site, y.site, z.site}));
      }
    }
  }

 private:
  using Site = std::array<std::size_t, 3>;

  [[nodiscard]] std::size_t components() const { return static_cast<std::size_t>(field_->components); }

  /// Returns whether the plane may cut a box.
  [[nodiscard]] bool meets(const Box3& box) const {
    const Vec3 half = 0.5 * box.size(), &n = sides_.normal();
    const double reach = std::abs(n.x) * half.x + std::abs(n.y) * half.y + std::abs(n.z) * half.z;
    const double d = dot(n, box.center() - sides_.plane().origin);
    return std::abs(d) <= reach * (1 + 1e-9) || sides_.snapped(std::abs(d) - reach) == 0;
  }

  [[nodiscard]] SectionPiece piece(const std::vector<Vec3>& corners, const Site& site) const {
    SectionPiece result;
    result.corners = corners;
    result.cell = data_.grid.site_index(site[0], site[1], site[2]);
    result.material = material(result.cell);
    if (field_ == nullptr) return result;
    const bool constant = field_->per_material() || data_.grid.centering == Centering::kCells;
    for (const Vec3& p : corners)
      result.values.push_back(constant ? stated_value(result.material, result.cell) : interpolated(p));
    return result;
  }

  /// Returns the material with the greatest fraction at a site.
  [[nodiscard]] MaterialId material(std::size_t site) const {
    if (!data_.labels.empty()) return MaterialId(std::as_const(data_.labels)[site]);
    MaterialId greatest(0);
    for (MaterialId m(1); m.value < data_.materials.size(); ++m.value) {
      if (data_.fraction(m, site) > data_.fraction(greatest, site)) greatest = m;
    }
    return greatest;
  }

  [[nodiscard]] double stated_value(MaterialId material, std::size_t site) const {
    std::vector<double> row(components(), std::nan(""));
    const auto copy = [&](const FieldValues& values) {
      for (std::size_t c = 0; c < row.size() && !values.empty(); ++c) row[c] = values[site * row.size() + c];
    };
    if (!field_->per_material()) {
      copy(field_->values);
    } else if (material.value < field_->material_values.size()) {
      copy(field_->material_values[material]);
    }
    return choice_->scalar(row);
  }

  /// Returns the value at a point by trilinear interpolation between the points of the grid.
  [[nodiscard]] double interpolated(const Vec3& p) const {
    Site low{};
    std::array<double, 3> t{};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto& x = data_.grid.nodes[a];
      const double q = std::clamp(p[static_cast<int>(a)], x.front(), x.back());
      const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, q);
      low[a] = static_cast<std::size_t>(above - x.begin()) - 1;
      t[a] = (q - x[low[a]]) / (x[low[a] + 1] - x[low[a]]);
    }
    std::vector<double> row(components(), 0.0);
    for (unsigned corner = 0; corner < 8; ++corner) {
      double weight = 1;
      Site s = low;
      for (std::size_t a = 0; a < 3; ++a) {
        const unsigned high = corner >> a & 1u;
        weight *= high != 0 ? t[a] : 1 - t[a];
        s[a] += high;
      }
      if (weight == 0) continue;
      const std::size_t site = data_.grid.site_index(s[0], s[1], s[2]);
      for (std::size_t c = 0; c < row.size(); ++c)
        row[c] += weight * static_cast<double>(field_->values[site * row.size() + c]);
    }
    return choice_->scalar(row);
  }

  const MultiMaterialData& data_;
  PlaneSides sides_;
  std::optional<FieldChoice> choice_;
  const Field* field_ = nullptr;
  std::array<std::vector<Interval>, 3> intervals_;
};

}  // namespace

std::vector<Segment> piece_edges(const std::vector<SectionPiece>& pieces) {
  struct Edge {
    Segment segment;
    std::size_t site;
  };
  std::vector<Edge> edges;
  for (const SectionPiece& piece : pieces) {
    for (std::size_t i = 0; i < piece.corners.size(); ++i) {
      edges.push_back(
          {directed({piece.corners[i], piece.corners[(i + 1) % piece.corners.size()]}), piece.cell});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.segment == b.segment ? a.site < b.site : comes_before(a.segment, b.segment);
  });
  std::vector<Segment> result;
  for (std::size_t i = 0; i < edges.size();) {
    bool inner = false;
    std::size_t end = i + 1;
    for (; end < edges.size() && edges[end].segment == edges[i].segment; ++end)
      inner = inner || edges[end].site == edges[end - 1].site;
    if (!inner) result.push_back(edges[i].segment);
    i = end;
  }
  return result;
}

CrossSection cross_section(const MultiMaterialData& data, const Plane& plane,
                           const std::optional<FieldChoice>& field, bool cell_edges) {
  const GridSection grid(data, plane, field);
  std::vector<std::vector<SectionPiece>> layers(grid.layers());
  parallel_for(layers.size(), 1, [&](std::size_t layer) { grid.cut_layer(layer, layers[layer]); });
  CrossSection section;
  for (auto& pieces : layers) append(section.pieces, pieces);
  if (cell_edges) section.cell_edges = piece_edges(section.pieces);
  section.material_area.assign(data.materials.size(), 0);
  for (const SectionPiece& piece : section.pieces) {
    const double area = polygon_area(piece.corners);
    section.area += area;
    if (!data.labels.empty()) {
      section.material_area[piece.material] += area;
      continue;
    }
    for (MaterialId m(0); m.value < data.materials.size(); ++m.value)
      section.material_area[m] += area * static_cast<double>(data.fraction(m, piece.cell));
  }
  return section;
}

namespace {

double cross(const PlanePoint& a, const PlanePoint& b) { return a[0] * b[1] - a[1] * b[0]; }
PlanePoint operator-(const PlanePoint& a, const PlanePoint& b) { return {a[0] - b[0], a[1] - b[1]}; }
PlanePoint at(const PlanePoint& p, double t, const PlanePoint& way) {
  return {p[0] + t * way[0], p[1] + t * way[1]};
}

/// Returns whether a convex polygon of either orientation contains a point.
bool contains(const std::vector<PlanePoint>& polygon, const PlanePoint& p) {
  bool left = false, right = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const double turn = cross(polygon[(i + 1) % polygon.size()] - polygon[i], p - polygon[i]);
    left = left || turn > 0;
    right = right || turn < 0;
  }
  return !(left && right);
}

/// The lines of a section, in a tree that finds the first one that a ray meets.
class LineTree {
 public:
  explicit LineTree(std::span<const PlaneSegment> lines) : lines_(lines) {
    std::vector<Box3> boxes;
    for (const PlaneSegment& line : lines) {
      boxes.push_back(box_of(line));
      for (const PlanePoint& p : line) bounds_.extend({p[0], p[1], 0});
    }
    tree_ = BoxTree(boxes);
  }
  /// Returns a length greater than the distance of any two points.
  [[nodiscard]] double size() const { return 2 * bounds_.diagonal(); }
  /// Returns the length of a ray with unit direction from the end of a line until it meets another line,
  /// within a tolerance.
  [[nodiscard]] double free_length(std::uint32_t from, const PlanePoint& p, const PlanePoint& direction,
                                   double tolerance) const {
    double nearest = size();
    tree_.for_each_touching(
        box_of({at(p, -tolerance, direction), at(p, nearest, direction)}), [&](std::uint32_t i) {
          const auto& [a, b] = lines_[i];
          const PlanePoint along = b - a;
          const double length = std::hypot(along[0], along[1]), turn = cross(direction, along);
          if (i == from || std::abs(turn) <= 1e-12 * length) return true;
          const double t = cross(a - p, along) / turn, u = cross(a - p, direction) / turn * length;
          if (t >= -tolerance && u >= -tolerance && u <= length + tolerance) nearest = std::min(nearest, t);
          return true;
        });
    return nearest;
  }

 private:
  static Box3 box_of(const PlaneSegment& line) {
    Box3 box;
    for (const PlanePoint& p : line) box.extend({p[0], p[1], 0});
    return box;
  }
  std::span<const PlaneSegment> lines_;
  Box3 bounds_;
  BoxTree tree_;
};

/// Continues lines that end inside the outline straight to the next line. Bodies continue there as if their
/// interfaces did, so that each part between the lines belongs to one body.
void continue_open_ends(const std::vector<PlanePoint>& outline, std::vector<PlaneSegment>& lines) {
  std::vector<std::pair<PlanePoint, std::uint32_t>> ends;
  for (std::uint32_t i = 0; i < lines.size(); ++i) {
    for (const PlanePoint& p : lines[i]) ends.emplace_back(p, i);
  }
  std::sort(ends.begin(), ends.end());
  const LineTree tree(lines);
  const double tolerance = 1e-9 * tree.size();
  std::vector<PlaneSegment> added;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const auto& [p, line] = ends[i];
    const bool shared = (i > 0 && ends[i - 1].first == p) || (i + 1 < ends.size() && ends[i + 1].first == p);
    if (shared || !contains(outline, p)) continue;
    const PlanePoint along = p - lines[line][lines[line][0] == p ? 1 : 0];
    const double length = std::hypot(along[0], along[1]);
    const PlanePoint direction{along[0] / length, along[1] / length};
    const double way = tree.free_length(line, p, direction, tolerance);
    if (way > tolerance) added.push_back({p, at(p, way + tolerance, direction)});
  }
  lines.insert(lines.end(), added.begin(), added.end());
}

}  // namespace

CrossSection cross_section(const InterfaceNetwork& network, const Box3& box, std::size_t materials,
                           const Plane& plane, const std::string& source) {
  const PlaneSides sides(plane, box, source);
  const PlaneFrame frame = plane_frame(plane);
  // Interfaces may cross the sides of the box and, if that was allowed, each other.
  std::vector<PlanePoint> outline;
  for (const Vec3& p : clip_plane(plane, box)) outline.push_back(frame.coordinates(p));
  std::vector<PlaneSegment> lines;
  for (std::size_t i = 0; i < outline.size(); ++i)
    lines.push_back({outline[i], outline[(i + 1) % outline.size()]});
  for (const Segment& s : section_edges(network_mesh(network, {}, source), plane, box))
    lines.push_back({frame.coordinates(s[0]), frame.coordinates(s[1])});
  continue_open_ends(outline, lines);

  // If the plane is orthogonal to an axis, the frame's origin lies on its normal but not in the plane.
  const Vec3& normal = sides.normal();
  const Vec3 base = frame.origin + dot(normal, plane.origin - frame.origin) * normal;
  const bool mirrored = dot(cross(frame.right, frame.up), plane.normal) < 0;
  CrossSection section;
  section.material_area.assign(materials, 0);
  for (const Trapezoid& part : trapezoidal_decomposition(lines)) {
    const PlanePoint middle = part.middle();
    if (!contains(outline, middle)) continue;
    const auto place = [&](const PlanePoint& p) { return base + p[0] * frame.right + p[1] * frame.up; };
    SectionPiece piece;
    for (const PlanePoint& p : part.corners) piece.corners.push_back(place(p));
    if (mirrored) std::reverse(piece.corners.begin(), piece.corners.end());
    piece.body = network.body_at(place(middle) + sides.nudge());
    piece.material = network.table().material(piece.body);
    const double area = polygon_area(piece.corners);
    section.area += area;
    section.material_area[piece.material] += area;
    section.pieces.push_back(std::move(piece));
  }
  return section;
}

}  // namespace adamas::interfaces
