#include "cli/opened_store.h"

#include <nlohmann/json.hpp>

#include "timevarying/library/open_store.h"

namespace adamas::cli {

using namespace isosurface;

std::unique_ptr<StoreFile> open_store(const StoreInput& input, Session& session) {
  session.outputs.protect(input.path);
  return timevarying::open_store_file(input.path, input.open);
}

std::uint32_t wanted_step(const StoreInput& input, const StoreFile& file, Session& session) {
  return timevarying::wanted_step(input.step, file, session.console);
}

void add_page_counts(const PageCounts& counts, Figures& figures) {
  add_page_counts(PageReads{counts.pages, counts.predictors, counts.bytes, counts.copies, counts.damaged},
                  figures);
}

}  // namespace adamas::cli
