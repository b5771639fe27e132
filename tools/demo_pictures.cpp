#include "tools/demo_pictures.h"

#include <algorithm>

#include "core/picture/interface_picture.h"
#include "core/picture/palette.h"
#include "core/picture/slice_picture.h"
#include "interfaces/cross_section/cross_section.h"

namespace adamas::demo {

namespace {

/// Wider than the mesh's interfaces, which are drawn above, so that both are seen where they agree.
Stroke wide_grey() { return {.colour = {0.6, 0.6, 0.6}, .width = 4.2}; }

Vec2 in_plane(const PlaneFrame& frame, const Vec3& p) {
  const auto [x, y] = frame.coordinates(p);
  return {x, y};
}

LineSet lines(const std::string& name, const Stroke& stroke, const std::vector<Segment>& segments,
              const PlaneFrame& frame) {
  LineSet set{name, stroke, {}};
  for (const Segment& segment : segments) {
    for (const Vec3& end : segment) set.points.push_back(in_plane(frame, end));
  }
  return set;
}

SlicePanel panel(const std::string& title, const CrossSection& section, const PlaneFrame& frame) {
  SlicePanel panel{title, {}, {}};
  for (const SectionPiece& piece : section.pieces) {
    FieldPolygon polygon{{}, piece.values, {}};
    for (const Vec3& corner : piece.corners) polygon.points.push_back(in_plane(frame, corner));
    panel.polygons.push_back(std::move(polygon));
  }
  panel.lines.push_back(lines("cells", cell_stroke(), section.cell_edges, frame));
  return panel;
}

}  // namespace

InterfaceMesh input_interfaces(const ResamplingSource& source) {
  const InterfaceNetwork& network = *source.network;
  InterfaceMesh mesh;
  mesh.source = source.name;
  mesh.materials = source.materials;
  mesh.points.assign(network.points().begin(), network.points().end());
  for (std::uint32_t t = 0; t < network.triangles().size(); ++t) {
    const auto& [front, back] = network.table().sides(network.interface_of(t));
    mesh.triangles.push_back(
        {network.triangles()[t], network.table().material(front), network.table().material(back)});
  }
  return mesh;
}

DemoSlices::DemoSlices(const MultiMaterialData& data, const ResampledMesh& mesh,
                       const InterfaceMesh& original, const Plane& plane, const std::string& field) {
  const FieldChoice choice = find_field(mesh.fields, field, mesh.source);
  const PlaneFrame frame = plane_frame(plane);
  const CrossSection input = cross_section(data, plane, choice);
  const CrossSection plain = cross_section(mesh, plane, choice, SectionMode::kPlain);
  const CrossSection own = cross_section(mesh, plane, choice, SectionMode::kPerMaterial);
  const LineSet original_lines =
      lines("interfaces of the input", wide_grey(), section_edges(original, plane, mesh.box), frame);
  const LineSet approximated =
      lines("interfaces of the mesh", approximated_interface_stroke(), own.interface_edges, frame);

  picture_.x_label = frame.right_name;
  picture_.y_label = frame.up_name;
  picture_.field_label = field_label(mesh.fields, choice);
  picture_.panels = {panel("input", input, frame), panel("linear interpolation in the cells", plain, frame),
                     panel("each material's own field", own, frame)};
  for (SlicePanel& p : picture_.panels) p.lines.push_back(original_lines);
  for (const std::size_t p : {std::size_t{1}, std::size_t{2}})
    picture_.panels[p].lines.push_back(approximated);
}

std::string DemoSlices::png(const std::optional<Box2>& window) const {
  SlicePicture picture = picture_;
  picture.window = window;
  SliceOptions options;
  options.width = 2000;
  return draw_slice(picture, PictureFormat::kPng, options);
}

std::string interfaces_png(const InterfaceMesh& mesh, const Box3& box,
                           const IdVector<MaterialId, double>& volumes, const std::string& title,
                           bool triangle_edges) {
  const auto smaller = [&](MaterialId a, MaterialId b) {
    return volumes[a] < volumes[b] || (volumes[a] == volumes[b] && a < b) ? a : b;
  };
  InterfacePicture picture;
  picture.title = title;
  picture.domain = box;
  std::vector<bool> shown(mesh.materials.size(), false);
  for (const InterfaceTriangle& t : mesh.triangles) {
    const MaterialId m = smaller(t.front, t.back);
    shown[m.value] = true;
    picture.triangles.push_back(
        {{mesh.points[t.points[0]], mesh.points[t.points[1]], mesh.points[t.points[2]]},
         material_colour(m.value)});
  }
  for (MaterialId m(0); m.value < shown.size(); ++m.value) {
    if (shown[m.value])
      picture.materials.push_back({.name = mesh.materials[m], .colour = material_colour(m.value)});
  }
  InterfacePictureOptions options;
  options.width = 1000;
  options.height = 800;
  options.triangle_edges = triangle_edges;
  return draw_interfaces(picture, PictureFormat::kPng, options);
}

}  // namespace adamas::demo
