#include "cli/resample_report.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "cli/figures.h"
#include "cli/fraction_report.h"
#include "cli/network_figures.h"
#include "cli/several_notes.h"

namespace adamas::cli {

using namespace interfaces;

namespace {

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
      notes.push_back(
          fmt::format("the mesh shows {} {}", what, topology_text(body.topology_input, body.topology_mesh)));
    }
  }
  note_several(notes, {"body that is lost or torn", "bodies that are lost or torn"}, console);
  note_contacts(m, source, console);
}

/// Names the body whose volume is farthest off: of many bodies none may be lost, and each far too small.
void print_worst_body(const ResampleFigures& m, const ResamplingSource& source, Console& console) {
  const auto worst = worst_volume(m);
  if (!worst) return;
  const BodyFigures& body = m.bodies[worst->value];
  const double whole = *body.volume_input;
  console.print("  worst body volume: {:.4g}% of {}, a body of '{}' at {}\n",
                whole > 0 ? 100 * body.volume / whole : 0.0, volume_text(whole),
                source.materials[body.material], place_text(body.place));
}

void print_mesh(const ResampleFigures& m, const Resampler& resampler, Console& console) {
  const double target = resampler.options().interface_error;
  std::vector<std::vector<std::string>> rows{{"tetrahedra", std::to_string(m.tetrahedra)},
                                             {"vertices", std::to_string(m.vertices)},
                                             {"interface tetrahedra", std::to_string(m.interface_tetrahedra)},
                                             {"interface error wanted", fmt::format("{:.4g}", target)}};
  const auto& certificate = resampler.certificate();
  const auto add_distance = [&](const std::string& name, const InterfaceDistance& d) {
    rows.push_back({name + " certified", length_text(d.upper)});
    rows.push_back({name + " found", length_text(d.lower)});
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
  print_worst_body(m, resampler.source(), console);
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

/// The bodies whose volumes are not as wanted, the worst first, and why.
std::vector<std::string> volume_lines(const ResampleFigures& m, const Resampler& resampler) {
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
  return worst_first(std::move(missed));
}

/// Where volumes are not conserved, though the options ask for it; empty where they are.
std::string conservation_line(const ResampleFigures& m, const Resampler& resampler) {
  if (!resampler.options().conserve) return {};
  const double enough = kConserved * resampler.source().box.volume();
  const BodyFigures* worst = nullptr;
  std::size_t count = 0;
  for (const BodyFigures& body : m.bodies) {
    if (!body.volume_input || body.missing() <= enough) continue;
    ++count;
    if (worst == nullptr || body.missing() > worst->missing()) worst = &body;
  }
  if (worst == nullptr) return {};
  return fmt::format(
      "volumes were not conserved: a body of '{}' at {} has {:.2g} {} than {}, the worst of {}; interfaces "
      "may "
      "not move by more than the interface error",
      resampler.source().materials[worst->material], place_text(worst->place), worst->missing(),
      worst->volume < *worst->volume_input ? "less" : "more", volume_text(*worst->volume_input), count);
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
  print_fields(measured, resampler, console);
  print_materials(measured, resampler.source(), console);
  note_resampled(measured, resampler, console);
}

std::string unreached_text(const UnreachedError& error) {
  return fmt::format("{} was not reached: {} instead of {:.4g}, at {}: {}", error.what,
                     length_text(error.found), error.wanted, place_text(error.shortfall.place),
                     error.shortfall.reason);
}

std::vector<std::string> unreached_lines(const ResampleFigures& measured, const Resampler& resampler,
                                         bool all_bodies) {
  std::vector<std::string> lines;
  for (const UnreachedError& error : unreached_errors(resampler, measured.fields))
    lines.push_back(unreached_text(error));
  for (const std::string& line :
       several_lines(volume_lines(measured, resampler), {"body", "bodies"}, all_bodies))
    lines.push_back(line);
  if (const std::string line = conservation_line(measured, resampler); !line.empty()) lines.push_back(line);
  return lines;
}

void note_resampled(const ResampleFigures& measured, const Resampler& resampler, Console& console) {
  for (const std::string& line : unreached_lines(measured, resampler, console.verbose))
    console.note_incomplete("{}", line);
  note_bodies(measured, resampler.source(), console);
}

}  // namespace adamas::cli
