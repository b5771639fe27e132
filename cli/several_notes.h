#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/console.h"

namespace adamas::cli {

/// What one thing and several things are called that notes are about.
struct Noun {
  const char* one;
  const char* several;
};

/// Lines for several things of one kind, the worst of them first: all with `verbose`, otherwise the first and
/// how many more there are: "...; and 4 more bodies (--verbose names all)".
std::vector<std::string> several_lines(const std::vector<std::string>& notes, const Noun& kind, bool verbose);

/// Notes these lines.
void note_several(const std::vector<std::string>& notes, const Noun& kind, Console& console);

/// The notes, those with the greatest numbers first.
std::vector<std::string> worst_first(std::vector<std::pair<double, std::string>> notes);

}  // namespace adamas::cli
