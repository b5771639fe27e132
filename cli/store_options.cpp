#include "cli/store_options.h"

#include <algorithm>

#include "adamas/text.h"
#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

CommandOption add_memory_option(const Command& command, std::size_t& bytes, const std::string& description) {
  return command.add_value("--memory", "SIZE", description + ": bytes, or with K, M or G", bytes, parse_size,
                           fmt::format("{}M", bytes >> 20));
}

void add_store_input(const Command& command, StoreInput& input) {
  command.add_option("input", "FILE", "A store, from adamas store", input.path).required();
  const Command paging = command.in_group("Paging");
  add_memory_option(paging, input.open.memory, "What decoded pages may take");
  paging.add_choice<bool>("--paging",
                          "Pages are read one by one, or by a mapping of the file, which the system pages",
                          input.open.mapped, {{"read", false}, {"map", true}}, "read");
}

void add_step_option(const Command& command, StoreInput& input) {
  command.add_value("--step", "N", "Of a series: the number of a step, from 0 on (default 0)", input.step,
                    parse_count_from_0);
}

ErrorTarget parse_surface_error(const std::string& option, const std::string& text) {
  const std::optional<ErrorTarget> error = to_error_target(text, true);
  if (!error || error->value < 0)
    wrong_usage("{}: expected a number of at least 0 as 0.5, 0.7voxels or 0.1%, found '{}'", option, text);
  return *error;
}

void add_page_counts(const PageReads& reads, Figures& figures) {
  figures["pages_read"] = reads.pages;
  figures["pages_read_as_predictors"] = reads.predictors;
  figures["bytes_read"] = reads.bytes;
  figures["pages_from_copies"] = reads.copies;
  figures["damaged_pages"] = reads.damaged;
}

std::string type_text(SampleType samples, StoredType numbers) {
  const std::string name = to_string(numbers);
  return name == sample_name(samples) ? name : fmt::format("{} (shown as {})", name, sample_name(samples));
}

void print_store_bytes(std::uint64_t uncompressed, const StoredBytes& bytes, std::uint64_t all_bytes,
                       Console& console, const std::string& all) {
  const auto text = [](std::uint64_t n) { return bytes_text(static_cast<double>(n)); };
  const auto ratio = [uncompressed](std::uint64_t n) {
    return n > 0 ? fmt::format("{:.2f}", static_cast<double>(uncompressed) / static_cast<double>(n)) : "-";
  };
  const std::uint64_t parts = bytes.samples + bytes.bounds + bytes.gradients + bytes.remainders;
  const std::uint64_t others = all_bytes - std::min(parts, all_bytes);
  std::vector<std::vector<std::string>> table{{"", "bytes", "ratio"},
                                              {"uncompressed", text(uncompressed), ""},
                                              {"samples", text(bytes.samples), ratio(bytes.samples)}};
  if (bytes.remainders > 0) table.push_back({"further digits", text(bytes.remainders), ""});
  table.push_back({"errors and ranges", text(bytes.bounds), ""});
  table.push_back({"gradients", text(bytes.gradients), ""});
  table.push_back({"directory and copies", text(others), ""});
  table.push_back({all, text(all_bytes), ratio(all_bytes)});
  console.table(table);
}

}  // namespace adamas::cli
