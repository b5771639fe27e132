#include "core/io/hdf5_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "adamas/files.h"
#include "core/base/error.h"

namespace adamas::io {

namespace {

struct Current {
  std::vector<std::string> texts;
  Hdf5Layout layout;
};

Current& current() {
  static Current only;
  return only;
}

}  // namespace

Hdf5Layout parse_hdf5_layout(const std::string& option, const std::vector<std::string>& texts) {
  Hdf5Layout layout;
  std::string base;
  const std::vector<std::pair<std::string_view, std::string*>> keys{
      {"nodes", &layout.nodes}, {"x", &layout.axes[0]},   {"y", &layout.axes[1]},
      {"z", &layout.axes[2]},   {"cells", &layout.cells}, {"base", &base},
      {"boxes", &layout.boxes}, {"steps", &layout.steps}, {"times", &layout.times}};
  for (const std::string& text : texts) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string key = text.substr(0, equals);
    const auto found = std::ranges::find_if(keys, [&key](const auto& one) { return one.first == key; });
    if (found == keys.end() || equals + 1 >= text.size())
      fail_as(
          ErrorKind::kUsage,
          "{}: expected KEY=DATASET with the key nodes, x, y, z, cells, base, boxes, steps or times, found "
          "'{}'",
          option, text);
    if (!found->second->empty())
      fail_as(ErrorKind::kUsage, "{}: expected each key once, found '{}' twice", option, key);
    *found->second = text.substr(equals + 1);
    // Names begin at the root in any case.
    found->second->erase(0, std::min(found->second->find_first_not_of('/'), found->second->size() - 1));
  }
  if (!base.empty() && base != "0" && base != "1")
    fail_as(ErrorKind::kUsage, "{}: expected base=0 or base=1, found 'base={}'", option, base);
  layout.base = base == "1" ? 1 : 0;
  return layout;
}

const Hdf5Layout& hdf5_layout() { return current().layout; }
const std::vector<std::string>& hdf5_layout_texts() { return current().texts; }

}  // namespace adamas::io

void adamas::set_hdf5_layout(const std::vector<std::string>& layout) {
  io::current() = {layout, io::parse_hdf5_layout("--hdf5", layout)};
}
