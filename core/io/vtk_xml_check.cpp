#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/io/header_text.h"
#include "core/io/input_file.h"
#include "core/io/vtk_checks.h"

namespace adamas::io {

namespace {

constexpr std::size_t kShown = 60;

struct Extent {
  std::array<std::int64_t, 6> ends{};

  [[nodiscard]] std::int64_t first(std::size_t axis) const { return ends[2 * axis]; }
  [[nodiscard]] std::int64_t last(std::size_t axis) const { return ends[2 * axis + 1]; }
  [[nodiscard]] bool contains(const Extent& other) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (other.first(axis) < first(axis) || other.last(axis) > last(axis)) return false;
    }
    return true;
  }
  [[nodiscard]] double nodes() const {
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) sum += static_cast<double>(last(axis) - first(axis) + 1);
    return sum;
  }
  /// Where an axis has one point, it counts as a cell.
  [[nodiscard]] double cells() const {
    double product = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
      product *= static_cast<double>(std::max<std::int64_t>(last(axis) - first(axis), 1));
    return product;
  }
};

/// How many values a byte of a file may stand for. They may be bits.
double values_per_byte(std::string_view compressor) {
  constexpr double kBits = 8;
  if (compressor.empty()) return kBits;
  // Deflate makes at most 258 bytes of two bits.
  constexpr double kDeflate = 1032, kOthers = 1e5;
  return kBits * (compressor == "vtkZLibDataCompressor" ? kDeflate : kOthers);
}

class XmlChecker {
 public:
  XmlChecker(const std::filesystem::path& path, std::uint64_t size) : name_(path.string()), size_(size) {}

  void run(const std::vector<XmlTag>& tags) {
    for (const XmlTag& tag : tags) {
      if (tag.name == "PointData" || tag.name == "CellData") in_data_ = !tag.closing;
      if (tag.closing) continue;
      if (tag.name == "VTKFile") values_per_byte_ = values_per_byte(tag.value("compressor"));
      if (tag.name == "ImageData" || tag.name == "RectilinearGrid") read_whole(tag);
      if (tag.name == "Piece") read_piece(tag);
      if (tag.name == "DataArray") read_array(tag);
    }
    if (!whole_) return;
    if (pieces_ > 0 && cells_ != whole_->cells()) {
      fail("{}: expected pieces that make up the WholeExtent of {} cells, found {}", name_, whole_->cells(),
           cells_);
    }
    check_size();
  }

 private:
  [[nodiscard]] Extent extent(const XmlTag& tag, std::string_view attribute) const {
    constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
    const auto values = parse_number_list<std::int64_t>(tag.value(attribute));
    Extent result;
    bool good = values && values->size() == 6;
    for (std::size_t axis = 0; good && axis < 3; ++axis) {
      const std::int64_t first = (*values)[2 * axis], last = (*values)[2 * axis + 1];
      result.ends[2 * axis] = first;
      result.ends[2 * axis + 1] = last;
      good = -kMost <= first && first <= last && last <= kMost;
    }
    if (!good) {
      fail("{}: {}: expected x0 x1 y0 y1 z0 z1 with x0 <= x1 and so on, all below 2^31, found '{}'", name_,
           attribute, printable(tag.value(attribute), kShown));
    }
    return result;
  }

  void read_whole(const XmlTag& tag) {
    whole_ = extent(tag, "WholeExtent");
    whole_text_ = printable(tag.value("WholeExtent"), kShown);
  }

  void read_piece(const XmlTag& tag) {
    if (!whole_) return;
    const Extent piece = extent(tag, "Extent");
    if (!whole_->contains(piece)) {
      fail("{}: expected a piece within the WholeExtent '{}', found '{}'", name_, whole_text_,
           printable(tag.value("Extent"), kShown));
    }
    cells_ += piece.cells();
    ++pieces_;
  }

  void read_array(const XmlTag& tag) {
    if (in_data_) ++arrays_;
    if (tag.value("format") != "appended") return;
    const auto offset = parse_number_list<std::uint64_t>(tag.value("offset"));
    if (!offset || offset->size() != 1 || offset->front() >= size_) {
      fail("{}: array '{}': expected an offset into the file's {} bytes, found '{}'", name_,
           printable(tag.value("Name"), kShown), size_, printable(tag.value("offset"), kShown));
    }
  }

  void check_size() const {
    constexpr double kMostNodes = 1 << 24;
    const double most = static_cast<double>(size_) * values_per_byte_;
    if (arrays_ > 0 && whole_->cells() > most) {
      fail("{}: expected at most {:.0f} values of each array in {} bytes, found the WholeExtent '{}'", name_,
           most, size_, whole_text_);
    }
    if (arrays_ == 0 && whole_->nodes() > kMostNodes) {
      fail("{}: expected arrays, or at most {:.0f} nodes, found none with the WholeExtent '{}'", name_,
           kMostNodes, whole_text_);
    }
  }

  std::string name_, whole_text_;
  std::uint64_t size_;
  double values_per_byte_ = 1;
  std::optional<Extent> whole_;
  double cells_ = 0;
  int pieces_ = 0, arrays_ = 0;
  bool in_data_ = false;  ///< between the tags of PointData or CellData
};

}  // namespace

void check_vtk_xml(const std::vector<XmlTag>& tags, const std::filesystem::path& path) {
  XmlChecker(path, check_input_file(path)).run(tags);
}

}  // namespace adamas::io
