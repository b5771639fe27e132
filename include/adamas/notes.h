#pragma once

#include <string>
#include <utility>
#include <vector>

#include "adamas/export.h"
#include "adamas/progress.h"

namespace adamas ADAMAS_API {

/// The singular and the plural of the word for the things that notes are about.
struct Noun {
  const char* one;
  const char* several;
};

/// Returns notes about several things of one kind, the worst of them first: all notes if `all` is set, or the
/// first one and the number of the others: "...; and 4 more bodies (--verbose names all)".
std::vector<std::string> several_lines(const std::vector<std::string>& notes, const Noun& kind, bool all);

/// Passes these notes on, all of them where the progress wants that (Progress::wants_all_notes).
void note_several(const std::vector<std::string>& notes, const Noun& kind, Progress& progress,
                  NoteKind subject = NoteKind::kRemark);

/// Returns the notes, those with the greatest numbers first.
std::vector<std::string> worst_first(std::vector<std::pair<double, std::string>> notes);

}  // namespace adamas
