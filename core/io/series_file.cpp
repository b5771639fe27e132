#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "adamas/series.h"
#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/byte_supply.h"
#include "core/io/input_file.h"
#include "core/io/output_stream.h"
#include "core/io/volume_stack.h"
#include "core/io/xml_file.h"

namespace adamas {

using namespace io;

namespace {

double time_of(const XmlTag& tag, const std::string& name) {
  const std::string_view text = tag.value("timestep");
  double time = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), time);
  if (failed != std::errc{} || end != text.data() + text.size() || !std::isfinite(time))
    fail("{}: expected a number as the timestep of a DataSet, found '{}'", name, text);
  return time;
}

/// The greatest size of a file, which is read into memory: room for some 250,000 steps.
constexpr std::size_t kMostBytes = std::size_t{1} << 24;

void check_name(const std::filesystem::path& list, const std::string& name) {
  if (!fits_xml(name))
    fail("{}: expected names of files of UTF-8 without control characters, as XML can hold, found '{}'",
         list.string(), name);
}

}  // namespace

void write_series(const std::filesystem::path& path, const std::vector<SeriesEntry>& entries) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  for (const SeriesEntry& entry : entries) {
    check_name(path, entry.file);
    text += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", entry.time,
                        xml_attribute(entry.file));
  }
  text += "  </Collection>\n</VTKFile>\n";
  if (text.size() > kMostBytes)
    fail("{}: expected a list of at most {} bytes, found {} for {} steps", path.string(), kMostBytes,
         text.size(), entries.size());
  OutputStream stream(path);
  stream.write(text);
  stream.finish();
}

std::string step_file(const std::filesystem::path& list, std::size_t step, const std::string& ending) {
  check_name(list, list.stem().string());
  return fmt::format("{}_{:04}{}", list.stem().string(), step, ending);
}

std::vector<SeriesEntry> read_series(const std::filesystem::path& path) {
  const std::string name = path.string();
  const std::vector<XmlTag> tags = read_xml_tags(supply_file(FileHandle::open(path), 0), name, kMostBytes);
  if (tags.empty() || tags[0].name != "VTKFile" || tags[0].value("type") != "Collection")
    fail("{}: expected a VTKFile of the type Collection, found other XML", name);
  std::vector<SeriesEntry> entries;
  std::string without_time;
  for (const XmlTag& tag : tags) {
    if (tag.closing || tag.name != "DataSet") continue;
    if (!tag.has("file")) fail("{}: expected the file of a DataSet, found none", name);
    // A data set without a time has to be the only step.
    const double time = tag.has("timestep") ? time_of(tag, name) : 0;
    if (!tag.has("timestep")) without_time = tag.value("file");
    entries.push_back({time, (path.parent_path() / std::string(tag.value("file"))).string()});
  }
  if (entries.empty()) fail("{}: expected a DataSet or more, found none", name);
  if (entries.size() > 1 && !without_time.empty())
    fail("{}: expected the timestep of each DataSet, found none of {}", name, without_time);
  std::stable_sort(entries.begin(), entries.end(),
                   [](const SeriesEntry& a, const SeriesEntry& b) { return a.time < b.time; });
  for (std::size_t n = 1; n < entries.size(); ++n) {
    if (entries[n].time == entries[n - 1].time)
      fail("{}: expected one file for each time, found {} and {} for {}", name, entries[n - 1].file,
           entries[n].file, entries[n].time);
  }
  return entries;
}

std::vector<SeriesEntry> find_series(const std::vector<std::string>& inputs) {
  std::vector<std::string> files = inputs;
  if (inputs.size() == 1) {
    if (file_extension(inputs[0]) == ".pvd") return read_series(inputs[0]);
    if (!is_file_pattern(inputs[0])) return {};
    files.clear();
    for (const auto& file : match_stack(inputs[0])) files.push_back(file.string());
  }
  std::vector<SeriesEntry> entries;
  for (const std::string& file : files) entries.push_back({static_cast<double>(entries.size()), file});
  return entries;
}

std::string SeriesEntry::name() const { return number ? fmt::format("{}: time {}", file, *number) : file; }

std::vector<SeriesEntry> mesh_steps(const std::filesystem::path& path) {
  std::vector<SeriesEntry> steps;
  const std::vector<double> times = mesh_times(path);
  for (std::uint64_t n = 0; times.size() > 1 && n < times.size(); ++n)
    steps.push_back({times[n], path.string(), n});
  return steps;
}

std::vector<SeriesEntry> series_steps(const std::vector<std::string>& inputs) {
  std::vector<SeriesEntry> steps = find_series(inputs);
  std::error_code unknown;
  for (const SeriesEntry& step : steps) {
    if (!std::filesystem::exists(step.file, unknown))
      fail("{}: expected the file of a step{}, found none", step.file,
           inputs.size() == 1 ? " of " + inputs[0] : "");
  }
  return steps;
}

std::optional<double> even_spacing(const std::vector<double>& times, double tolerance) {
  const double spacing = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  for (std::size_t n = 0; n < times.size(); ++n) {
    const double even = times.front() + static_cast<double>(n) * spacing;
    if (!(std::abs(times[n] - even) <= tolerance * spacing)) return {};
  }
  return spacing;
}

}  // namespace adamas
