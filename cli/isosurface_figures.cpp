#include "cli/isosurface_figures.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/store_input.h"
#include "core/base/error.h"

namespace adamas {

namespace {

/// Why there is no triangle. `range`: least and greatest sample; none are known where the first is greater.
std::string reason_for_none(const SurfaceRequest& request, const std::array<double, 2>& range) {
  if (range[0] > range[1]) return "no sample is a finite number";
  if (request.isovalue <= range[0] || request.isovalue > range[1])
    return fmt::format("samples are from {:.6g} to {:.6g}", range[0], range[1]);
  if (request.max_triangles) return "so few triangles do not show it";
  const std::string where = request.region ? "nothing of it is in the region" : "";
  if (request.error == 0) return where;
  return (where.empty() ? "" : where + ", or ") + "it is smaller than the error";
}

std::string damaged_pages(std::size_t count) {
  return fmt::format("{} damaged page{}", count, count == 1 ? "" : "s");
}

}  // namespace

void IsosurfaceFigures::add(const SurfaceRequest& request, const ExtractedSurface& surface,
                            const std::array<double, 2>& range) {
  Console& console = session_.console;
  tetrahedra_ += surface.tetrahedra;
  diamonds_ += surface.diamonds;
  max_error_ = std::max(max_error_, stretch_ * surface.max_error);
  if (surface.contour.triangles.empty()) {
    const std::string reason = reason_for_none(request, range);
    console.note("no surface at isovalue {:.6g}{}{}", request.isovalue, reason.empty() ? "" : ": ", reason);
  } else if (surface.max_error > request.error && surface.lost.empty() &&
             (!request.max_triangles || request.error > 0)) {
    console.note("the error wanted was not reached{}: {:.4g} instead of {:.4g}",
                 request.max_triangles ? " with so few triangles" : "", stretch_ * surface.max_error,
                 stretch_ * request.error);
  }
  if (!surface.lost.empty()) {
    console.note_damage("{}: the surface at isovalue {:.6g} is coarser there",
                        damaged_pages(surface.lost.size()), request.isovalue);
  }
}

void IsosurfaceFigures::add_normals(const SurfaceRequest& request, const ExtractedSurface& surface,
                                    const std::vector<PageId>& lost) {
  std::size_t count = 0;
  for (const PageId& page : lost) {
    if (request.strict) fail("{} is damaged, on which normals depend", page_name(page));
    // Where the surface is coarser, so are its normals.
    if (std::find(surface.lost.begin(), surface.lost.end(), page) == surface.lost.end()) ++count;
  }
  if (count == 0) return;
  session_.console.note_damage("{}: normals of the surface at isovalue {:.6g} are less exact there",
                               damaged_pages(count), request.isovalue);
}

void IsosurfaceFigures::report(const TriangleSurface& surface, const PageCounts& counts) {
  Console& console = session_.console;
  const double seconds = console.seconds();
  std::vector<std::vector<std::string>> rows{
      {"triangles", std::to_string(surface.triangles.size())},
      {"vertices", std::to_string(surface.points.size())},
      {"tetrahedra", std::to_string(tetrahedra_)},
      {"isosurface error", fmt::format("{:.4g}", max_error_)},
      {"pages read", fmt::format("{}, and {} to predict them", counts.pages, counts.predictors)},
      {"bytes read", bytes_text(static_cast<double>(counts.bytes))},
      {"seconds", fmt::format("{:.2f}", seconds)}};
  if (!space_.empty()) rows.push_back({"coordinates", space_});
  console.table(rows);
  Figures figures{{"triangles", surface.triangles.size()},
                  {"vertices", surface.points.size()},
                  {"tetrahedra", tetrahedra_},
                  {"diamonds", diamonds_},
                  {"max_isosurface_error", max_error_}};
  if (!space_.empty()) figures["space"] = space_;
  add_page_counts(counts, figures);
  figures["seconds"] = seconds;
  figures["peak_memory_bytes"] = peak_memory_bytes();
  session_.outputs.write(session_.json, [&figures](const auto& path) { write_figures(path, figures); });
}

}  // namespace adamas
