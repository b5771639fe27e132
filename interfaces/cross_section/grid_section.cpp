#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/geometry/plane_sides.h"
#include "interfaces/cross_section/cross_section.h"

namespace adamas::interfaces {

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
    if (field->field >= data.fields.size())
      fail("{}: expected a field below {}, found {}", data.source, data.fields.size(), field->field);
    field_ = &data.fields[field->field];
    if (field->component && *field->component >= components()) {
      fail("{}: field '{}': expected a component below {}, found {}", data.source, field_->name,
           field_->components, *field->component);
    }
  }

  [[nodiscard]] std::size_t layers() const { return intervals_[2].size(); }

  void cut_layer(std::size_t layer, std::vector<SectionPiece>& pieces) const {
    const Interval& z = intervals_[2][layer];
    const Vec3 low = data_.grid.domain().min, high = data_.grid.domain().max;
    if (!meets({{low.x, low.y, z.low}, {high.x, high.y, z.high}})) return;
    std::vector<Vec3> corners;
    for (const Interval& y : intervals_[1]) {
      if (!meets({{low.x, y.low, z.low}, {high.x, y.high, z.high}})) continue;
      for (const Interval& x : intervals_[0]) {
        cut_box(sides_, {{x.low, y.low, z.low}, {x.high, y.high, z.high}}, corners);
        if (!corners.empty()) pieces.push_back(piece(corners, {x.site, y.site, z.site}));
      }
    }
  }

 private:
  using Site = std::array<std::size_t, 3>;

  [[nodiscard]] std::size_t components() const { return static_cast<std::size_t>(field_->components); }

  /// Whether the plane may cut a box.
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
    result.material = MaterialId(0);
    for (MaterialId m(1); m.value < data_.materials.size(); ++m.value) {
      if (data_.fraction(m, result.cell) > data_.fraction(result.material, result.cell)) result.material = m;
    }
    if (field_ == nullptr) return result;
    const bool constant = field_->per_material() || data_.grid.centering == Centering::kCells;
    for (const Vec3& p : corners)
      result.values.push_back(constant ? stated(result.material, result.cell) : interpolated(p));
    return result;
  }

  [[nodiscard]] double stated(MaterialId material, std::size_t site) const {
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

  /// The value at a point by trilinear interpolation between the points of the grid.
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

/// Edges of the pieces, each once, but for those between two pieces of one site.
std::vector<Segment> site_edges(const std::vector<SectionPiece>& pieces) {
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

}  // namespace

CrossSection cross_section(const MultiMaterialData& data, const Plane& plane,
                           const std::optional<FieldChoice>& field) {
  const GridSection grid(data, plane, field);
  std::vector<std::vector<SectionPiece>> layers(grid.layers());
  parallel_for(layers.size(), 1, [&](std::size_t layer) { grid.cut_layer(layer, layers[layer]); });
  CrossSection section;
  for (auto& pieces : layers) {
    section.pieces.insert(section.pieces.end(), std::make_move_iterator(pieces.begin()),
                          std::make_move_iterator(pieces.end()));
  }
  section.cell_edges = site_edges(section.pieces);
  section.material_area.assign(data.materials.size(), 0);
  for (const SectionPiece& piece : section.pieces) {
    const double area = polygon_area(piece.corners);
    section.area += area;
    for (MaterialId m(0); m.value < data.materials.size(); ++m.value)
      section.material_area[m] += area * static_cast<double>(data.fraction(m, piece.cell));
  }
  return section;
}

}  // namespace adamas::interfaces
