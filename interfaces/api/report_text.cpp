#include "adamas/report_text.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "adamas/notes.h"
#include "adamas/text.h"
#include "core/base/notes.h"

namespace adamas {

namespace {

void note_lost_materials(const ResampleReport& report, Progress& progress) {
  std::vector<const ResampleReport::Material*> lost;
  for (const ResampleReport::Material& material : report.materials) {
    if (material.lost) lost.push_back(&material);
  }
  std::ranges::stable_sort(lost, std::greater{},
                           [](const auto* material) { return material->volume_input.value_or(0); });
  std::vector<std::string> notes;
  for (const ResampleReport::Material* material : lost)
    notes.push_back(fmt::format(
        "the mesh shows nothing of the material '{}'{}", material->name,
        material->volume_input ? fmt::format(" of volume {}", volume_text(*material->volume_input)) : ""));
  note_several(notes, {"material", "materials"}, progress);
}

/// Returns the bodies that are lost or torn, the largest first.
std::vector<ResampleReport::Body> wrong_bodies(const ResampleReport& report) {
  std::vector<ResampleReport::Body> wrong;
  std::ranges::copy_if(report.bodies, std::back_inserter(wrong),
                       [](const auto& body) { return body.lost || body.changed; });
  std::ranges::stable_sort(wrong, std::greater{},
                           [](const auto& body) { return body.volume_input.value_or(body.volume_mesh); });
  return wrong;
}

void note_contacts(const ResampleReport& report, Progress& progress) {
  std::vector<std::string> notes;
  const auto name = [&report](std::size_t body) {
    return report.materials[report.bodies[body].material].name;
  };
  for (const auto& [a, b] : report.contacts)
    notes.push_back(
        fmt::format("bodies of '{}' and '{}' touch in the mesh and not in the input", name(a), name(b)));
  note_several(notes, {"pair", "pairs"}, progress);
}

/// Notes the materials and bodies of the input that are changed or missing in the mesh.
void note_bodies(const ResampleReport& report, Progress& progress) {
  note_lost_materials(report, progress);
  std::vector<std::string> notes;
  for (const ResampleReport::Body& body : wrong_bodies(report)) {
    const std::string volume =
        body.volume_input ? fmt::format(" of volume {}", volume_text(*body.volume_input)) : "";
    const std::string what = fmt::format("a body of '{}'{} at {}", report.materials[body.material].name,
                                         volume, place_text(body.place));
    if (body.lost) {
      notes.push_back("the mesh shows nothing of " + what);
    } else {
      notes.push_back(
          fmt::format("the mesh shows {} {}", what, topology_text(body.topology_input, body.topology_mesh)));
    }
  }
  note_several(notes, {"body that is lost or torn", "bodies that are lost or torn"}, progress);
  note_contacts(report, progress);
}

/// Returns lines on the bodies whose volumes are not reached, the worst first, with the reasons.
std::vector<std::string> volume_lines(const ResampleReport& report) {
  std::vector<std::pair<double, std::string>> missed;
  for (const ResampleReport::Body& body : report.bodies) {
    if (!body.missed_volume) continue;
    missed.emplace_back(body.volume_error(),
                        fmt::format("the volume error wanted was not reached: a body of '{}' at {} has {} "
                                    "instead of {} ({:.4g}%): {}",
                                    report.materials[body.material].name, place_text(body.place),
                                    volume_text(body.volume_mesh), volume_text(*body.volume_input),
                                    100 * body.volume_error(), body.missed_volume->reason));
  }
  return worst_first(std::move(missed));
}

/// Returns a line on the body whose volume is not conserved although that was asked for; empty if there
/// is none.
std::string conservation_line(const ResampleReport& report) {
  if (!report.conservation_wanted || !report.conservation_tolerance) return {};
  const ResampleReport::Body* worst = nullptr;
  std::size_t count = 0;
  for (const ResampleReport::Body& body : report.bodies) {
    if (!body.volume_input || report.is_conserved(body)) continue;
    ++count;
    if (worst == nullptr || body.missing() > worst->missing()) worst = &body;
  }
  if (worst == nullptr) return {};
  return fmt::format(
      "volumes were not conserved: a body of '{}' at {} has {:.2g} {} than {}, the worst of {}; interfaces "
      "may not move by more than the interface error, nor tear bodies",
      report.materials[worst->material].name, place_text(worst->place), worst->missing(),
      worst->volume_mesh < *worst->volume_input ? "less" : "more", volume_text(*worst->volume_input), count);
}

}  // namespace

std::string volume_text(double volume) { return fmt::format("{:.6g}", volume); }

std::string difference_text(double before, double after) {
  return before > 0 ? fmt::format("{:+.3f}%", 100 * (after - before) / before) : "-";
}

std::string topology_text(const BodyTopology& before, const BodyTopology& after) {
  std::string text = "in " + counted(after.pieces, "piece");
  if (after.pieces != before.pieces) text += fmt::format(" instead of {}", before.pieces);
  if (after.euler == before.euler) return text;
  return fmt::format("{}, and its boundary has the Euler characteristic {} instead of {}", text, after.euler,
                     before.euler);
}

std::string unreached_text(const UnreachedError& error) {
  return fmt::format("{} was not reached: {} instead of {:.4g}, at {}: {}", error.what,
                     length_text(error.found), error.wanted, place_text(error.shortfall.place),
                     error.shortfall.reason);
}

std::vector<std::string> unreached_lines(const ResampleReport& report, bool all_bodies) {
  std::vector<std::string> lines;
  for (const UnreachedError& error : report.unreached) lines.push_back(unreached_text(error));
  for (const std::string& line : several_lines(volume_lines(report), {"body", "bodies"}, all_bodies))
    lines.push_back(line);
  if (const std::string line = conservation_line(report); !line.empty()) lines.push_back(line);
  return lines;
}

void note_resampled(const ResampleReport& report, Progress& progress) {
  for (const std::string& line : unreached_lines(report, progress.wants_all_notes()))
    progress.note(NoteKind::kIncomplete, line);
  note_bodies(report, progress);
}

}  // namespace adamas
