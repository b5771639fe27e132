#include "cli/store_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "adamas/text.h"
#include "cli/option_values.h"
#include "cli/usage.h"
#include "core/io/input_file.h"

namespace adamas::cli {

using namespace io;
using namespace isosurface;
using namespace timevarying;

void add_store_input(const Command& command, StoreInput& input) {
  command.add_option("input", input.path, "A store, from adamas store").required().type_name("FILE");
  command.add_option("--memory", input.memory, "What decoded pages may take: bytes, or with K, M or G")
      .type_name("SIZE")
      .show_default()
      .group("Paging");
  command
      .add_option("--paging", input.paging,
                  "Pages are read one by one, or by a mapping of the file, which the system pages")
      .one_of({"read", "map"})
      .show_default()
      .group("Paging");
}

void add_step_option(const Command& command, StoreInput& input) {
  command.add_option("--step", input.step, "Of a series: the number of a step, from 0 on (default 0)")
      .type_name("N");
}

std::uint32_t wanted_step(const StoreInput& input, const StoreFile& file, Session& session) {
  if (input.step.empty()) {
    if (file.steps() > 1)
      session.console.note("{}: the first of {} steps; --step says which", input.path, file.steps());
    return 0;
  }
  const std::size_t step = parse_count("--step", input.step, 0);
  if (step >= file.steps())
    wrong_usage("--step: expected less than {}, since {} has {}, found {}", file.steps(), input.path,
                counted(file.steps(), "step"), input.step);
  return static_cast<std::uint32_t>(step);
}

StepRange wanted_steps(const std::string& steps, const StoreInput& input, const StoreFile& file) {
  if (steps.empty()) return {0, file.steps() - 1};
  const auto [first, last] = parse_steps(steps, file.steps(), input.path);
  return {first, last};
}

std::string step_title(double time, std::size_t step) {
  return fmt::format("time {:.6g}, step {}", time, step);
}

OpenOptions open_options(const StoreInput& input) { return {store_memory(input), input.paging == "map"}; }

std::size_t store_memory(const StoreInput& input) { return parse_size("--memory", input.memory); }

std::unique_ptr<StoreFile> open_store(const StoreInput& input, Session& session) {
  session.outputs.protect(input.path);
  try {
    return std::make_unique<StoreFile>(input.path, input.paging == "map" ? Paging::kMap : Paging::kRead);
  } catch (const Error& e) {
    std::error_code code;
    if (is_store(input.path) || !std::filesystem::is_regular_file(input.path, code)) throw;
    fail("{}: adamas store makes one of a volume", e.what());
  }
}

bool is_store(const std::string& path) { return file_extension(path) == ".adm"; }

ErrorTarget parse_surface_error(const std::string& option, const std::string& text) {
  const auto in_voxels = before_voxels(text);
  std::string_view number = in_voxels ? *in_voxels : text;
  const bool is_part = !in_voxels && number.ends_with('%');
  if (is_part) number.remove_suffix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (code != std::errc() || end != number.data() + number.size() || !std::isfinite(value) || value < 0)
    wrong_usage("{}: expected a number of at least 0 as 0.5, 0.7voxels or 0.1%, found '{}'", option, text);
  if (in_voxels) return {value, ErrorTarget::Unit::kVoxels};
  return is_part ? ErrorTarget{value / 100, ErrorTarget::Unit::kPart} : ErrorTarget{value};
}

double parse_surface_error(const std::string& text, const VolumeGrid& grid) {
  return parse_surface_error("--error", text)
      .of(grid.frame_box().diagonal(), std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z}));
}

void add_page_counts(const PageCounts& counts, Figures& figures) {
  figures["pages_read"] = counts.pages;
  figures["pages_read_as_predictors"] = counts.predictors;
  figures["bytes_read"] = counts.bytes;
  figures["pages_from_copies"] = counts.copies;
  figures["damaged_pages"] = counts.damaged;
}

}  // namespace adamas::cli
