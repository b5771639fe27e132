#include "cli/store_summary.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/store_input.h"
#include "cli/volume_places.h"
#include "isosurface/storage/sample_range.h"
#include "isosurface/volume/samples.h"

namespace adamas {

namespace {

/// Least and greatest sample.
void print_range(StoreFile& file, Console& console, Figures& figures) {
  with_sample_type(file.header().grid.type, [&](auto sample) {
    using Sample = decltype(sample);
    StoredPages<OrderedWord<Sample>> pages(file, 0, 0);
    const auto found = sample_range<Sample>(pages);
    if (!found) return console.note_damage("{}: what tells the range of values is damaged", file.name());
    const auto [low, high] = *found;
    if (low > high) return;
    console.print("  values from {:.6g} to {:.6g}\n", low, high);
    figures["min"] = low;
    figures["max"] = high;
  });
}

}  // namespace

void print_store_bytes(std::uint64_t uncompressed, const StoreBytes& bytes, std::uint64_t file_bytes,
                       Console& console) {
  const auto text = [](std::uint64_t n) { return bytes_text(static_cast<double>(n)); };
  const auto ratio = [uncompressed](std::uint64_t n) {
    return n > 0 ? fmt::format("{:.2f}", static_cast<double>(uncompressed) / static_cast<double>(n)) : "-";
  };
  const std::uint64_t parts = bytes.samples + bytes.values + bytes.gradients;
  const std::uint64_t others = file_bytes - std::min(parts, file_bytes);
  console.table({{"", "bytes", "ratio"},
                 {"uncompressed", text(uncompressed), ""},
                 {"samples", text(bytes.samples), ratio(bytes.samples)},
                 {"errors and ranges", text(bytes.values), ""},
                 {"gradients", text(bytes.gradients), ""},
                 {"directory and copies", text(others), ""},
                 {"file", text(file_bytes), ratio(file_bytes)}});
}

Figures print_store(const std::string& path, Session& session) {
  StoreInput input;
  input.path = path;
  const std::unique_ptr<StoreFile> file = open_store(input, session);
  const StoreHeader& header = file->header();
  const VolumeGrid& grid = header.grid;
  const auto [nx, ny, nz] = grid.dimensions;
  Console& console = session.console;
  const std::uint64_t before = grid.bytes() * header.steps;
  const int levels = file->grid().top() + 1;
  const char* coding = header.coding == SampleCoding::kSplitEdge ? "split-edge"
                       : header.coding == SampleCoding::kRanks   ? "interpolation of ranks"
                                                                 : "interpolation";
  console.print("{}: stored volume\n", path);
  console.print("  {} x {} x {} samples, {}\n", nx, ny, nz, sample_name(grid.type));
  print_places(grid, console);
  Figures figures{{"file", path},
                  {"kind", "store"},
                  {"dimensions", grid.dimensions},
                  {"type", sample_name(grid.type)},
                  {"steps", header.steps},
                  {"levels", levels},
                  {"pages", file->grid().page_count()},
                  {"coding", coding},
                  {"subtree_depth", header.subtree_depth},
                  {"gradients", header.gradients},
                  {"bytes_input", before},
                  {"bytes_data", header.bytes.samples},
                  {"bytes_errors", header.bytes.values},
                  {"bytes_gradients", header.bytes.gradients},
                  {"bytes_file", file->size()}};
  add_places(grid, figures);
  print_range(*file, console, figures);
  console.print("  levels 0 to {}, {} pages, coding {}, subtrees {}, {} gradients\n\n", levels - 1,
                file->grid().page_count(), coding, header.subtree_depth,
                header.gradients ? "with" : "without");
  print_store_bytes(before, header.bytes, file->size(), console);
  return figures;
}

}  // namespace adamas
