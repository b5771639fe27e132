#include "cli/resample_figures.h"

#include <nlohmann/json.hpp>

#include "interfaces/resampling/shortfall.h"

namespace adamas {

ResampleFigures measure(const Resampler& resampler, const Progress& progress) {
  const ResamplingSource& source = resampler.source();
  const InterfaceTable& table = source.network->table();
  const auto& hierarchy = resampler.hierarchy();
  const CellSet cells = resampler.cells();
  ResampleFigures figures;
  figures.tetrahedra = hierarchy.leaf_count();
  figures.vertices = hierarchy.vertex_count();
  figures.bodies = table.body_count();
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
  figures.volumes = material_volumes(table, cells, source.materials.size());
  return figures;
}

namespace {

/// A figure that is not known is null.
Figures known(bool is, double value) { return is ? Figures(value) : Figures(nullptr); }

/// Null where an error was reached.
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

}  // namespace

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
  const auto& distance = resampler.interface_distance();
  Figures figures;
  figures["tetrahedra"] = measured.tetrahedra;
  figures["vertices"] = measured.vertices;
  figures["interface_tetrahedra"] = measured.interface_tetrahedra;
  figures["interface_error"] = known(distance.has_value(), distance ? distance->upper : 0);
  figures["interface_error_measured"] = known(distance.has_value(), distance ? distance->lower : 0);
  figures["interface_error_target"] = resampler.options().interface_error;
  figures["interface_error_reached"] =
      distance ? Figures(distance->upper <= resampler.options().interface_error) : Figures(nullptr);
  figures["interface_error_shortfall"] = shortfall_figures(interface_shortfall(resampler));
  figures["lost_interfaces"] = measured.lost_interfaces;
  figures["fields"] = field_figures(measured, resampler);
  figures["materials"] = volume_figures(resampler.source(), measured.volumes);
  figures["bodies"] = measured.bodies;
  figures["interface_triangles"] = distance ? Figures(distance->triangles) : Figures(nullptr);
  figures["flagged_vertices"] = measured.flagged_vertices;
  return figures;
}

}  // namespace adamas
