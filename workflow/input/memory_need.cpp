#include "workflow/input/memory_need.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <vector>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"

namespace adamas::workflow {

using namespace io;

namespace {

// The peaks of `adamas reconstruct` were measured by scripts/memory_model, which prints them beside these
// estimates: run it after a change of reading or reconstruction, and set these figures so that no estimate is
// far below its peak. Bytes.

/// The program, its libraries and small inputs.
constexpr double kProgram = 45 << 20;
/// A number of an array while a file is read: as it is stored, as it is kept, and as it is taken over.
constexpr double kReadNumber = 9;
/// A cell of the data while interfaces are reconstructed, whatever is in it: of labels that change so often
/// that they are kept dense, and of fractions with what each material takes.
constexpr double kLabelCell = 4, kFractionCell = 40, kFractionOfCell = 8;
/// A row of labels along x, and a run of equal ones in it (LabelRows).
constexpr double kLabelRow = 8, kLabelRun = 24;
/// A place where materials meet: a face between cells with different labels, of which many take half as much
/// (where tables are enough) and few a half more; a mixed cell, or a face between cells that different
/// materials fill.
constexpr double kLabelPlace = 950, kFractionPlace = 700;

/// What a mesh of cells takes while it is read and its faces are joined: at least, for each cell and point;
/// and for all it has, faces and interfaces as well.
constexpr double kLeastMeshCell = 150, kMeshCell = 100, kMeshFace = 60, kMeshPoint = 60;
/// A cell of a mesh with several materials while interfaces are reconstructed, and any cell of fractions.
constexpr double kMeshMixedCell = 14500, kMeshFractionCell = 20;

/// What is read of files, as far as headers tell.
struct HeaderFacts {
  double cells = 0;    ///< sites of the grid in the file
  double rows = 0;     ///< rows of sites along x
  double numbers = 0;  ///< numbers of all arrays of all files, but for labels that are read as runs
};

/// Returns the six numbers behind an XML attribute of extents.
std::optional<std::array<double, 6>> extent_of(std::string_view text, std::string_view attribute) {
  std::size_t at = text.find(attribute);
  if (at == std::string_view::npos) return {};
  at += attribute.size();
  std::array<double, 6> result{};
  const char *next = text.data() + at, *end = text.data() + text.size();
  for (double& number : result) {
    while (next < end && (*next == ' ' || *next == '=' || *next == '"')) ++next;
    const auto [behind, code] = std::from_chars(next, end, number);
    if (code != std::errc()) return {};
    next = behind;
  }
  return result;
}

/// Whether an array is read as runs if labels are taken from it.
bool may_be_runs(const ImageArray& array) {
  bool whole = false;
  visit_stored_type(array.source.stored, [&whole]<class Stored>(Stored) {
    whole = std::is_integral_v<Stored> && !std::is_same_v<Stored, std::uint64_t>;
  });
  const bool labels = array.source.components == 1 || (!array.segments.empty() && !array.planar);
  return whole && labels && !array.source.scaled();
}

/// Returns what the header of a file says; none where it is not known without reading the file. `labels`: the
/// name of the array of labels, or any if the file has one array only; none if labels are in no array of it.
std::optional<HeaderFacts> facts_of(const std::filesystem::path& path,
                                    const std::optional<std::string>& labels) {
  // Of a pattern of pictures and of a folder there is no one header.
  if (io::is_file_pattern(path) || std::filesystem::is_directory(path)) return {};
  const InputFormat* format = find_input_format(path);
  if (format == nullptr) return {};
  if (format->read_header != nullptr) {
    ImageHeader header;
    try {
      header = format->read_header(path);
    } catch (const Error&) {
      return {};  // reading the file tells what is wrong, or has another way
    }
    HeaderFacts facts{1, 1, 0};
    for (const std::uint64_t n : header.dimensions) facts.cells *= static_cast<double>(n);
    facts.rows = facts.cells / static_cast<double>(std::max<std::uint64_t>(header.dimensions[0], 1));
    for (const ImageArray& array : header.arrays) {
      const bool of_labels = labels && (header.arrays.size() == 1 || array.name == *labels);
      if (!of_labels || header.times > 1 || !may_be_runs(array))
        facts.numbers += facts.cells * static_cast<double>(array.source.components);
    }
    return facts;
  }
  // A rectilinear grid of VTK's XML: the arrays are about as many bytes as the file, or more.
  const std::string beginning = read_beginning(path);
  const auto extent = extent_of(beginning, "WholeExtent");
  if (!extent) return {};
  HeaderFacts facts{1, 1, 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double count = std::max(1.0, (*extent)[2 * axis + 1] - (*extent)[2 * axis]);
    facts.cells *= count;
    if (axis > 0) facts.rows *= count;
  }
  facts.numbers = facts.cells;
  return facts;
}

/// Returns the file that FILE-or-ARRAY names; none for an array.
std::optional<std::filesystem::path> file_of(const std::filesystem::path& main, const std::string& value) {
  std::error_code code;
  for (const std::filesystem::path& file : {std::filesystem::path(value), main.parent_path() / value}) {
    if (!std::filesystem::exists(file, code)) continue;
    if (std::filesystem::equivalent(file, main, code)) return {};
    return file;
  }
  return {};
}

/// Returns the number of sites of a row that have other labels than those of another row.
std::size_t count_different(const LabelRows& labels, std::size_t row, std::size_t other) {
  std::size_t count = 0;
  std::uint32_t a = labels.first[row], b = labels.first[other], at = 0;
  while (at < labels.length) {
    const std::uint32_t a_end = labels.end(a, row), b_end = labels.end(b, other),
                        end = std::min(a_end, b_end);
    if (labels.labels[a] != labels.labels[b]) count += end - at;
    at = end;
    if (a_end == end) ++a;
    if (b_end == end) ++b;
  }
  return count;
}

/// Counts the faces between sites of different labels.
std::size_t count_faces(const LabelRows& labels, const RectilinearGrid& grid) {
  const std::size_t ny = grid.sites(1), nz = grid.sites(2);
  std::vector<std::size_t> counts(nz, 0);
  parallel_for(nz, 1, [&](std::size_t k) {
    for (std::size_t j = 0; j < ny; ++j) {
      const std::size_t row = j + ny * k;
      counts[k] += labels.first[row + 1] - labels.first[row] - 1;
      if (j + 1 < ny) counts[k] += count_different(labels, row, row + 1);
      if (k + 1 < nz) counts[k] += count_different(labels, row, row + ny);
    }
  });
  return std::accumulate(counts.begin(), counts.end(), std::size_t{0});
}

/// Counts the mixed cells of fractions, and the faces between cells that different materials fill.
std::size_t count_places(const MultiMaterialData& data) {
  constexpr std::uint32_t kMixed = 0xffffffffu;
  const std::size_t nx = data.grid.sites(0), ny = data.grid.sites(1), nz = data.grid.sites(2);
  const auto material_at = [&](std::size_t site) -> std::uint32_t {
    for (MaterialId m(0); m.value < data.materials.size(); ++m.value) {
      if (data.fractions[m][site] >= 1) return m.value;
    }
    return kMixed;
  };
  std::vector<std::size_t> counts(nz, 0);
  parallel_for(nz, 1, [&](std::size_t k) {
    std::size_t site = k * nx * ny, count = 0;
    for (std::size_t j = 0; j < ny; ++j) {
      for (std::size_t i = 0; i < nx; ++i, ++site) {
        const std::uint32_t own = material_at(site);
        if (own == kMixed) {
          ++count;
          continue;
        }
        const auto meets = [&](bool inside, std::size_t stride) {
          if (!inside) return false;
          const std::uint32_t other = material_at(site + stride);
          return other != own && other != kMixed;
        };
        count += (meets(i + 1 < nx, 1) ? 1 : 0) + (meets(j + 1 < ny, nx) ? 1 : 0) +
                 (meets(k + 1 < nz, nx * ny) ? 1 : 0);
      }
    }
    counts[k] = count;
  });
  return std::accumulate(counts.begin(), counts.end(), std::size_t{0});
}

/// Estimates what reconstruction takes of labels, beside what the program takes.
double bytes_of_labels(const MultiMaterialData& data) {
  const auto labels = data.labels.rows(data.grid.sites(0));
  if (!labels) return std::numeric_limits<double>::infinity();
  return static_cast<double>(labels->rows()) * kLabelRow +
         static_cast<double>(labels->starts.size()) * kLabelRun +
         static_cast<double>(count_faces(*labels, data.grid)) * kLabelPlace +
         (data.labels.is_dense() ? static_cast<double>(data.grid.site_count()) * kLabelCell : 0);
}

double bytes_of_fractions(const MultiMaterialData& data) {
  const double of_cell = kFractionCell + kFractionOfCell * static_cast<double>(data.materials.size());
  return static_cast<double>(data.grid.site_count()) * of_cell +
         static_cast<double>(count_places(data)) * kFractionPlace;
}

std::string cells_text(double cells) { return fmt::format("{:.0f} cells", cells); }

/// `part`: what is said of choosing a part, for data that allow it.
void check_need(const InputOptions& options, const std::string& source, const std::string& found,
                double bytes, std::string_view how, std::string_view part = "a part by --region, ") {
  if (bytes <= static_cast<double>(options.memory)) return;
  fail(
      "{}: expected data that take at most {} of memory, found {}, which take {} {}: choose "
      "{}coarser data, or another limit by --memory",
      source, bytes_text(static_cast<double>(options.memory)), found, how, bytes_text(bytes), part);
}

/// Estimates what fields take.
double bytes_of_fields(const auto& fields) {
  double numbers = 0;
  for (const Field& field : fields) {
    numbers += static_cast<double>(field.values.size());
    for (const auto& values : field.material_values) numbers += static_cast<double>(values.size());
  }
  return numbers * sizeof(double);
}

/// Returns the first number behind a text; 0 if there is none.
double number_behind(std::string_view text, std::string_view before) {
  const std::size_t at = text.find(before);
  if (at == std::string_view::npos) return 0;
  std::string_view rest = text.substr(at + before.size());
  rest.remove_prefix(std::min(rest.find_first_not_of(" \t\""), rest.size()));
  double number = 0;
  const auto [end, code] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  return code == std::errc() && std::isfinite(number) ? std::max(number, 0.0) : 0;
}

/// Returns the size of a dimension in the header of a netCDF file; 0 if there is none.
double netcdf_dimension(std::string_view header, std::string_view name) {
  std::string entry{0, 0, 0, static_cast<char>(name.size())};
  entry += name;
  entry.resize((entry.size() + 3) / 4 * 4, '\0');
  const std::size_t at = header.find(entry);
  if (at == std::string_view::npos || at + entry.size() + 4 > header.size()) return 0;
  double size = 0;
  for (std::size_t i = 0; i < 4; ++i)
    size = 256 * size + static_cast<unsigned char>(header[at + entry.size() + i]);
  return size;
}

/// The numbers of cells and points that the header of a mesh states; 0 where it states none.
struct MeshCounts {
  double cells = 0, points = 0;
};

/// Returns the counts of a block of structured cells that reaches from the first to the last points.
MeshCounts block_counts(const std::array<double, 6>& extent) {
  MeshCounts counts{1, 1};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double cells = std::max(extent[2 * axis + 1] - extent[2 * axis], 0.0);
    counts.points *= cells + 1;
    counts.cells *= std::max(cells, 1.0);
  }
  return counts;
}

MeshCounts counts_of_header(const std::filesystem::path& path) {
  const std::string header = read_beginning(path);
  const std::string_view text = header;
  if (text.starts_with("CDF\x01") || text.starts_with("CDF\x02"))
    return {netcdf_dimension(text, "num_elem"), netcdf_dimension(text, "num_nodes")};
  if (text.starts_with("# vtk DataFile")) {
    // The points of structured cells are about as many as these.
    const double cells = number_behind(text, "\nCELLS "), points = number_behind(text, "\nPOINTS ");
    return {text.find("DATASET STRUCTURED_GRID") == std::string_view::npos ? cells : points, points};
  }
  if (const auto extent = extent_of(text, "WholeExtent")) return block_counts(*extent);
  return {number_behind(text, "NumberOfCells="), number_behind(text, "NumberOfPoints=")};
}

/// Counts the places of a mesh where materials meet: faces between cells of different labels, or cells with
/// several materials.
std::size_t count_places(const MeshData& data) {
  std::size_t count = 0;
  if (!data.labels.empty()) {
    for (std::size_t f = 0; f < data.mesh.face_count(); ++f) {
      const auto& [first, second] = data.mesh.cells_of_face(f);
      if (second != PolyhedralMesh::kNone && data.labels[first] != data.labels[second]) ++count;
    }
    return count;
  }
  for (std::size_t cell = 0; cell < data.mesh.cell_count(); ++cell) {
    const bool pure = std::any_of(data.fractions.begin(), data.fractions.end(),
                                  [cell](const auto& of_one) { return of_one[cell] >= 1; });
    if (!pure) ++count;
  }
  return count;
}

}  // namespace

