#include "core/io/vti_header.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "adamas/text.h"
#include "core/data/anatomical_space.h"
#include "core/io/header_text.h"
#include "core/io/input_formats.h"
#include "core/io/text_array.h"
#include "core/io/volume_import.h"
#include "core/io/vtk_checks.h"
#include "core/io/vtk_xml_array.h"

namespace adamas::io {

namespace {

/// The kind of grid in a file: its tag, and its name in messages.
struct VtkGridKind {
  std::string_view tag, name;
};

constexpr VtkGridKind kImage{"ImageData", "VTK XML image"},
    kRectilinear{"RectilinearGrid", "VTK XML rectilinear grid"};

class Parser {
 public:
  Parser(const VtkGridKind& kind, const std::vector<XmlTag>& tags, const std::filesystem::path& path)
      : kind_(kind), tags_(tags), arrays_(path.string(), path) {
    header_.kind = kind.name;
    header_.name = path.string();
  }

  ImageHeader run() {
    for (const XmlTag& tag : tags_) {
      if (tag.name == "AppendedData") {
        find_appended(tag);
      } else if (tag.closing) {
        if (tag.name == parent_) parent_.clear();
      } else {
        open(tag);
      }
    }
    if (!has_grid_) fail("{}: expected a {}, found none", header_.name, kind_.name);
    for (ImageArray& array : header_.arrays) note_missing(array);
    if (names_ && names_->source.header_bytes > 0 && form_.empty()) header_.material_names = names_->source;
    if (kind_.tag == kRectilinear.tag) read_nodes();
    header_.length_unit = unit_of(text_of(kVtiLengthUnit));
    header_.value_unit = unit_of(text_of(kVtiValueUnit));
    if (const std::string space = text_of(kVtiSpace); is_space(space)) header_.space = space;
    return std::move(header_);
  }

 private:
  /// Notes that all arrays that follow have a form in which they cannot be read.
  void note_form(std::string_view what, std::string_view expected, std::string_view found) {
    if (form_.empty()) form_ = expected_value(what, expected, found);
  }

  void open(const XmlTag& tag) {
    if (tag.name == "VTKFile") read_file(tag);
    if (tag.name == kind_.tag) read_grid(tag);
    if (tag.name == "Piece" && has_grid_) read_piece(tag);
    if (tag.name == "PointData" || tag.name == "CellData" || tag.name == "FieldData" ||
        tag.name == "Coordinates")
      parent_ = tag.name;
    if (tag.name == "PointData") header_.active = tag.value("Scalars");
    if ((tag.name == "DataArray" || tag.name == "Array") && has_grid_ && !parent_.empty()) read_array(tag);
  }

  void read_file(const XmlTag& tag) {
    if (tag.value("type") != kind_.tag) arrays_.fail_value("VTKFile type", kind_.tag, tag.value("type"));
    if (tag.has("compressor") && tag.value("compressor") != "vtkZLibDataCompressor")
      note_form("compressor", "vtkZLibDataCompressor or none", tag.value("compressor"));
    arrays_.read_file_tag(tag);
  }

  void read_grid(const XmlTag& tag) {
    if (!arrays_.has_file_tag()) fail("{}: expected a tag VTKFile first, found {}", header_.name, kind_.tag);
    extent_ = arrays_.numbers<std::int64_t>(tag, "WholeExtent", 6);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      constexpr std::int64_t kFarthest = std::int64_t{1} << 60;
      const std::int64_t from = extent_[2 * axis], to = extent_[2 * axis + 1];
      if (from > to || from < -kFarthest || to > kFarthest) {
        arrays_.fail_value("WholeExtent", "x0 x1 y0 y1 z0 z1 with x0 <= x1 and so on",
                           tag.value("WholeExtent"));
      }
      header_.dimensions[axis] = static_cast<std::uint64_t>(to - from) + 1;
      if (kind_.tag == kImage.tag) header_.first[axis] = from;
    }
    if (kind_.tag == kImage.tag) read_places(tag);
    has_grid_ = true;
  }

  void read_places(const XmlTag& tag) {
    const auto vector = [&](const char* attribute) {
      const auto v = arrays_.numbers<double>(tag, attribute, 3);
      return Vec3{v[0], v[1], v[2]};
    };
    if (tag.has("Spacing")) header_.spacing = vector("Spacing");
    if (tag.has("Origin")) header_.axes.origin = vector("Origin");
    if (tag.has("Direction")) {
      const auto m = arrays_.numbers<double>(tag, "Direction", 9);
      for (std::size_t a = 0; a < 3; ++a) header_.axes.directions[a] = {m[a], m[3 + a], m[6 + a]};
    }
    for (int axis = 0; axis < 3; ++axis)
      header_.axes.directions[static_cast<std::size_t>(axis)] *= header_.spacing[axis];
  }

  void read_piece(const XmlTag& tag) {
    if (arrays_.numbers<std::int64_t>(tag, "Extent", 6) != extent_)
      note_form("Piece Extent", "one piece of the whole extent", tag.value("Extent"));
    if (std::exchange(has_piece_, true)) note_form("Piece", "one piece", "several");
  }

