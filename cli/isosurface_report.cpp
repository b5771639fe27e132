#include "cli/isosurface_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/figures.h"
#include "cli/store_options.h"
#include "cli/usage.h"

namespace adamas::cli {

using namespace isosurface;

namespace {

/// Says why there is no triangle. `range`: least and greatest sample; none are known where the first is
/// greater.
std::string reason_for_none(const SurfaceRequest& request, const VolumeGrid& grid,
                            const std::array<double, 2>& range) {
  if (range[0] > range[1]) return "no sample is a finite number";
  if (request.isovalue <= range[0] || request.isovalue > range[1])
    return fmt::format("samples are from {:.6g} to {:.6g}", grid.value(range[0]), grid.value(range[1]));
  if (request.max_triangles) return "so few triangles do not show it";
  const std::string where = request.region ? "nothing of it is in the region" : "";
  if (request.error == 0) return where;
  return (where.empty() ? "" : where + ", or ") + "it is smaller than the error";
}

}  // namespace

void IsosurfaceFigures::add(const SurfaceRequest& request, const CompleteSurface& complete,
                            const std::array<double, 2>& range) {
  const ExtractedSurface& surface = complete.surface;
  if (complete.distance) add_distance(request, *complete.distance);
  Console& console = session_.console;
  tetrahedra_ += surface.tetrahedra;
  diamonds_ += surface.diamonds;
  max_error_ = std::max(max_error_, grid_.greatest_stretch() * surface.max_error);
  if (surface.contour.triangles.empty()) {
    const std::string reason = reason_for_none(request, grid_, range);
    console.note("no surface at isovalue {:.6g}{}{}", grid_.value(request.isovalue),
                 reason.empty() ? "" : ": ", reason);
  } else if (surface.max_error > request.error && surface.lost.empty() &&
             (!request.max_triangles || request.error > 0)) {
    console.note("the error wanted was not reached{}: {:.4g} instead of {:.4g}",
                 request.max_triangles ? " with so few triangles" : "",
                 grid_.greatest_stretch() * surface.max_error, grid_.greatest_stretch() * request.error);
  }
  bodies_left_out_ += surface.bodies_left_out;
  if (surface.bodies_left_out > 0) {
    console.note("with so few triangles {} small bod{} of the surface at isovalue {:.6g} {} left out",
                 surface.bodies_left_out, surface.bodies_left_out == 1 ? "y" : "ies",
                 grid_.value(request.isovalue), surface.bodies_left_out == 1 ? "is" : "are");
  }
  if (!surface.lost.empty()) {
    console.note_incomplete("{}: the surface at isovalue {:.6g} is coarser there",
                            counted(surface.lost.size(), "damaged page"), grid_.value(request.isovalue));
  }
  add_normals(request, surface, complete.normals.lost);
}

void IsosurfaceFigures::add_normals(const SurfaceRequest& request, const ExtractedSurface& surface,
                                    const std::vector<PageId>& lost) {
  std::size_t count = 0;
  for (const PageId& page : lost) {
    // Pages without which the surface itself is coarser were told of before.
    if (std::find(surface.lost.begin(), surface.lost.end(), page) == surface.lost.end()) ++count;
  }
  if (count == 0) return;
  session_.console.note_incomplete("{}: normals of the surface at isovalue {:.6g} are less exact there",
                                   counted(count, "damaged page"), grid_.value(request.isovalue));
}

void IsosurfaceFigures::add_distance(const SurfaceRequest& request, const SurfaceCertificate& distance) {
  if (!distance_) distance_.emplace();
  distance_->certified = std::max(distance_->certified, distance.certified);
  distance_->found = std::max(distance_->found, distance.found);
  const double wanted = grid_.greatest_stretch() * request.error;
  if (wanted > 0 && distance.certified > wanted) {
    session_.console.note(
        "the surface at isovalue {:.6g} is certified to be within {:.4g} of that of all samples, not {:.4g}",
        grid_.value(request.isovalue), distance.certified, wanted);
  }
}

void IsosurfaceFigures::report(const TriangleSurface& surface, const PageCounts& counts) {
  Console& console = session_.console;
  const double seconds = console.seconds();
  std::vector<std::vector<std::string>> rows{
      {"triangles", std::to_string(surface.triangles.size())},
      {"vertices", std::to_string(surface.points.size())},
      {"tetrahedra", std::to_string(tetrahedra_)},
      {"isosurface error", fmt::format("{:.4g} (estimate)", max_error_)},
      {"distance certified", distance_ ? fmt::format("{:.4g}", distance_->certified) : ""},
      {"distance found", distance_ ? fmt::format("{:.4g}", distance_->found) : ""},
      {"pages read", fmt::format("{}, and {} to predict them", counts.pages, counts.predictors)},
      {"bytes read", bytes_text(static_cast<double>(counts.bytes))},
      {"seconds", fmt::format("{:.2f}", seconds)},
      {"coordinates", grid_.space}};
  std::erase_if(rows, [](const auto& row) { return row[1].empty(); });
  console.table(rows);
  Figures figures{{"triangles", surface.triangles.size()},
                  {"vertices", surface.points.size()},
                  {"tetrahedra", tetrahedra_},
                  {"diamonds", diamonds_},
                  {"isosurface_error_estimate", max_error_},
                  {"bodies_left_out", bodies_left_out_}};
  // What is not finite becomes null.
  if (distance_) figures["distance"] = {{"certified", distance_->certified}, {"found", distance_->found}};
  if (!grid_.space.empty()) figures["space"] = grid_.space;
  add_page_counts(counts, figures);
  figures["seconds"] = seconds;
  figures["peak_memory_bytes"] = peak_memory_bytes();
  session_.outputs.write(session_.json, [&figures](const auto& path) { write_figures(path, figures); });
}

}  // namespace adamas::cli