void check_memory_of_headers(const InputOptions& options) {
  if (options.memory == 0) return;
  std::vector<std::filesystem::path> files{options.path};
  const auto add = [&](const std::string& value) {
    if (auto file = file_of(options.path, value)) files.push_back(std::move(*file));
  };
  for (const auto& [name, value] : options.data.fractions) add(value);
  for (const auto& [name, value] : options.data.fields) add(value);
  for (const std::string& value : {options.data.labels, options.data.fraction_array}) {
    if (!value.empty()) add(value);
  }
  const std::string& labels = options.data.labels;
  const std::filesystem::path labels_file =
      labels.empty() ? std::filesystem::path() : file_of(options.path, labels).value_or(options.path);
  HeaderFacts all;
  for (const std::filesystem::path& file : files) {
    const bool of_labels = !labels.empty() && file == labels_file;
    const auto facts = facts_of(file, of_labels ? std::optional(labels) : std::nullopt);
    if (!facts) continue;
    all.cells = std::max(all.cells, facts->cells);
    all.rows = std::max(all.rows, facts->rows);
    all.numbers += facts->numbers;
  }
  // A region may leave few cells, which is known when the file is read.
  const double kept = options.data.region ? 0
                      : !labels.empty()   ? all.rows * (kLabelRow + kLabelRun)
                                          : all.cells * kFractionCell;
  check_need(options, options.path.string(), cells_text(all.cells),
             kProgram + std::max(all.numbers * kReadNumber, kept), "at least");
}

