#include "cli/several_notes.h"

#include <algorithm>
#include <functional>

namespace adamas {

void note_several(const std::vector<std::string>& notes, const NoteKind& kind, Console& console) {
  if (console.verbose || notes.size() < 2) {
    for (const std::string& note : notes) console.note("{}", note);
    return;
  }
  const std::size_t more = notes.size() - 1;
  console.note("{}; and {} more {} (--verbose names all)", notes.front(), more,
               more == 1 ? kind.one : kind.several);
}

std::vector<std::string> worst_first(std::vector<std::pair<double, std::string>> notes) {
  std::ranges::stable_sort(notes, std::greater{}, &std::pair<double, std::string>::first);
  std::vector<std::string> texts;
  for (auto& [number, text] : notes) texts.push_back(std::move(text));
  return texts;
}

}  // namespace adamas
