#include "interfaces/resampling/resample_figures.h"

#include <algorithm>
#include <cmath>

#include "interfaces/reconstruction/dispersed_volume.h"

namespace adamas::interfaces {

namespace {

std::vector<ResampleReport::Body> body_figures(const Resampler& resampler, const CellSet& cells) {
  const ResamplingSource& source = resampler.source();
  const InterfaceNetwork& network = *source.network;
  const InterfaceTable& table = network.table();
  std::vector<ResampleReport::Body> bodies(table.body_count());
  const auto volumes = body_volumes(table, cells);
  const BodyReport* report = resampler.body_report();
  for (BodyId b(0); b.value < bodies.size(); ++b.value) {
    ResampleReport::Body& body = bodies[b.value];
    body.material = table.material(b).value;
    body.volume_mesh = volumes[b];
    if (!source.body_volumes.empty()) body.volume_input = source.body_volumes[b];
    body.lost = volumes[b] == 0;
    if (report == nullptr) continue;
    body.topology_input = report->input[b];
    body.topology_mesh = report->mesh[b];
    body.changed = !body.lost && !report->keeps_topology(b);
  }
  // The first triangle of a body gives its place.
  for (std::uint32_t t = static_cast<std::uint32_t>(network.triangles().size()); t-- > 0;) {
    const auto& [x, y, z] = network.triangle_corners(t);
    for (const BodyId b : table.sides(network.interface_of(t)))
      bodies[b.value].place = (1.0 / 3) * (x + y + z);
  }
  return bodies;
}

std::string budget_reason(const Resampler& resampler) {
  return fmt::format("the mesh may have no more than {} tetrahedra",
                     resampler.options().max_tetrahedra.value_or(0));
}

constexpr const char* kDeep = "the hierarchy is as deep there as it can be";

}  // namespace

ResampleFigures measure(const Resampler& resampler, const Progress& progress) {
  const ResamplingSource& source = resampler.source();
  const auto& hierarchy = resampler.hierarchy();
  const CellSet cells = resampler.cells();
  ResampleFigures figures;
  figures.tetrahedra = hierarchy.leaf_count();
  figures.vertices = hierarchy.vertex_count();
  figures.fields.resize(source.fields ? source.fields->fields().size() : 0);
  hierarchy.for_each_leaf([&](TetrahedronId t) {
    const CellRecord& cell = hierarchy.payload(t);
    if (cell.interface.lost) ++figures.lost_interfaces;
    const bool crossed = !cell.contacts.empty();
    if (crossed) ++figures.interface_tetrahedra;
    for (std::size_t f = 0; f < std::min(cell.fields.size(), figures.fields.size()); ++f) {
      figures.fields[f].all.add(cell.fields[f]);
      if (crossed) figures.fields[f].at_interfaces.add(cell.fields[f]);
    }
  });
  hierarchy.for_each_vertex([&](VertexId v) {
    if (hierarchy.payload(v).distances.flagged) ++figures.flagged_vertices;
  });
  progress.check();
  figures.bodies = body_figures(resampler, cells);
  figures.volumes = IdVector<MaterialId, double>(source.materials.size(), 0.0);
  for (const auto& body : figures.bodies) figures.volumes[MaterialId(body.material)] += body.volume_mesh;
  if (const BodyReport* report = resampler.body_report()) figures.contacts = report->contacts;
  return figures;
}

std::optional<BodyId> worst_volume(const ResampleFigures& measured) {
  std::optional<BodyId> worst;
  for (BodyId b(0); b.value < measured.bodies.size(); ++b.value) {
    const ResampleReport::Body& body = measured.bodies[b.value];
    if (!body.volume_input) continue;
    if (!worst || body.volume_error() > measured.bodies[worst->value].volume_error()) worst = b;
  }
  return worst;
}

std::vector<MaterialId> lost_materials(const ResampleFigures& measured, const ResamplingSource& source) {
  std::vector<MaterialId> lost;
  for (MaterialId m(0); m.value < measured.volumes.size(); ++m.value) {
    const bool in_input = std::any_of(measured.bodies.begin(), measured.bodies.end(),
                                      [m](const auto& body) { return body.material == m.value; }) ||
                          (m.value < source.volumes.size() && source.volumes[m] > 0 &&
                           !(source.findings && is_all_dispersed(*source.findings, m, source.volumes[m])));
    if (in_input && measured.volumes[m] == 0) lost.push_back(m);
  }
  return lost;
}

std::vector<UnreachedError> unreached_errors(const Resampler& resampler,
                                             const std::vector<FieldFigures>& fields) {
  std::vector<UnreachedError> result;
  const std::string wanted = "the interface error wanted";
  const auto add_distance = [&](const std::string& whose, const InterfaceDistance& distance) {
    if (auto why = interface_shortfall(resampler, distance))
      result.push_back(
          {wanted + whose, distance.upper, resampler.options().interface_error, std::move(*why)});
  };
  if (const auto& certificate = resampler.certificate()) {
    add_distance("", certificate->networks);
    // With two materials, the boundary of each consists of all interfaces.
    if (resampler.source().materials.size() > 2)
      add_distance(
          fmt::format(" for the boundary of '{}'", resampler.source().materials[certificate->worst_material]),
          certificate->materials);
    if (certificate->junctions)
      add_distance(" for the lines where three materials meet", *certificate->junctions);
  }
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (auto why = field_shortfall(resampler, f, fields[f].all))
      result.push_back(
          {fmt::format("the error wanted of the field '{}'", resampler.source().fields->fields()[f].name),
           fields[f].all.max, *resampler.options().field_errors[f], std::move(*why)});
  }
  return result;
}

