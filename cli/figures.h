#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "adamas/geometry.h"
#include "adamas/report_text.h"
#include "adamas/text.h"
#include "cli/command.h"

namespace adamas::cli {

/// The figures of a run that `--json` writes; keys keep the order in which they were added.
using Figures = nlohmann::ordered_json;

/// Writes indented JSON; numbers that are not finite become null.
void write_figures(const std::filesystem::path& path, const Figures& figures);
/// Writes the figures to the file of `--json`, where it is given.
void write_figures(const Figures& figures, Session& session);

/// The value; null where there is none.
template <class Value>
Figures figure(const std::optional<Value>& value) {
  return value ? Figures(*value) : Figures(nullptr);
}
/// [x, y, z].
Figures place_figures(const Vec3& place);
/// [x0, x1, y0, y1, z0, z1].
Figures box_figures(const Box3& box);

/// Adds what the run has taken so far: `seconds` of the clock, `processor_seconds` of all threads and of
/// programs that were started, and `peak_memory_bytes`.
void add_costs(Figures& figures, const Console& console);
/// Prints the same as the last line of a command; `before` is put before it, such as "3 steps".
void print_costs(Console& console, const std::string& before = {});

}  // namespace adamas::cli
