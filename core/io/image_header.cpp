#include "core/io/image_header.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/array_names.h"
#include "core/io/grid_axes.h"
#include "core/io/grid_numbers.h"
#include "core/io/header_text.h"
#include "core/io/input_file.h"
#include "core/io/material_arrays.h"
#include "core/io/text_array.h"
#include "core/io/volume_reader.h"
#include "core/io/volume_unpacking.h"
#include "core/io/whole_pieces.h"
#include "core/io/whole_runs.h"

namespace adamas::io {

namespace {

constexpr std::size_t kShown = 40;
/// The number of numbers that are read and converted together.
constexpr std::uint64_t kPiece = std::uint64_t{1} << 16;

const ImageArray& chosen_array(const ImageHeader& header, const std::string& wanted) {
  if (header.arrays.size() == 1 && header.arrays.front().name.empty()) return header.arrays.front();
  const std::string& name = wanted.empty() ? header.active : wanted;
  std::string names;
  std::vector<std::string> on_cells;
  const ImageArray* only = nullptr;
  std::size_t count = 0, of_one_value = 0;
  for (const ImageArray& array : header.arrays) {
    if (array.centering != Centering::kPoints) {
      on_cells.push_back(array.name);
      continue;
    }
    if (!name.empty() && array.name == name) return array;
    names += (names.empty() ? "'" : ", '") + printable(array.name, kShown) + "'";
    const bool is_first = array.source.components == 1 && of_one_value++ == 0;
    if (is_first || only == nullptr) only = &array;
    ++count;
  }
  if (wanted.empty() && (count == 1 || of_one_value == 1)) return *only;
  if (count == 0) fail("{}: expected an array on points, found {}", header.name, no_points_text(on_cells));
  if (wanted.empty())
    fail("{}: expected one array on points or the name of one, found {}", header.name, names);
  fail("{}: expected an array '{}' on points, found {}", header.name, wanted, names);
}

/// Names of the arrays on points with one value each, without `chosen`.
std::vector<std::string> others(const ImageHeader& header, const ImageArray& chosen) {
  std::vector<std::string> names;
  for (const ImageArray& array : header.arrays) {
    if (&array != &chosen && array.centering == Centering::kPoints && array.source.components == 1)
      names.push_back(array.name);
  }
  return names;
}

void require_found(const ImageHeader& header, const ImageArray& array) {
  if (!array.missing.empty()) fail("{}: {}", header.name, array.missing);
}

void set_time(const ImageHeader& header, std::optional<std::uint64_t> time, VolumeSource& source) {
  if (header.times > 1 && !time)
    fail("{}: expected one time, or which of them by --time (0 to {}), found {} times", header.name,
         header.times - 1, header.times);
  const std::uint64_t before = time.value_or(0);
  if (before >= header.times)
    fail("{}: expected a time from 0 to {}, found {}", header.name, header.times - 1, before);
  if (before > 0 && header.time_step > (std::uint64_t{1} << 62) / before)
    fail("{}: expected times that a file can hold, found {}", header.name, header.times);
  (source.packed() ? source.skip_bytes : source.header_bytes) += before * header.time_step;
  if (before + 1 < header.times) source.trailing = TrailingBytes::kOtherData;
}

/// Calls `take` with each number of an array, converted to Stored, until it returns false.
template <class Stored, class Take>
void for_each_number(VolumeReader& reader, const Take& take) {
  const std::uint64_t count = reader.source().values();
  std::vector<Stored> piece;
  for (std::uint64_t first = 0; first < count; first += kPiece) {
    piece.resize(static_cast<std::size_t>(std::min(kPiece, count - first)));
    reader.read_stored(first, std::as_writable_bytes(std::span(piece)));
    for (const Stored value : piece) {
      if (!take(value)) return;
    }
  }
}

/// Sets the numbers of an array whose scale is set; floating-point numbers become values.
template <class Stored>
void read_numbers(VolumeReader& reader, GridArray& array) {
  const auto count = static_cast<std::size_t>(reader.source().values());
  const auto for_each = [&reader](const auto& take) { for_each_number<Stored>(reader, take); };
  if (std::is_integral_v<Stored> || !array.scaled()) return set_numbers<Stored>(for_each, count, array);
  const auto for_each_value = [&](const auto& take) {
    for_each([&](Stored number) { return take(array.value(number)); });
  };
  set_numbers<double>(for_each_value, count, array);
  array.slope = 1;
  array.intercept = 0;
}

/// The array with one component for each time.
ImageArray with_times(const ImageHeader& header, const ImageArray& array) {
  if (header.times == 1) return array;
  if (array.source.components > 1)
    fail("{}: expected vectors of one time, found {} times", header.name, header.times);
  ImageArray all = array;
  all.source.components = static_cast<std::size_t>(header.times);
  all.planar = true;
  return all;
}

/// Reads an array; `labels`: as runs if its numbers are whole and not too many differ.
GridArray read_array(const ImageArray& array, bool labels, std::string& remark) {
  GridArray result;
  result.name = array.name;
  result.type = stored_name(array.source.stored);
  result.centering = array.centering;
  result.components = static_cast<int>(array.source.components);
  if (!array.segments.empty()) {
    result.components = 1;
    result.runs = read_segment_layers(array.source, array.planar, array.segments, remark);
    if (!labels) result.expand();
    return result;
  }
  result.component_names = array.component_names;
  result.slope = array.source.slope;
  result.intercept = array.source.intercept;
  if (labels && !array.planar && array.source.components == 1 && !array.source.scaled())
    result.runs = read_whole_runs(array.source, remark);
  if (result.runs) return result;
  VolumeReader reader = open_in_memory(array.source);
  if (!reader.source().remark.empty()) remark = reader.source().remark;
  visit_stored_type(array.source.stored, [&]<class Stored>(Stored) { read_numbers<Stored>(reader, result); });
  if (array.planar) interleave(result);
  return result;
}

}  // namespace

std::vector<double> read_doubles(const VolumeSource& source) {
  VolumeReader reader = open_in_memory(source);
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(source.values()));
  visit_stored_type(source.stored, [&]<class Stored>(Stored) {
    for_each_number<Stored>(reader, [&values](Stored value) {
      values.push_back(static_cast<double>(value));
      return true;
    });
  });
  return values;
}

