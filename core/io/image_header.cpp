#include "core/io/image_header.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>

#include "core/base/error.h"
#include "core/io/array_names.h"
#include "core/io/grid_axes.h"
#include "core/io/header_text.h"
#include "core/io/input_file.h"
#include "core/io/volume_reader.h"
#include "core/io/volume_unpacking.h"

namespace adamas {

namespace {

constexpr std::size_t kShown = 40;
/// Numbers that are read and converted in one go.
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

/// Names of arrays on points with one value each, but for one of them.
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
  if (before + 1 < header.times) source.rest = SampleRest::kElse;
}

/// Calls `take` with each number of an array, converted to Stored, until it says false.
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

/// The numbers of an array as whole ones; false where not all of them are and fit.
template <class Stored>
bool read_whole(VolumeReader& reader, std::vector<std::int32_t>& values) {
  if constexpr (std::is_integral_v<Stored>) {
    values.reserve(static_cast<std::size_t>(reader.source().values()));
    for_each_number<Stored>(reader, [&values](Stored value) {
      if (!std::in_range<std::int32_t>(value)) return false;
      values.push_back(static_cast<std::int32_t>(value));
      return true;
    });
    return values.size() == reader.source().values();
  }
  return false;
}

template <class Stored>
std::vector<float> read_floats(VolumeReader& reader) {
  const VolumeSource& source = reader.source();
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(source.values()));
  for_each_number<Stored>(reader, [&](Stored value) {
    values.push_back(source.scaled()
                         ? static_cast<float>(source.slope * static_cast<double>(value) + source.intercept)
                         : static_cast<float>(value));
    return true;
  });
  return values;
}

/// From all of one component after all of another to all of one site after all of another.
template <class T>
std::vector<T> interleaved(const std::vector<T>& planar, std::size_t components) {
  const std::size_t sites = planar.size() / components;
  std::vector<T> values(planar.size());
  for (std::size_t c = 0; c < components; ++c) {
    for (std::size_t i = 0; i < sites; ++i) values[i * components + c] = planar[c * sites + i];
  }
  return values;
}

VolumeReader open_whole(VolumeSource source) {
  if (source.packed()) source = unpack_into(FileHandle::in_memory(), source, SilentProgress::instance());
  return VolumeReader(std::move(source));
}

GridArray read_array(const ImageArray& array, std::string& remark) {
  VolumeReader reader = open_whole(array.source);
  remark = reader.source().remark;
  GridArray result;
  result.name = array.name;
  result.type = stored_name(array.source.stored);
  result.centering = array.centering;
  result.components = static_cast<int>(array.source.components);
  visit_stored_type(array.source.stored, [&]<class Stored>(Stored) {
    std::vector<std::int32_t> whole;
    if (!array.source.scaled() && read_whole<Stored>(reader, whole)) {
      result.values = std::move(whole);
    } else {
      result.values = read_floats<Stored>(reader);
    }
  });
  if (array.planar && array.source.components > 1)
    std::visit([&](auto& values) { values = interleaved(values, array.source.components); }, result.values);
  return result;
}

/// Texts with a zero behind each.
std::vector<std::string> read_texts(VolumeSource source) {
  source.grid.dimensions = {measure_vtk_array(source), 1, 1};
  if (source.grid.samples() == 0) return {};
  if (source.grid.samples() > kLongestHeader)
    fail("{}: expected material names of at most {} bytes, found {}", source.name, kLongestHeader,
         source.grid.samples());
  VolumeReader reader = open_whole(std::move(source));
  std::string text(static_cast<std::size_t>(reader.source().values()), '\0');
  reader.read_stored(0, std::as_writable_bytes(std::span(text)));
  std::vector<std::string> texts;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\0', begin), text.size());
    texts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return texts;
}

}  // namespace

std::vector<double> read_doubles(const VolumeSource& source) {
  VolumeReader reader = open_whole(source);
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

VolumeSource volume_of(const ImageHeader& header, const std::string& array,
                       std::optional<std::uint64_t> time) {
  const ImageArray& chosen = chosen_array(header, array);
  VolumeSource source = chosen.source;
  source.array = chosen.name;
  if (array.empty()) source.other_arrays = others(header, chosen);
  source.grid.dimensions = header.dimensions;
  source.grid.spacing = header.spacing;
  source.grid.space = header.space;
  source.grid.check(source.name);
  require_found(header, chosen);
  if (source.components != 1)
    fail("{}: expected one value per sample, found {}", header.name, source.components);
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

GridFile grid_of(const ImageHeader& header, const std::filesystem::path& path) {
  GridFile file;
  file.kind = header.kind;
  file.space = header.space;
  for (const Centering centering : {Centering::kCells, Centering::kPoints}) {
    for (const ImageArray& array : header.arrays) {
      if (array.centering != centering) continue;
      require_found(header, array);
      ImageArray first = array;
      if (header.times > 1) first.source.rest = SampleRest::kElse;
      file.arrays.push_back(read_array(first, file.remark));
      if (array.name.empty() && header.arrays.size() == 1) file.arrays.back().name = file_stem(path);
    }
  }
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

}  // namespace adamas
