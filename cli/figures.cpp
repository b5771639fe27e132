#include "cli/figures.h"

#include <sys/resource.h>

#include "adamas/files.h"

namespace adamas::cli {

void write_figures(const std::filesystem::path& path, const Figures& figures) {
  write_text(path, figures.dump(2, ' ', false, Figures::error_handler_t::replace) + "\n");
}

void write_figures(const Figures& figures, Session& session) {
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
}

Figures place_figures(const Vec3& place) { return {place.x, place.y, place.z}; }

Figures box_figures(const Box3& box) {
  return Figures{box.min.x, box.max.x, box.min.y, box.max.y, box.min.z, box.max.z};
}

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace adamas::cli