ImageHeader raw_image(const std::filesystem::path& path, const RawVolume& raw) {
  ImageHeader image;
  image.kind = "bare samples";
  image.name = path.string();
  image.dimensions = raw.dimensions;
  image.spacing = raw.spacing;
  image.axes.origin = raw.origin;
  for (int axis = 0; axis < 3; ++axis)
    image.axes.directions[static_cast<std::size_t>(axis)] *= raw.spacing[axis];
  image.centers.emplace();
  VolumeSource source;
  source.name = image.name;
  source.file = path;
  source.skip_bytes = raw.header_bytes;
  source.trailing = TrailingBytes::kRefused;
  source.set_stored(raw.type);
  source.big_endian = raw.big_endian;
  source.grid.dimensions = raw.dimensions;
  image.arrays.push_back({.name = {}, .centering = Centering::kPoints, .source = std::move(source)});
  return image;
}

VolumeSource volume_of(const ImageHeader& header, const std::string& array,
                       std::optional<std::uint64_t> time) {
  const ImageArray& chosen = chosen_array(header, array);
  VolumeSource source = chosen.source;
  if (source.kind.empty()) source.kind = header.kind;
  source.array = chosen.name;
  if (array.empty()) source.other_arrays = others(header, chosen);
  source.grid.dimensions = header.dimensions;
  source.grid.spacing = header.spacing;
  source.grid.space = header.space;
  source.grid.length_unit = header.length_unit;
  source.grid.value_unit = header.value_unit;
  source.grid.check(source.name);
  require_found(header, chosen);
  if (source.components != 1)
    fail("{}: expected one value per sample, found {}{}", header.name, source.components,
         chosen.segments.empty() ? "" : " layers of segments");
  set_time(header, time, source);
  GridAxes axes = header.axes;
  for (std::size_t a = 0; a < 3; ++a) {
    if (header.first[a] != 0) axes.origin += static_cast<double>(header.first[a]) * axes.directions[a];
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto& nodes = header.nodes[static_cast<std::size_t>(axis)];
    if (nodes.empty()) continue;
    axes.directions[static_cast<std::size_t>(axis)] *= even_step(header.name, axis, nodes);
    axes.origin[axis] = nodes.front();
  }
  source.set_axes(axes);
  return source;
}

GridFile grid_of(const ImageHeader& header, const std::filesystem::path& path, const GridReading& reading) {
  GridFile file;
  file.kind = header.kind;
  file.space = header.space;
  file.length_unit = header.length_unit;
  file.value_unit = header.value_unit;
  for (const Centering centering : {Centering::kCells, Centering::kPoints}) {
    for (const ImageArray& array : header.arrays) {
      if (array.centering != centering) continue;
      require_found(header, array);
      const std::string name = array.name.empty() ? file_stem(path) : array.name;
      const bool labels =
          visible_text(name) == reading.labels || (reading.only_array && header.arrays.size() == 1);
      file.arrays.push_back(read_array(with_times(header, array), labels, file.remark));
      if (array.name.empty() && header.arrays.size() == 1) file.arrays.back().name = file_stem(path);
    }
  }
  file.material_names = listed_names(header.label_names);
  if (header.material_names) file.material_names = read_texts(*header.material_names);
  if (!header.nodes[0].empty()) {
    file.nodes = header.nodes;
    return file;
  }
  GridAxes axes = header.axes;
  for (std::size_t a = 0; a < 3; ++a) {
    const double step = header.spacing[static_cast<int>(a)];
    if (step != 0) {
      for (int i = 0; i < 3; ++i) axes.directions[a][i] /= step;
    }
    const auto count = static_cast<std::int64_t>(header.dimensions[a]);
    for (std::int64_t i = 0; i < count; ++i)
      file.nodes[a].push_back(static_cast<double>(header.first[a] + i) * step);
    if (!header.centers) continue;
    const SampleCentering& center = (*header.centers)[a];
    file.stated[a] = center.stated;
    for (std::int64_t i = 0; i <= count; ++i) {
      const double face = static_cast<double>(header.first[a]) + center.first_face;
      file.faces[a].push_back((face + static_cast<double>(i) * center.cell) * step);
    }
  }
  lay_out(axes, file);
  return file;
}

}  // namespace adamas::io
