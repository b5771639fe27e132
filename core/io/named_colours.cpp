#include "core/io/named_colours.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/array_file.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/labelled_network.h"
#include "core/io/text_array.h"
#include "core/io/vtk_xml_array.h"

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

constexpr const char* kColours = "material_colors";

/// Returns the tags of a file; none where these cannot be read here, as where they are too many: then it is
/// no file with colours, and another reader takes the rest.
std::vector<XmlTag> tags_of(const std::filesystem::path& file) {
  try {
    return read_xml_tags(supply_file(FileHandle::open(file), 0), file.string());
  } catch (const Error&) {
    return {};
  }
}

/// The arrays of a file that name materials and have their colours.
struct ColourArrays {
  std::optional<VolumeSource> names, colours;
};

ColourArrays find_arrays(const std::filesystem::path& file) {
  ColourArrays found;
  VtkXmlArrays arrays(file.string(), file);
  bool of_mesh = false;
  for (const XmlTag& tag : tags_of(file)) {
    if (tag.name == "FieldData") of_mesh = !tag.closing;
    if (tag.closing) continue;
    if (tag.name == "VTKFile") arrays.read_file_tag(tag);
    const std::string_view name = tag.value("Name");
    if (of_mesh && name == kColours) found.colours = arrays.array_of(tag).source;
    if (of_mesh && (name == "material_names" || name == "adamas materials"))
      found.names = arrays.array_of(tag).source;
    if (tag.name != "AppendedData") continue;
    for (auto* source : {&found.names, &found.colours})
      if (*source) arrays.find_appended(tag, **source);
  }
  return found;
}

/// Returns the colours of materials with these names: three numbers for each.
NamedColours colours_of_rows(const std::vector<std::string>& names, const std::vector<double>& values) {
  NamedColours result;
  for (std::size_t m = 0; m < names.size(); ++m) {
    const std::array<double, 3> colour{values[3 * m], values[3 * m + 1], values[3 * m + 2]};
    const auto good = [](double part) { return part >= 0 && part <= 1; };
    if (std::ranges::all_of(colour, good)) result.emplace(visible_text(names[m]), colour);
  }
  return result;
}

/// Reads the colours that add_colours() has written.
NamedColours read_colours(const std::filesystem::path& file) {
  ColourArrays found = find_arrays(file);
  if (!found.names || !found.colours) return {};
  const std::vector<std::string> names = read_texts(*found.names);
  if (found.colours->components != 3 || names.empty())
    fail("{}: array '{}': expected three numbers for each material, found {}", file.string(), kColours,
         found.colours->components);
  found.colours->grid.dimensions = {names.size(), 1, 1};
  return colours_of_rows(names, read_doubles(*found.colours));
}

/// The format of saved hierarchies (interfaces/selection/saved_hierarchy_file.h), and the names of their
/// materials.
constexpr const char* kHierarchy = "hierarchy";
constexpr const char* kMaterials = "known/materials";
constexpr int kAnyVersion = 1000000;

/// Reads the colours that add_colours() has added to the arrays of a saved hierarchy.
NamedColours read_saved_colours(const std::filesystem::path& file) {
  const ArrayFile found = read_array_file(file, kHierarchy, {kMaterials, kColours}, 1, kAnyVersion);
  const std::vector<std::string>* names = nullptr;
  const std::vector<double>* rows = nullptr;
  for (const NamedArray& array : found.arrays) {
    if (array.name == kMaterials) names = std::get_if<std::vector<std::string>>(&array.values);
    if (array.name == kColours) rows = std::get_if<std::vector<double>>(&array.values);
  }
  if (names == nullptr || rows == nullptr) return {};
  if (rows->size() != 3 * names->size())
    fail("{}: array '{}': expected three numbers for each of {} materials, found {}", file.string(), kColours,
         names->size(), rows->size());
  return colours_of_rows(*names, *rows);
}

}  // namespace

void add_colours(const IdVector<MaterialId, std::string>& materials, const NamedColours& colours,
                 std::vector<NamedArray>& arrays) {
  std::vector<double> rows;
  bool any = false;
  for (const std::string& material : materials) {
    const auto found = colours.find(material);
    any = any || found != colours.end();
    const std::array<double, 3> row = found == colours.end() ? std::array{-1.0, -1.0, -1.0} : found->second;
    rows.insert(rows.end(), row.begin(), row.end());
  }
  if (any) arrays.push_back({kColours, 3, std::move(rows)});
}

NamedColours find_named_colours(const std::filesystem::path& file,
                                const std::filesystem::path& region_names) {
  NamedColours result;
  LabelNames names;
  if (!region_names.empty()) {
    const RegionTable table = parse_region_table(read_file(region_names), region_names.string());
    names = table.names;
    add_colours(table.colours, names, {}, result);
  }
  if (file.empty() || is_file_pattern(file) || std::filesystem::is_directory(file)) return result;
  const std::string extension = file_extension(file);
  if (extension == ".vtu" || extension == ".vtp") {
    result.merge(read_colours(file));
    return result;
  }
  if (extension == ".h5" && is_array_file(file, kHierarchy)) {
    result.merge(read_saved_colours(file));
    return result;
  }
  const InputFormat* format = find_format_by_name(file);
  if (format == nullptr || format->read_header == nullptr) return result;
  const ImageHeader header = format->read_header(file);
  add_colours(header.label_colours, names, header.label_names, result);
  return result;
}

}  // namespace adamas::io
