#include "core/io/named_colours.h"

#include <cstdint>

#include "adamas/text.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/labelled_network.h"

namespace adamas::io {

namespace {

using LabelColours = std::map<std::int64_t, std::array<double, 3>>;
using LabelNames = std::map<std::int64_t, std::string>;

/// Adds colours of labels, under the names of the first list that has one, or else the number.
void add_colours(const LabelColours& colours, const LabelNames& first, const LabelNames& second,
                 NamedColours& result) {
  for (const auto& colour : colours) {
    const std::int64_t label = colour.first;
    const auto given = first.find(label), known = second.find(label);
    const std::string name = given != first.end()    ? given->second
                             : known != second.end() ? visible_text(known->second)
                                                     : std::to_string(label);
    result.emplace(name, colour.second);
  }
}

}  // namespace

NamedColours find_named_colours(const std::filesystem::path& file,
                                const std::filesystem::path& region_names) {
  NamedColours result;
  LabelNames names;
  if (!region_names.empty()) {
    const std::string text = read_file(region_names);
    names = parse_region_names(text, region_names.string());
    add_colours(parse_region_colours(text, region_names.string()), names, {}, result);
  }
  if (file.empty() || is_file_pattern(file) || std::filesystem::is_directory(file)) return result;
  const InputFormat* format = find_format_by_name(file);
  if (format == nullptr || format->read_header == nullptr) return result;
  const ImageHeader header = format->read_header(file);
  add_colours(header.label_colours, names, header.label_names, result);
  return result;
}

}  // namespace adamas::io
