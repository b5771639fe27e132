#include "cli/resample_report.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "cli/figures.h"
#include "cli/fraction_report.h"
#include "cli/several_notes.h"
#include "interfaces/resampling/shortfall.h"

namespace adamas {

namespace {

/// The text of a distance between interfaces, which is infinite where the mesh shows none.
std::string shown_length(double length) {
  return std::isinf(length) ? "none shown" : fmt::format("{:.4g}", length);
}

/// Notes which of the distances are greater than the interface error, and why.
void note_shortfalls(const InterfaceCertificate& certificate, const Resampler& resampler, Console& console) {
  const auto note = [&](const std::string& what, const InterfaceDistance& distance) {
    const auto shortfall = interface_shortfall(resampler, distance);
    if (!shortfall) return false;
    console.note("{} was not reached: {} instead of {:.4g}, at {}: {}", what, shown_length(distance.upper),
                 resampler.options().interface_error, place_text(shortfall->place), shortfall->reason);
    return true;
  };
  if (!note("the interface error wanted", certificate.networks))
    note(fmt::format("the interface error wanted for the boundary of '{}'",
                     resampler.source().materials[certificate.worst_material]),
         certificate.materials);
  if (certificate.junctions)
    note("the interface error wanted for the lines where three materials meet", *certificate.junctions);
}

void note_lost_materials(const ResampleFigures& m, const ResamplingSource& source, Console& console) {
  std::vector<MaterialId> lost = lost_materials(m, source);
  const bool known = !source.volumes.empty();
  if (known) std::ranges::stable_sort(lost, std::greater{}, [&](MaterialId i) { return source.volumes[i]; });
  std::vector<std::string> notes;
  for (const MaterialId material : lost)
    notes.push_back(
        fmt::format("the mesh shows nothing of the material '{}'{}", source.materials[material],
                    known ? fmt::format(" of volume {}", volume_text(source.volumes[material])) : ""));
  note_several(notes, {"material", "materials"}, console);
}

/// Those that are lost or torn, the greatest first.
std::vector<BodyFigures> wrong_bodies(const ResampleFigures& m) {
  std::vector<BodyFigures> wrong;
  std::ranges::copy_if(m.bodies, std::back_inserter(wrong),
                       [](const BodyFigures& body) { return body.lost || body.changed; });
  std::ranges::stable_sort(wrong, std::greater{},
                           [](const BodyFigures& body) { return body.volume_input.value_or(body.volume); });
  return wrong;
}

void note_contacts(const ResampleFigures& m, const ResamplingSource& source, Console& console) {
  std::vector<std::string> notes;
  for (const auto& [a, b] : m.contacts)
    notes.push_back(fmt::format("bodies of '{}' and '{}' touch in the mesh and not in the input",
                                source.materials[m.bodies[a.value].material],
                                source.materials[m.bodies[b.value].material]));
  note_several(notes, {"pair", "pairs"}, console);
}

/// Notes the materials and bodies of the input that the mesh shows changed or not at all.
void note_bodies(const ResampleFigures& m, const ResamplingSource& source, Console& console) {
  note_lost_materials(m, source, console);
  std::vector<std::string> notes;
  for (const BodyFigures& body : wrong_bodies(m)) {
    const std::string volume =
        body.volume_input ? fmt::format(" of volume {}", volume_text(*body.volume_input)) : "";
    const std::string what = fmt::format("a body of '{}'{} at {}", source.materials[body.material], volume,
                                         place_text(body.place));
    if (body.lost) {
      notes.push_back("the mesh shows nothing of " + what);
    } else {
      notes.push_back(fmt::format(
          "the mesh shows {} in {} piece{}, and its boundary has the Euler characteristic {} instead of {}",
          what, body.topology_mesh.pieces, body.topology_mesh.pieces == 1 ? "" : "s",
          body.topology_mesh.euler, body.topology_input.euler));
    }
  }
  note_several(notes, {"body that is lost or torn", "bodies that are lost or torn"}, console);
  note_contacts(m, source, console);
}

void print_mesh(const ResampleFigures& m, const Resampler& resampler, Console& console) {
  const double target = resampler.options().interface_error;
  std::vector<std::vector<std::string>> rows{{"tetrahedra", std::to_string(m.tetrahedra)},
                                             {"vertices", std::to_string(m.vertices)},
                                             {"interface tetrahedra", std::to_string(m.interface_tetrahedra)},
                                             {"interface error wanted", fmt::format("{:.4g}", target)}};
  const auto& certificate = resampler.certificate();
  const auto add_distance = [&](const std::string& name, const InterfaceDistance& d) {
    rows.push_back({name + " certified", shown_length(d.upper)});
    rows.push_back({name + " found", shown_length(d.lower)});
  };
  if (certificate) {
    add_distance("interface error", certificate->networks);
    // With two materials the boundary of each consists of all interfaces.
    if (resampler.source().materials.size() > 2)
      add_distance("interface error per material", certificate->materials);
    if (certificate->junctions) add_distance("junction error", *certificate->junctions);
  }
  if (const auto& wanted = resampler.options().volume_error)
    rows.push_back({"volume error of bodies wanted", fmt::format("{:.4g}%", 100 * *wanted)});
  if (const auto worst = worst_volume(m))
    rows.push_back({"greatest volume error of a body",
                    fmt::format("{:.4g}%", 100 * m.bodies[worst->value].volume_error())});
  rows.push_back({"lost interfaces", std::to_string(m.lost_interfaces)});
  const auto count = [&](bool BodyFigures::*what) {
    return std::to_string(
        std::count_if(m.bodies.begin(), m.bodies.end(), [what](const auto& b) { return b.*what; }));
  };
  rows.push_back({"bodies, lost, torn", std::to_string(m.bodies.size()) + ", " + count(&BodyFigures::lost) +
                                            ", " + count(&BodyFigures::changed)});
  rows.push_back({"contacts the input has not", std::to_string(m.contacts.size())});
  if (m.flagged_vertices > 0)
    rows.push_back({"vertices of doubtful material", std::to_string(m.flagged_vertices)});
  console.table(rows);
}

/// Prints over how many elements of each kind the errors are taken; once where that is the same for all
/// fields.
void print_elements(const ResampleFigures& m, const FieldSource& source, Console& console) {
  std::vector<std::string> texts;
  for (const FieldFigures& field : m.fields) {
    const FieldError& e = field.all;
    texts.push_back(fmt::format("{} pure, {} mixed, {} minority; {} of them displaced; {} without a value",
                                e.counts[0], e.counts[1], e.counts[2], e.displaced, e.without_value));
  }
  if (std::all_of(texts.begin(), texts.end(), [&](const std::string& text) { return text == texts[0]; })) {
    console.print("  elements: {}\n", texts[0]);
    return;
  }
  for (std::size_t f = 0; f < texts.size(); ++f)
    console.print("  elements of {}: {}\n", source.fields()[f].name, texts[f]);
}

void print_fields(const ResampleFigures& m, const Resampler& resampler, Console& console) {
  if (m.fields.empty()) return;
  const auto text = [](const FieldError& e, double value) {
    return e.count() > 0 ? fmt::format("{:.4g}", value) : std::string("-");
  };
  std::vector<std::vector<std::string>> rows{
      {"field error", "wanted", "greatest", "mean", "at interfaces", "mean there"}};
  for (std::size_t f = 0; f < m.fields.size(); ++f) {
    const FieldInfo& info = resampler.source().fields->fields()[f];
    const auto& target = resampler.options().field_errors[f];
    const auto& [all, near] = m.fields[f];
    rows.push_back({info.unit.empty() ? info.name : info.name + " [" + info.unit + "]",
                    target ? fmt::format("{:.4g}", *target) : "-", text(all, all.max), text(all, all.mean()),
                    text(near, near.max), text(near, near.mean())});
  }
  console.print("\n");
  console.table(rows);
  print_elements(m, *resampler.source().fields, console);
}

void note_field_shortfalls(const ResampleFigures& m, const Resampler& resampler, Console& console) {
  std::vector<std::pair<double, std::string>> missed;
  for (std::size_t f = 0; f < m.fields.size(); ++f) {
    const FieldError& all = m.fields[f].all;
    const auto shortfall = field_shortfall(resampler, f, all);
    if (!shortfall) continue;
    const double wanted = *resampler.options().field_errors[f];
    missed.emplace_back(
        all.max / wanted,
        fmt::format("the error wanted of the field '{}' was not reached: {:.4g} instead of {:.4g}, at {}: {}",
                    resampler.source().fields->fields()[f].name, all.max, wanted,
                    place_text(shortfall->place), shortfall->reason));
  }
  note_several(worst_first(std::move(missed)), {"field", "fields"}, console);
}

/// Notes the bodies whose volumes are not as wanted, and why.
void note_volume_shortfalls(const ResampleFigures& m, const Resampler& resampler, Console& console) {
  std::vector<std::pair<double, std::string>> missed;
  for (BodyId b(0); b.value < m.bodies.size(); ++b.value) {
    const auto shortfall = volume_shortfall(resampler, m, b);
    if (!shortfall) continue;
    const BodyFigures& body = m.bodies[b.value];
    missed.emplace_back(body.volume_error(),
                        fmt::format("the volume error wanted was not reached: a body of '{}' at {} has {} "
                                    "instead of {} ({:.4g}%): {}",
                                    resampler.source().materials[body.material], place_text(shortfall->place),
                                    volume_text(body.volume), volume_text(*body.volume_input),
                                    100 * body.volume_error(), shortfall->reason));
  }
  note_several(worst_first(std::move(missed)), {"body", "bodies"}, console);
}

/// Notes where volumes are not conserved, though the options ask for it.
void note_conservation(const ResampleFigures& m, const Resampler& resampler, Console& console) {
  if (!resampler.options().conserve) return;
  const BodyFigures* worst = nullptr;
  for (const BodyFigures& body : m.bodies) {
    if (body.volume_input && (worst == nullptr || body.missing() > worst->missing())) worst = &body;
  }
  const double whole = resampler.source().box.volume();
  if (worst == nullptr || worst->missing() <= kConserved * whole) return;
  console.note(
      "volumes were not conserved: a body of '{}' at {} has {} instead of {}; interfaces may "
      "not move by more than the interface error",
      resampler.source().materials[worst->material], place_text(worst->place), volume_text(worst->volume),
      volume_text(*worst->volume_input));
}

void print_materials(const ResampleFigures& m, const ResamplingSource& source, Console& console) {
  constexpr std::size_t kMost = 40;
  const bool stated = !source.volumes.empty();
  std::vector<std::vector<std::string>> rows{{"material", "volume", "mesh", "difference"}};
  if (!stated) rows[0] = {"material", "volume in the mesh"};
  for (MaterialId i(0); i.value < std::min(source.materials.size(), kMost); ++i.value) {
    const std::string& name = source.materials[i];
    const double found = m.volumes[i];
    if (stated) {
      rows.push_back({name, volume_text(source.volumes[i]), volume_text(found),
                      difference_text(source.volumes[i], found)});
    } else {
      rows.push_back({name, volume_text(found)});
    }
  }
  console.print("\n");
  console.table(rows);
  if (source.materials.size() > kMost) console.print("  ... and {} more\n", source.materials.size() - kMost);
}

}  // namespace

void print_resampled(const ResampleFigures& measured, const Resampler& resampler, Console& console) {
  if (const auto& findings = resampler.source().findings)
    print_findings(*findings, resampler.source().materials, resampler.source().name, console);
  print_mesh(measured, resampler, console);
  if (resampler.certificate()) note_shortfalls(*resampler.certificate(), resampler, console);
  note_bodies(measured, resampler.source(), console);
  print_fields(measured, resampler, console);
  note_field_shortfalls(measured, resampler, console);
  print_materials(measured, resampler.source(), console);
  note_volume_shortfalls(measured, resampler, console);
  note_conservation(measured, resampler, console);
}

void note_resampled(const ResampleFigures& measured, const Resampler& resampler, Console& console) {
  if (resampler.certificate()) note_shortfalls(*resampler.certificate(), resampler, console);
  note_bodies(measured, resampler.source(), console);
  note_field_shortfalls(measured, resampler, console);
  note_volume_shortfalls(measured, resampler, console);
  note_conservation(measured, resampler, console);
}

}  // namespace adamas
