#include "adamas/notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace adamas {

std::vector<std::string> several_lines(const std::vector<std::string>& notes, const Noun& kind, bool all) {
  if (all || notes.size() < 2) return notes;
  const std::size_t more = notes.size() - 1;
  return {fmt::format("{}; and {} more {} (--verbose names all)", notes.front(), more,
                      more == 1 ? kind.one : kind.several)};
}

void note_several(const std::vector<std::string>& notes, const Noun& kind, Progress& progress,
                  NoteKind subject) {
  for (const std::string& line : several_lines(notes, kind, progress.wants_all_notes()))
    progress.note(subject, line);
}

std::vector<std::string> worst_first(std::vector<std::pair<double, std::string>> notes) {
  std::ranges::stable_sort(notes, std::greater{}, &std::pair<double, std::string>::first);
  std::vector<std::string> texts;
  for (auto& [number, text] : notes) texts.push_back(std::move(text));
  return texts;
}

}  // namespace adamas
