#include "cli/figures.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/io/output_stream.h"

namespace adamas::cli {

using namespace io;

void write_figures(const std::filesystem::path& path, const Figures& figures) {
  OutputStream stream(path);
  stream.write(figures.dump(2, ' ', false, Figures::error_handler_t::replace) + "\n");
  stream.finish();
}

Figures box_figures(const Box3& box) {
  return Figures{box.min.x, box.max.x, box.min.y, box.max.y, box.min.z, box.max.z};
}

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

std::string volume_text(double volume) { return fmt::format("{:.6g}", volume); }

std::string length_text(double length) {
  return std::isinf(length) ? "none shown" : fmt::format("{:.4g}", length);
}

std::string difference_text(double before, double after) {
  return before > 0 ? fmt::format("{:+.3f}%", 100 * (after - before) / before) : "-";
}

std::string bytes_text(double bytes) {
  constexpr const char* kUnits[] = {"B", "KiB", "MiB", "GiB", "TiB"};
  std::size_t unit = 0;
  while (bytes >= 1024 && unit + 1 < std::size(kUnits)) {
    bytes /= 1024;
    ++unit;
  }
  return fmt::format("{:.{}f} {}", bytes, unit == 0 ? 0 : 1, kUnits[unit]);
}

std::string counted(std::size_t count, const std::string& thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

}  // namespace adamas::cli
