#include "cli/isosurface_figures.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/store_input.h"

namespace adamas {

void IsosurfaceFigures::add(const SurfaceRequest& request, const ExtractedSurface& surface,
                            const std::array<double, 2>& range) {
  Console& console = session_.console;
  tetrahedra_ += surface.tetrahedra;
  diamonds_ += surface.diamonds;
  max_error_ = std::max(max_error_, surface.max_error);
  if (surface.contour.triangles.empty()) {
    console.note("no surface at isovalue {:.6g}: samples are from {:.6g} to {:.6g}", request.isovalue,
                 range[0], range[1]);
  } else if (surface.max_error > request.error && !request.max_triangles && surface.lost.empty()) {
    console.note("the error wanted was not reached: {:.4g} instead of {:.4g}", surface.max_error,
                 request.error);
  }
  if (!surface.lost.empty()) {
    console.note("{} damaged pages: the surface at isovalue {:.6g} is coarser round them",
                 surface.lost.size(), request.isovalue);
  }
}

void IsosurfaceFigures::report(const TriangleSurface& surface, const PageCounts& counts) {
  Console& console = session_.console;
  const double seconds = console.seconds();
  console.table({{"triangles", std::to_string(surface.triangles.size())},
                 {"vertices", std::to_string(surface.points.size())},
                 {"tetrahedra", std::to_string(tetrahedra_)},
                 {"isosurface error", fmt::format("{:.4g}", max_error_)},
                 {"pages read", fmt::format("{} and {} to predict them", counts.pages, counts.predictors)},
                 {"bytes read", bytes_text(static_cast<double>(counts.bytes))},
                 {"seconds", fmt::format("{:.2f}", seconds)}});
  Figures figures{{"triangles", surface.triangles.size()},
                  {"vertices", surface.points.size()},
                  {"tetrahedra", tetrahedra_},
                  {"diamonds", diamonds_},
                  {"max_isosurface_error", max_error_}};
  add_page_counts(counts, figures);
  figures["seconds"] = seconds;
  figures["peak_memory_bytes"] = peak_memory_bytes();
  session_.outputs.write(session_.json, [&figures](const auto& path) { write_figures(path, figures); });
}

}  // namespace adamas
