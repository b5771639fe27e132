
#include "adamas/steps.h"
#include "adamas/volume_store.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/store_options.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

void run(const StoreInput& options, Session& session) {
  session.outputs.protect(options.path);
  VolumeStore store = VolumeStore::open(options.path, options.open);
  const VerifiedStore found = store.verify(session.console);
  session.console.clear();
  const bool is_series = store.steps() > 1;
  for (const PageProblem& each : found.problems)
    session.console.print("{}{}\n", each.what, is_series ? " at " + steps_text(each.steps) : "");
  if (found.further_problems > 0) session.console.print("and {} more\n", found.further_problems);
  Figures figures{{"pages", found.pages},
                  {"bad_pages", found.bad_pages},
                  {"bad_copies", found.bad_copies},
                  {"damaged_steps", found.bad_steps}};
  add_costs(figures, session.console);
  write_figures(figures, session);
  session.commit();
  if (found.bad_pages + found.bad_copies > 0)
    fail(
        "{}: expected {} without damage, found {} that cannot be had{} and {} of which one of two copies is "
        "damaged",
        options.path, counted(found.pages, "page"), found.bad_pages,
        is_series && !found.bad_steps.empty() ? ", of " + steps_text(found.bad_steps) + "," : "",
        found.bad_copies);
  session.console.print("{}\n",
                        found.pages == 1 ? "1 page, sound" : fmt::format("{} pages, all sound", found.pages));
}

}  // namespace

void add_verify(const Command& app, Session& session) {
  const auto [command, options] = add_command(
      app, session, "verify", "Checks every byte of a store, and its laws", "adamas verify head.adm", run);
  add_store_input(command, options);
}

}  // namespace adamas::cli