void check_memory_of_data(const InputOptions& options, const MultiMaterialData& data) {
  if (options.memory == 0) return;
  const auto cells = static_cast<double>(data.grid.site_count());
  const double grid = data.labels.empty() ? bytes_of_fractions(data) : bytes_of_labels(data);
  check_need(options, data.source, cells_text(cells), kProgram + grid + bytes_of_fields(data.fields),
             "about");
}

void check_memory_of_mesh_header(const InputOptions& options) {
  if (options.memory == 0 || std::filesystem::is_directory(options.path)) return;
  const MeshCounts counts = counts_of_header(options.path);
  check_need(options, options.path.string(),
             counts.cells > 0 ? cells_text(counts.cells) : fmt::format("{:.0f} points", counts.points),
             kProgram + counts.cells * kLeastMeshCell + counts.points * kMeshPoint, "at least", "");
}

void check_memory_of_mesh(const InputOptions& options, const MeshData& data) {
  if (options.memory == 0) return;
  const auto cells = static_cast<double>(data.mesh.cell_count()),
             faces = static_cast<double>(data.mesh.face_count()),
             points = static_cast<double>(data.mesh.points().size());
  const bool labels = !data.labels.empty();
  const double interfaces = static_cast<double>(count_places(data)) * (labels ? kLabelPlace : kMeshMixedCell);
  const double of_cell = kMeshCell + (labels ? 0 : kMeshFractionCell);
  check_need(options, data.source, cells_text(cells),
             kProgram + cells * of_cell + faces * kMeshFace + points * kMeshPoint + interfaces +
                 bytes_of_fields(data.fields),
             "about", "");
}

}  // namespace adamas::workflow