std::optional<Shortfall> interface_shortfall(const Resampler& resampler, const InterfaceDistance& distance) {
  if (distance.upper <= resampler.options().interface_error) return {};
  const InterfaceNetwork& network = *resampler.source().network;
  // If the mesh has no interfaces, all points of the input's interfaces are equally far.
  const Vec3 place =
      std::isfinite(distance.lower) ? distance.worst : network.points()[network.triangles()[0][0]];
  switch (resampler.interface_end()) {
    case RefinementEnd::kBudget:
      return Shortfall{budget_reason(resampler), place};
    case RefinementEnd::kDepth:
      return Shortfall{kDeep, place};
    case RefinementEnd::kRounds:
      return Shortfall{"it still changed when measuring and refining had been repeated often enough", place};
    case RefinementEnd::kSmallestCells:
    case RefinementEnd::kReached:
      break;
  }
  const bool open = network.has_open_border() || network.inconsistencies() > 0;
  return Shortfall{
      open ? "the input's interfaces have open borders or do not match, and cells far smaller than "
             "the error do not bring the mesh's nearer"
           : "cells far smaller than the error do not bring the mesh's interfaces nearer",
      place};
}

std::optional<Shortfall> field_shortfall(const Resampler& resampler, std::size_t field,
                                         const FieldError& errors) {
  const auto& target = resampler.options().field_errors[field];
  if (!target || errors.count() == 0 || errors.max <= *target) return {};
  const ResamplingSource& source = resampler.source();
  const NativeElement& element = source.fields->native_elements()[errors.worst];
  const MaterialId owner = source.network->table().material(resampler.owner_at(element.position));
  const auto because = [&](std::string reason) { return Shortfall{std::move(reason), element.position}; };
  if (owner != element.material && element.kind == ElementKind::kMinority) {
    return because(
        fmt::format("the input's value there is of '{}', which has a part of the cell while the input's "
                    "interfaces give the place to another material, so that smaller cells do not help",
                    source.materials[element.material]));
  }
  if (!source.fields->interpolates(element, field)) {
    return because(
        fmt::format("the input's one value there is for all materials of the cell, and the field of "
                    "'{}' does not follow it, so that smaller cells do not help",
                    source.materials[element.material]));
  }
  if (owner != element.material) {
    return because(
        fmt::format("the input's value there is of '{}', but the mesh's interface, which may be off by its "
                    "own error, leaves the place to '{}'",
                    source.materials[element.material], source.materials[owner]));
  }
  if (resampler.budget_spent()) return because(budget_reason(resampler));
  if (!resampler.hierarchy().can_split(resampler.leaf_at(element.position))) return because(kDeep);
  return because("cells near by were refined after it had been reached there");
}

std::optional<Shortfall> volume_shortfall(const Resampler& resampler, const ResampleFigures& measured,
                                          BodyId body) {
  const auto& target = resampler.options().volume_error;
  const ResampleReport::Body& figures = measured.bodies[body.value];
  if (!target || figures.volume_error() <= *target) return {};
  const auto because = [&](std::string reason) { return Shortfall{std::move(reason), figures.place}; };
  const VolumeGoal* goal = resampler.volume_goal(body);
  if (goal != nullptr && std::abs(goal->enclosed - *figures.volume_input) > *target * *figures.volume_input)
    return because(fmt::format("the input's interfaces enclose {:.6g}", goal->enclosed));
  if (resampler.budget_spent()) return because(budget_reason(resampler));
  switch (resampler.volume_end(body)) {
    case RefinementEnd::kDepth:
      return because(kDeep);
    case RefinementEnd::kSmallestCells:
      return because("smaller cells do not bring it nearer");
    default:
      return because("cells or interfaces were changed for other errors after it had been reached");
  }
}

}  // namespace adamas::interfaces
