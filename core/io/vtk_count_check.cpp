#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/io/volume_unpacking.h"
#include "core/io/vtk_checks.h"
#include "core/io/vtk_xml_array.h"

namespace adamas::io {

namespace {

/// Tags with arrays in them, some of which have tags of their own.
constexpr std::string_view kSections[] = {"PointData", "CellData", "FieldData", "Points", "Coordinates",
                                          "Cells",     "Verts",    "Lines",     "Strips", "Polys"};

/// Counts the values of arrays and compares them with what their piece has.
class CountChecker {
 public:
  explicit CountChecker(const std::filesystem::path& path) : name_(path.string()), arrays_(name_, path) {}

  void run(const std::vector<XmlTag>& tags) {
    for (const XmlTag& tag : tags) {
      if (tag.name == "AppendedData") {
        for (Counted& counted : counted_) arrays_.find_appended(tag, counted.array.source);
      } else if (tag.closing) {
        if (tag.name == section_) section_.clear();
      } else if (tag.name == "VTKFile") {
        arrays_.read_file_tag(tag);
      } else if (tag.name == "Piece") {
        read_piece(tag);
      } else if (tag.name == "DataArray") {
        read_array(tag);
      } else if (std::ranges::find(kSections, tag.name) != std::end(kSections)) {
        section_ = tag.name;
        coordinates_ = 0;
      }
    }
    std::for_each(counted_.begin(), counted_.end(), [this](const Counted& counted) { check(counted); });
  }

 private:
  struct Counted {
    ImageArray array;
    std::uint64_t tuples = 0;
  };

  void read_piece(const XmlTag& tag) {
    counts_.clear();
    nodes_.clear();
    if (const auto extent = parse_number_list<std::int64_t>(tag.value("Extent"));
        extent && extent->size() == 6) {
      std::uint64_t points = 1, cells = 1;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        // Of extents that are out of order the reader tells.
        const auto steps = static_cast<std::uint64_t>((*extent)[2 * axis + 1]) -
                           static_cast<std::uint64_t>((*extent)[2 * axis]);
        nodes_.push_back(steps + 1);
        points *= steps + 1;
        // Where an axis has one point, it counts as a cell.
        cells *= std::max<std::uint64_t>(steps, 1);
      }
      counts_ = {{"PointData", points}, {"CellData", cells}};
      return;
    }
    std::uint64_t cells = 0;
    for (const char* section : {"Cells", "Verts", "Lines", "Strips", "Polys"}) {
      const auto count = parse_number_list<std::uint64_t>(tag.value(std::string("NumberOf") + section));
      if (!count || count->size() != 1) continue;
      counts_[section] = count->front();
      cells += count->front();
    }
    counts_["CellData"] = cells;
    const auto points = parse_number_list<std::uint64_t>(tag.value("NumberOfPoints"));
    if (points && points->size() == 1) counts_["PointData"] = counts_["Points"] = points->front();
  }

  /// How many tuples an array of the section has to have, where that is known.
  std::optional<std::uint64_t> tuples_of(const XmlTag& tag) {
    if (section_ == "Coordinates")
      return coordinates_ < nodes_.size() ? std::optional(nodes_[coordinates_++]) : std::nullopt;
    const auto found = counts_.find(section_);
    if (found == counts_.end()) return {};
    const bool of_cells = section_ != "PointData" && section_ != "CellData" && section_ != "Points";
    // Only the last offset tells how many indices there are.
    if (of_cells && tag.value("Name") != "offsets" && tag.value("Name") != "types") return {};
    return found->second;
  }

  void read_array(const XmlTag& tag) {
    const auto tuples = tuples_of(tag);
    if (!tuples || !arrays_.has_file_tag()) return;
    ImageArray array = arrays_.array_of(tag);
    // What the type or the form of others is, VTK says.
    if (array.missing.empty() && array.source.components > 0) counted_.push_back({std::move(array), *tuples});
  }

  void check(const Counted& counted) const {
    const VolumeSource& source = counted.array.source;
    const bool has_place = source.header_bytes > 0;
    if (!has_place && !source.before_tag) return;
    const std::uint64_t found = has_place ? measure_vtk_array(source) / stored_bytes(source.stored) : 0;
    if (found / source.components == counted.tuples && found % source.components == 0) return;
    fail("{}: array '{}': expected {}{} values, found {}", name_, printable(counted.array.name, 40),
         counted.tuples, source.components > 1 ? fmt::format(" x {}", source.components) : "", found);
  }

  std::string name_, section_;
  VtkXmlArrays arrays_;
  std::map<std::string, std::uint64_t, std::less<>> counts_;  ///< tuples of arrays by the tag round them
  std::vector<std::uint64_t> nodes_;                          ///< along the axes of the piece
  std::size_t coordinates_ = 0;                               ///< arrays of them so far
  std::vector<Counted> counted_;
};

}  // namespace

void check_vtk_counts(const std::vector<XmlTag>& tags, const std::filesystem::path& path) {
  CountChecker(path).run(tags);
}

}  // namespace adamas::io
