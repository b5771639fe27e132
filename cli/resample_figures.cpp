#include "cli/resample_figures.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "interfaces/resampling/shortfall.h"

namespace adamas {

namespace {

std::vector<BodyFigures> body_figures(const Resampler& resampler, const CellSet& cells) {
  const ResamplingSource& source = resampler.source();
  const InterfaceNetwork& network = *source.network;
  const InterfaceTable& table = network.table();
  std::vector<BodyFigures> bodies(table.body_count());
  const auto volumes = body_volumes(table, cells);
  const BodyReport* report = resampler.body_report();
  for (BodyId b(0); b.value < bodies.size(); ++b.value) {
    BodyFigures& body = bodies[b.value];
    body.material = table.material(b);
    body.volume = volumes[b];
    if (!source.body_volumes.empty()) body.volume_input = source.body_volumes[b];
    body.lost = volumes[b] == 0;
    if (report == nullptr) continue;
    body.topology_input = report->input[b];
    body.topology_mesh = report->mesh[b];
    body.changed = !body.lost && !report->kept(b);
  }
  // The place of a body is that of its first triangle.
  for (std::uint32_t t = static_cast<std::uint32_t>(network.triangles().size()); t-- > 0;) {
    const auto& [x, y, z] = network.triangle_corners(t);
    for (const BodyId b : table.sides(network.interface_of(t)))
      bodies[b.value].place = (1.0 / 3) * (x + y + z);
  }
  return bodies;
}

}  // namespace

ResampleFigures measure(const Resampler& resampler, const Progress& progress) {
  const ResamplingSource& source = resampler.source();
  const InterfaceTable& table = source.network->table();
  const auto& hierarchy = resampler.hierarchy();
  const CellSet cells = resampler.cells();
  ResampleFigures figures;
  figures.tetrahedra = hierarchy.leaf_count();
  figures.vertices = hierarchy.vertex_count();
  figures.fields.resize(source.fields ? source.fields->fields().size() : 0);
  const std::vector<char> crossed = cells_with_interfaces(table, cells, progress);
  std::size_t i = 0;
  hierarchy.for_each_leaf([&](TetrahedronId t) {
    const CellRecord& cell = hierarchy.payload(t);
    if (cell.interface.lost) ++figures.lost_interfaces;
    if (crossed[i] != 0) ++figures.interface_tetrahedra;
    for (std::size_t f = 0; f < std::min(cell.fields.size(), figures.fields.size()); ++f) {
      figures.fields[f].all.add(cell.fields[f]);
      if (crossed[i] != 0) figures.fields[f].at_interfaces.add(cell.fields[f]);
    }
    ++i;
  });
  hierarchy.for_each_vertex([&](VertexId v) {
    if (hierarchy.payload(v).distances.flagged) ++figures.flagged_vertices;
  });
  progress.check();
  figures.bodies = body_figures(resampler, cells);
  figures.volumes = IdVector<MaterialId, double>(source.materials.size(), 0.0);
  for (const BodyFigures& body : figures.bodies) figures.volumes[body.material] += body.volume;
  if (const BodyReport* report = resampler.body_report()) figures.contacts = report->contacts;
  return figures;
}

namespace {

/// The figure, or null where it is not known.
Figures known(bool is, double value) { return is ? Figures(value) : Figures(nullptr); }

/// The reason why an error was not reached; null where it was.
Figures shortfall_figures(const std::optional<Shortfall>& shortfall) {
  if (!shortfall) return nullptr;
  const Vec3& p = shortfall->place;
  return {{"reason", shortfall->reason}, {"place", {p.x, p.y, p.z}}};
}

Figures field_figures(const ResampleFigures& measured, const Resampler& resampler) {
  Figures figures = Figures::object();
  for (std::size_t f = 0; f < measured.fields.size(); ++f) {
    const FieldError& all = measured.fields[f].all;
    const auto& target = resampler.options().field_errors[f];
    Figures figure = field_error_figures(measured.fields[f]);
    figure["target"] = known(target.has_value(), target.value_or(0));
    figure["reached"] = target && all.count() > 0 ? Figures(all.max <= *target) : Figures(nullptr);
    figure["shortfall"] = shortfall_figures(field_shortfall(resampler, f, all));
    figures[resampler.source().fields->fields()[f].name] = std::move(figure);
  }
  return figures;
}

/// A distance between interfaces: certified, attained, whether it is within the target, and if not, why.
void add_distance(Figures& figures, const std::string& name, const Resampler& resampler,
                  const std::optional<InterfaceDistance>& distance) {
  const auto shortfall = distance ? interface_shortfall(resampler, *distance) : std::nullopt;
  figures[name] = known(distance.has_value(), distance ? distance->upper : 0);
  figures[name + "_measured"] = known(distance.has_value(), distance ? distance->lower : 0);
  figures[name + "_reached"] = distance ? Figures(!shortfall) : Figures(nullptr);
  figures[name + "_shortfall"] = shortfall_figures(shortfall);
}

Figures body_row(const BodyFigures& body, const Resampler& resampler) {
  Figures row{{"material", resampler.source().materials[body.material]},
              {"volume_input", body.volume_input ? Figures(*body.volume_input) : Figures(nullptr)},
              {"volume_mesh", body.volume},
              {"place", {body.place.x, body.place.y, body.place.z}}};
  if (const BodyReport* report = resampler.body_report()) {
    row["pieces"] = body.topology_mesh.pieces;
    row["euler_input"] = report->comparable ? Figures(body.topology_input.euler) : Figures(nullptr);
    row["euler_mesh"] = body.topology_mesh.euler;
  }
  return row;
}

/// Counts of the bodies that the mesh does not show as the input has them, and a row for each of these.
void add_bodies(Figures& figures, const ResampleFigures& measured, const Resampler& resampler) {
  std::size_t lost = 0, changed = 0;
  Figures rows = Figures::array();
  for (const BodyFigures& body : measured.bodies) {
    if (body.lost) ++lost;
    if (body.changed) ++changed;
    if (body.lost || body.changed) rows.push_back(body_row(body, resampler));
  }
  figures["bodies"] = measured.bodies.size();
  figures["lost_bodies"] = lost;
  figures["lost_materials"] = lost_materials(measured, resampler.source()).size();
  figures["changed_bodies"] = changed;
  figures["wrong_bodies"] = std::move(rows);
  figures["contacts"] = measured.contacts.size();
  const double whole = resampler.source().box.volume();
  figures["conserved"] =
      !resampler.options().conserve
          ? Figures(nullptr)
          : Figures(std::all_of(measured.bodies.begin(), measured.bodies.end(),
                                [whole](const BodyFigures& b) { return b.missing() <= kConserved * whole; }));
}

void add_certificate(Figures& figures, const Resampler& resampler) {
  const auto& certificate = resampler.certificate();
  const bool made = certificate.has_value();
  const auto of = [&](InterfaceDistance InterfaceCertificate::*distance) {
    return made ? std::optional((*certificate).*distance) : std::nullopt;
  };
  figures["interface_error_target"] = resampler.options().interface_error;
  add_distance(figures, "interface_error", resampler, of(&InterfaceCertificate::networks));
  add_distance(figures, "interface_error_per_material", resampler, of(&InterfaceCertificate::materials));
  figures["interface_error_worst_material"] =
      made ? Figures(resampler.source().materials[certificate->worst_material]) : Figures(nullptr);
  add_distance(figures, "junction_error", resampler, made ? certificate->junctions : std::nullopt);
}

}  // namespace

std::vector<MaterialId> lost_materials(const ResampleFigures& measured, const ResamplingSource& source) {
  std::vector<MaterialId> lost;
  for (MaterialId m(0); m.value < measured.volumes.size(); ++m.value) {
    const bool in_input = std::any_of(measured.bodies.begin(), measured.bodies.end(),
                                      [m](const BodyFigures& body) { return body.material == m; }) ||
                          (m.value < source.volumes.size() && source.volumes[m] > 0);
    if (in_input && measured.volumes[m] == 0) lost.push_back(m);
  }
  return lost;
}

Figures field_error_figures(const FieldFigures& errors) {
  const auto& [all, near] = errors;
  const auto of_kind = [&all = all](ElementKind kind) { return all.counts[static_cast<std::size_t>(kind)]; };
  return {{"max_error", known(all.count() > 0, all.max)},
          {"mean_error", known(all.count() > 0, all.mean())},
          {"reducible_max_error", known(all.count() > 0, all.reducible)},
          {"interface_max_error", known(near.count() > 0, near.max)},
          {"interface_mean_error", known(near.count() > 0, near.mean())},
          {"elements",
           {{"pure", of_kind(ElementKind::kPure)},
            {"mixed", of_kind(ElementKind::kMixed)},
            {"minority", of_kind(ElementKind::kMinority)},
            {"displaced", all.displaced},
            {"without_value", all.without_value}}}};
}

Figures volume_figures(const ResamplingSource& source, const IdVector<MaterialId, double>& volumes) {
  Figures figures = Figures::array();
  for (MaterialId m(0); m.value < volumes.size(); ++m.value) {
    const bool stated = m.value < source.volumes.size();
    figures.push_back({{"name", source.materials[m]},
                       {"volume_input", known(stated, stated ? source.volumes[m] : 0)},
                       {"volume_mesh", volumes[m]}});
  }
  return figures;
}

Figures resample_json(const ResampleFigures& measured, const Resampler& resampler) {
  Figures figures;
  figures["tetrahedra"] = measured.tetrahedra;
  figures["vertices"] = measured.vertices;
  figures["interface_tetrahedra"] = measured.interface_tetrahedra;
  add_certificate(figures, resampler);
  figures["lost_interfaces"] = measured.lost_interfaces;
  figures["fields"] = field_figures(measured, resampler);
  figures["materials"] = volume_figures(resampler.source(), measured.volumes);
  add_bodies(figures, measured, resampler);
  figures["interface_triangles"] =
      resampler.certificate() ? Figures(resampler.certificate()->triangles) : Figures(nullptr);
  figures["flagged_vertices"] = measured.flagged_vertices;
  return figures;
}

}  // namespace adamas
