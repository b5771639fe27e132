#include "interfaces/mesh/cut_mesh.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace adamas {

namespace {

using Integers = std::vector<std::int32_t>;
using Doubles = std::vector<double>;
using Strings = std::vector<std::string>;

std::int32_t integer(std::uint32_t value) { return static_cast<std::int32_t>(value); }

/// Divides cells in the order of their vertices' numbers, so that neighbours agree on what they share, and
/// gives points that coincide within one body one number.
class Cutter {
 public:
  explicit Cutter(const ResampledMesh& mesh) : mesh_(mesh), values_(mesh.fields.size()) {}

  void cut(std::size_t c) {
    auto vertices = mesh_.cells[c].vertices;
    std::sort(vertices.begin(), vertices.end());
    mesh_.cell_set().ownership(mesh_.table, vertices, ownership_);
    partition_cell(ownership_, parts_);
    for (const OwnedTetrahedron& part : parts_) add(c, vertices, part);
  }

  UnstructuredMesh finish() {
    result_.cell_arrays.push_back({"material", 1, std::move(material_)});
    result_.cell_arrays.push_back({"body", 1, std::move(body_)});
    result_.cell_arrays.push_back({"cell", 1, std::move(cell_)});
    for (std::size_t f = 0; f < mesh_.fields.size(); ++f) {
      result_.point_arrays.push_back(
          {mesh_.fields[f].name, mesh_.fields[f].components, std::move(values_[f])});
    }
    result_.field_arrays.push_back(
        {"material_names", 1, Strings(mesh_.materials.begin(), mesh_.materials.end())});
    return std::move(result_);
  }

 private:
  void add(std::size_t c, const std::array<std::uint32_t, 4>& vertices, const OwnedTetrahedron& part) {
    const BodyId owner(part.owner);
    std::array<Vec3, 4> x;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t v = 0; v < 4; ++v) {
        // Zero weights are left out: the sum is then the same in every cell that shares the corner.
        if (part.corners[i][v] != 0) x[i] += part.corners[i][v] * mesh_.points[vertices[v]];
      }
    }
    std::array<std::size_t, 4> order{0, 1, 2, 3};
    const double volume = signed_volume(x[0], x[1], x[2], x[3]);
    if (volume == 0) return;
    if (volume < 0) std::swap(order[2], order[3]);
    for (const std::size_t i : order)
      result_.connectivity.push_back(point(x[i], owner, vertices, part.corners[i]));
    result_.offsets.push_back(result_.connectivity.size());
    material_.push_back(integer(mesh_.table.material(owner).value));
    body_.push_back(integer(owner.value));
    cell_.push_back(static_cast<std::int32_t>(c));
  }

  std::uint32_t point(const Vec3& x, BodyId owner, const std::array<std::uint32_t, 4>& vertices,
                      const Weights& weights) {
    const auto [entry, fresh] =
        number_.try_emplace({x.x, x.y, x.z, owner.value}, static_cast<std::uint32_t>(result_.points.size()));
    if (!fresh) return entry->second;
    result_.points.push_back(x);
    for (std::size_t f = 0; f < mesh_.fields.size(); ++f) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(mesh_.fields[f].components); ++k) {
        double value = 0;
        for (std::size_t v = 0; v < 4; ++v) {
          if (weights[v] != 0)
            value += weights[v] * mesh_.vertices[vertices[v]].row(owner)[mesh_.fields[f].offset + k];
        }
        values_[f].push_back(value);
      }
    }
    return entry->second;
  }

  const ResampledMesh& mesh_;
  UnstructuredMesh result_;
  Integers material_, body_, cell_;
  std::vector<Doubles> values_;
  std::map<std::tuple<double, double, double, std::uint32_t>, std::uint32_t> number_;
  CellOwnership ownership_;
  std::vector<OwnedTetrahedron> parts_;
};

}  // namespace

UnstructuredMesh cut_mesh(const ResampledMesh& mesh) {
  Cutter cutter(mesh);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) cutter.cut(c);
  return cutter.finish();
}

}  // namespace adamas
