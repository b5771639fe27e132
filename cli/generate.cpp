
#include "cli/command.h"

namespace adamas {

void add_generate(const Command& app, Session& session) {
  const Command generate =
      app.add_command_group("generate", "Make a data set with known truth",
                            "adamas generate scene voronoi10 --dimensions 32,32,32 --seed 7 -o cells.vtr");
  add_generate_scene(generate, session);
  add_generate_impact(generate, session);
  add_generate_buckyball(generate, session);
}

}  // namespace adamas
