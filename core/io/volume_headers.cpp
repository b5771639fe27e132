#include "core/io/volume_headers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "core/base/error.h"
#include "core/data/anatomical_space.h"
#include "core/io/nifti_header.h"
#include "core/io/stored_type.h"
#include "core/io/xml_file.h"

namespace adamas::io {

namespace {

std::string numbers(const Vec3& v, std::string_view separator = " ") {
  // No zero has a sign.
  return fmt::format("{}{}{}{}{}", v.x + 0.0, separator, v.y + 0.0, separator, v.z + 0.0);
}

std::string sizes(const VolumeGrid& grid) { return fmt::format("{}", fmt::join(grid.dimensions, " ")); }

Vec3 step(const VolumeGrid& grid, int axis) {
  return grid.spacing[axis] * grid.directions[static_cast<std::size_t>(axis)];
}

/// Where axes come from, as MetaImage has it: of each the side of the body, in LPS, that it leads away from
/// most, each of the three pairs of sides once.
std::string anatomical_orientation(const VolumeGrid& grid) {
  constexpr std::array<std::array<char, 2>, 3> kFrom{{{'R', 'L'}, {'A', 'P'}, {'I', 'S'}}};
  std::array<int, 3> order{0, 1, 2}, best = order;
  double greatest = -1;
  do {
    double product = 1;
    for (std::size_t a = 0; a < 3; ++a) product *= std::abs(grid.directions[a][order[a]]);
    if (product > greatest) best = order;
    greatest = std::max(greatest, product);
  } while (std::next_permutation(order.begin(), order.end()));
  std::string text;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto side = static_cast<std::size_t>(best[a]);
    text += kFrom[side][grid.directions[a][best[a]] < 0 ? 1 : 0];
  }
  return text;
}

}  // namespace

std::string nrrd_header_text(const VolumeGrid& grid, const std::string& data_name) {
  const std::string space = nrrd_space(grid.space);
  return fmt::format(
      "NRRD0004\ntype: {}\ndimension: 3\n{}sizes: {}\nspace directions: ({}) ({}) ({})\n"
      "kinds: domain domain domain\nendian: little\nencoding: raw\nspace origin: ({})\n{}\n",
      grid.type == SampleType::kFloat32 ? "float" : sample_name(grid.type),
      space.empty() ? "space dimension: 3\n" : "space: " + space + "\n", sizes(grid),
      numbers(step(grid, 0), ","), numbers(step(grid, 1), ","), numbers(step(grid, 2), ","),
      numbers(grid.origin, ","), data_name.empty() ? "" : "data file: " + data_name + "\n");
}

std::string meta_image_header_text(VolumeGrid grid, const std::string& data_name) {
  std::string orientation;
  if (to_space("LPS", grid)) orientation = "AnatomicalOrientation = " + anatomical_orientation(grid) + "\n";
  const auto& [i, j, k] = grid.directions;
  return fmt::format(
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "CompressedData = False\nTransformMatrix = {} {} {}\nOffset = {}\n{}ElementSpacing = {}\n"
      "DimSize = {}\nElementType = {}\nElementDataFile = {}\n",
      numbers(i), numbers(j), numbers(k), numbers(grid.origin), orientation, numbers(grid.spacing),
      sizes(grid), stored_name(stored_type(grid.type), TypeNames::kMetaImage),
      data_name.empty() ? "LOCAL" : data_name);
}

std::string vti_header_text(const std::string& name, const VolumeGrid& grid,
                            const std::vector<VtiArray>& arrays) {
  const auto& n = grid.dimensions;
  // VTK counts points along an axis in 32 bits.
  constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
  if (std::any_of(n.begin(), n.end(), [](std::uint64_t size) { return size > kMost; })) {
    fail("{}: expected at most {} samples along each axis of a .vti, found {} x {} x {}", name, kMost, n[0],
         n[1], n[2]);
  }
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", n[0] - 1, n[1] - 1, n[2] - 1);
  const auto& [i, j, k] = grid.directions;
  const std::string direction = grid.is_straight()
                                    ? ""
                                    : fmt::format(" Direction=\"{} {} {}\"", numbers({i.x, j.x, k.x}),
                                                  numbers({i.y, j.y, k.y}), numbers({i.z, j.z, k.z}));
  std::string declared;
  std::uint64_t offset = 0;
  for (const VtiArray& array : arrays) {
    const std::string scale =
        array.slope == 1 && array.intercept == 0
            ? ""
            : fmt::format(" slope=\"{}\" intercept=\"{}\"", array.slope, array.intercept);
    declared += fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\"{} format=\"appended\" offset=\"{}\"/>\n",
        stored_name(stored_type(grid.type), TypeNames::kVtk), xml_attribute(array.name), scale, offset);
    offset += sizeof(std::uint64_t) + grid.bytes();
  }
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "  <ImageData WholeExtent=\"{0}\" Origin=\"{1}\" Spacing=\"{2}\"{5}>\n"
      "    <Piece Extent=\"{0}\">\n"
      "      <PointData Scalars=\"{3}\">\n"
      "{4}      </PointData>\n      <CellData/>\n    </Piece>\n  </ImageData>\n"
      "  <AppendedData encoding=\"raw\">\n   _",
      extent, numbers(grid.origin), numbers(grid.spacing), xml_attribute(arrays.front().name), declared,
      direction);
}

std::string vti_count(const VolumeGrid& grid) {
  const std::uint64_t bytes = grid.bytes();
  return {reinterpret_cast<const char*>(&bytes), sizeof(bytes)};
}

std::string nifti_header_bytes(VolumeGrid grid) {
  to_space("RAS", grid);
  return nifti_file_header(grid);
}

}  // namespace adamas::io
