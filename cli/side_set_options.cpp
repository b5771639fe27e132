#include "cli/side_set_options.h"

#include "adamas/read_input.h"

namespace adamas::cli {

void add_side_sets_option(const Command& command, std::string& file) {
  command.add_option("--side-sets", "FILE",
                     "Of an ExodusII file: the surfaces of its side sets and node sets, as polygons (.vtp)",
                     file);
}

void declare_side_sets(const std::string& file, Session& session) {
  session.outputs.declare("--side-sets", file, {".vtp"});
}

void write_side_sets(const std::string& file, const Input& input, Session& session) {
  session.outputs.write(file, [&](const auto& path) { write_set_surfaces(path, input, session.console); });
}

}  // namespace adamas::cli