  void read_array(const XmlTag& tag) {
    const std::string name(tag.value("Name"));
    const bool text = tag.value("type") == "String";
    if (parent_ == "FieldData") {
      if (text && name == "material_names" && !names_) names_ = arrays_.array_of(tag);
      if (text && (name == kVtiLengthUnit || name == kVtiValueUnit || name == kVtiSpace))
        texts_.emplace(name, arrays_.array_of(tag).source);
      return;
    }
    if (parent_ == "Coordinates") {
      coordinates_.push_back(arrays_.array_of(tag));
      return;
    }
    const Centering centering = parent_ == "CellData" ? Centering::kCells : Centering::kPoints;
    // Arrays of further times have the same name.
    const bool known = std::any_of(header_.arrays.begin(), header_.arrays.end(), [&](const ImageArray& a) {
      return !name.empty() && a.name == name && a.centering == centering;
    });
    if (known || text || name == "vtkGhostType") return;
    ImageArray array = arrays_.array_of(tag);
    array.centering = centering;
    array.source.grid.dimensions = header_.dimensions;
    if (centering == Centering::kCells) {
      // Along an axis with one point there is one cell.
      for (std::uint64_t& n : array.source.grid.dimensions) n = std::max<std::uint64_t>(n - 1, 1);
    }
    header_.arrays.push_back(std::move(array));
  }

  void find_appended(const XmlTag& tag) {
    for (ImageArray& array : header_.arrays) arrays_.find_appended(tag, array.source);
    for (ImageArray& array : coordinates_) arrays_.find_appended(tag, array.source);
    if (names_) arrays_.find_appended(tag, names_->source);
    for (auto& each : texts_) arrays_.find_appended(tag, each.second);
  }

  /// The one text of an array of field data; empty where there is none.
  [[nodiscard]] std::string text_of(const char* name) const {
    const auto found = texts_.find(name);
    if (found == texts_.end() || found->second.header_bytes == 0 || !form_.empty()) return {};
    const std::vector<std::string> texts = read_texts(found->second);
    return texts.size() == 1 ? visible_text(texts.front()) : std::string();
  }

  /// Reads positions along the axes.
  void read_nodes() {
    if (!form_.empty()) return;
    if (coordinates_.size() != 3)
      fail("{}: expected arrays of coordinates along three axes, found {}", header_.name,
           coordinates_.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ImageArray& array = coordinates_[axis];
      note_missing(array);
      if (!array.missing.empty()) fail("{}: {}", header_.name, array.missing);
      array.source.grid.dimensions = {header_.dimensions[axis], 1, 1};
      if (array.source.components != 1)
        fail("{}: expected one coordinate for each node, found {}", header_.name, array.source.components);
      header_.nodes[axis] = read_doubles(array.source);
    }
  }

  void note_missing(ImageArray& array) const {
    if (!form_.empty()) {
      array.missing = form_;
      array.other_form = true;
    }
    // No values can lie at the beginning of a file.
    if (!array.missing.empty() || array.source.header_bytes > 0) return;
    constexpr std::size_t kShown = 40;
    array.missing = array.source.before_tag ? fmt::format("expected values of the array '{}', found none",
                                                          printable(array.name, kShown))
                                            : "expected appended data, found the file's end";
  }

  const VtkGridKind& kind_;
  const std::vector<XmlTag>& tags_;
  VtkXmlArrays arrays_;
  ImageHeader header_;
  std::string form_;    ///< why nothing can be read here, as ImageArray::missing
  std::string parent_;  ///< PointData, CellData, FieldData or Coordinates while it is open
  std::vector<std::int64_t> extent_;
  std::optional<ImageArray> names_;                         ///< the texts of the array material_names
  std::map<std::string, VolumeSource, std::less<>> texts_;  ///< of field data: units and the space
  std::vector<ImageArray> coordinates_;
  bool has_grid_ = false, has_piece_ = false;
};

std::vector<XmlTag> read_tags(const std::filesystem::path& path) {
  return read_xml_tags(supply_file(FileHandle::open(path), 0), path.string());
}

bool has_other_form(const VtkGridKind& kind, const ImageHeader& header) {
  if (kind.tag == kRectilinear.tag && header.nodes[0].empty()) return true;
  return std::any_of(header.arrays.begin(), header.arrays.end(),
                     [](const ImageArray& array) { return array.other_form; });
}

/// Reads the forms of such files that are left to VTK.
GridFile read_checked(const VtkGridKind& kind, const std::filesystem::path& path) {
  const std::vector<XmlTag> tags = read_tags(path);
  check_vtk_xml(tags, path);
  const ImageHeader header = Parser(kind, tags, path).run();
  if (!has_other_form(kind, header)) return grid_of(header, path);
  check_vtk_counts(tags, path);
  return read_grid_by_library(path);
}

VolumeSource find_rectilinear_volume(const std::filesystem::path& path, const VolumeOptions& options,
                                     Progress& progress) {
  const std::vector<XmlTag> tags = read_tags(path);
  check_vtk_xml(tags, path);
  const ImageHeader header = Parser(kRectilinear, tags, path).run();
  if (!has_other_form(kRectilinear, header)) return volume_of(header, options.array, {});
  check_vtk_counts(tags, path);
  return import_grid(path, options, progress);
}

bool is_vti(std::string_view bytes) {
  return bytes.starts_with("<") && bytes.find("<VTKFile") != std::string_view::npos &&
         bytes.find("ImageData") != std::string_view::npos;
}

}  // namespace

InputFormat vti_format() {
  return {.name = kImage.name,
          .endings = ".vti",
          .shown_by = is_vti,
          .read_header = [](const std::filesystem::path& path) { return vti_header(read_tags(path), path); },
          .read_grid = [](const std::filesystem::path& path) { return read_checked(kImage, path); },
          .several_arrays = true};
}

InputFormat vtr_format() {
  return {.name = kRectilinear.name,
          .endings = ".vtr",
          .read_grid = [](const std::filesystem::path& path) { return read_checked(kRectilinear, path); },
          .find_volume = find_rectilinear_volume,
          .several_arrays = true};
}

ImageHeader vti_header(const std::vector<XmlTag>& tags, const std::filesystem::path& path) {
  return Parser(kImage, tags, path).run();
}

}  // namespace adamas::io
