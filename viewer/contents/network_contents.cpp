#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/geometry/length_limits.h"
#include "core/io/interface_mesh_io.h"
#include "interfaces/cross_section/cross_section.h"
#include "interfaces/network/domain_faces.h"
#include "interfaces/network/interface_mesh_check.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/network/mending.h"
#include "viewer/contents/material_contents.h"
#include "viewer/contents/mesh_maker.h"
#include "viewer/contents/pair_surfaces.h"
#include "viewer/contents/section_meshes.h"

namespace adamas::viewer {

using namespace interfaces;
using namespace io;
using namespace isosurface;

namespace {

/// The relative distance by which the box extends beyond the interfaces on sides where none of them ends.
constexpr double kMargin = 0.05;

/// The sides of the interfaces' own box, as bits of domain_faces_at, along which borders of sheets run that
/// continue inside: those of a domain at which they were cut off.
unsigned sides_with_ends(const InterfaceMesh& mesh, const Box3& box) {
  std::vector<std::pair<std::uint64_t, unsigned>> edges;
  for (const InterfaceTriangle& t : mesh.triangles) {
    std::array<unsigned, 3> sides{};
    for (std::size_t i = 0; i < 3; ++i) sides[i] = domain_faces_at(box, mesh.points[t.points[i]]);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next = (i + 1) % 3, last = (i + 2) % 3;
      edges.emplace_back(edge_key(t.points[i], t.points[next]), sides[i] & sides[next] & ~sides[last]);
    }
  }
  std::sort(edges.begin(), edges.end());
  unsigned found = 0;
  for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
    while (last < edges.size() && edges[last].first == edges[first].first) ++last;
    if (last - first == 1) found |= edges[first].second;
  }
  return found;
}

Box3 shown_box(const InterfaceMesh& mesh) {
  Box3 box;
  for (const InterfaceTriangle& t : mesh.triangles) {
    for (const std::uint32_t p : t.points) box.extend(mesh.points[p]);
  }
  const unsigned ends = sides_with_ends(mesh, box);
  const Vec3 size = box.size();
  const double diagonal = box.diagonal();
  for (int axis = 0; axis < 3; ++axis) {
    const double margin = kMargin * (size[axis] > 0 ? size[axis] : diagonal);
    if ((ends >> (2 * axis) & 1u) == 0) box.min[axis] -= margin;
    if ((ends >> (2 * axis) & 2u) == 0) box.max[axis] += margin;
  }
  return box;
}

class NetworkContents final : public MaterialContents {
 public:
  NetworkContents(const InterfaceMesh& mesh, const Box3& box)
      : box_(box), materials_(mesh.materials), network_(mesh, box) {
    if (network_.table().body_count() == 0)
      fail("{}: expected triangles between two materials, found none", mesh.source);
    mesh_ = network_mesh(network_, materials_, mesh.source);
    surfaces_ = pair_surfaces(mesh_);
  }

  [[nodiscard]] const std::vector<std::string>& materials() const override { return materials_; }
  [[nodiscard]] const std::vector<std::string>& fields() const override { return no_fields_; }
  [[nodiscard]] Box3 box() const override { return box_; }
  [[nodiscard]] std::string summary() const override {
    return counted(mesh_.triangles.size(), "triangle", "triangles") + ", " +
           counted(mesh_.points.size(), "point", "points") + ", " +
           counted(materials_.size(), "material", "materials");
  }
  [[nodiscard]] std::pair<double, double> field_range(std::size_t) const override {
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  }
  [[nodiscard]] std::vector<Interface> interfaces(std::optional<std::size_t>) const override;
  [[nodiscard]] Section section(const Plane& plane, std::optional<std::size_t>) const override;
  [[nodiscard]] Reading at(const Vec3& p, std::optional<std::size_t>) const override {
    Reading reading;
    if (box_.contains(p)) reading.material = network_.table().material(network_.body_at(p)).value;
    return reading;
  }

 private:
  Box3 box_;
  IdVector<MaterialId, std::string> materials_;
  std::vector<std::string> no_fields_;
  InterfaceNetwork network_;
  InterfaceMesh mesh_;  ///< the part of the network that is kept
  std::vector<PairSurface> surfaces_;
};

std::vector<MaterialContents::Interface> NetworkContents::interfaces(std::optional<std::size_t>) const {
  std::vector<Interface> result;
  for (const PairSurface& surface : surfaces_) {
    MeshMaker maker(box_.center(), MeshMaker::Kind::kTriangles);
    for (const PairSurface::Vertex& vertex : surface.vertices)
      maker.add_vertex(mesh_.points[vertex.point], vertex.normal, {});
    for (const std::uint32_t vertex : surface.indices) maker.add_index(vertex);
    result.push_back({surface.front.value, surface.back.value, maker.finish(), surface.area});
  }
  return result;
}

MaterialContents::Section NetworkContents::section(const Plane& plane, std::optional<std::size_t>) const {
  if (!cuts(plane, box_)) return {std::vector<SharedMesh>(materials_.size()), {}, {}};
  CrossSection section = cross_section(network_, box_, materials_.size(), plane, mesh_.source);
  section.interface_edges = section_edges(mesh_, plane, box_);
  return section_meshes(section, plane, box_.center());
}

}  // namespace

std::unique_ptr<MaterialContents> make_network_contents(InterfaceMesh mesh, Progress& progress) {
  progress.step("checking interfaces", -1);
  check_interface_arrays(mesh);
  weld(mesh);
  const Box3 box = shown_box(mesh);
  check_lengths(mesh.source, box);
  InterfaceMendingOptions mending;
  mending.tolerant = true;
  mend_interface_mesh(mesh, &box, mending);
  check_interface_mesh(mesh, &box, {true, true});
  progress.step("finding bodies", -1);
  return std::make_unique<NetworkContents>(mesh, box);
}

}  // namespace adamas::viewer
