#include "cli/figures.h"

#include "adamas/files.h"
#include "adamas/resources.h"

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

void add_costs(Figures& figures, const Console& console) {
  figures["seconds"] = console.seconds();
  figures["processor_seconds"] = processor_seconds();
  figures["peak_memory_bytes"] = peak_memory_bytes();
}

void print_costs(Console& console, const std::string& before) {
  console.print("\n  {}{:.2f} s, {:.2f} s of processors, {} of memory at most\n",
                before.empty() ? "" : before + ", ", console.seconds(), processor_seconds(),
                bytes_text(static_cast<double>(peak_memory_bytes())));
}

}  // namespace adamas::cli
