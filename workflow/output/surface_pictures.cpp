#include "workflow/output/surface_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "adamas/turning_picture.h"
#include "core/picture/picture_api.h"
#include "core/picture/picture_file.h"
#include "interfaces/api/adaptive_mesh.h"
#include "interfaces/cross_section/field_choice.h"
#include "interfaces/probe/probe.h"

namespace adamas::workflow {

using namespace interfaces;
using namespace picture;

namespace {

constexpr double kMostPoints = 72;

std::vector<Vec3> points_of(const PictureBlock& block) {
  std::vector<Vec3> points;
  const auto place = [&](int axis, std::size_t n) {
    const double part =
        static_cast<double>(n) / static_cast<double>(block.counts[static_cast<std::size_t>(axis)] - 1);
    return (1 - part) * block.box.min[axis] + part * block.box.max[axis];
  };
  for (std::size_t k = 0; k < block.counts[2]; ++k) {
    for (std::size_t j = 0; j < block.counts[1]; ++j) {
      for (std::size_t i = 0; i < block.counts[0]; ++i)
        points.push_back({place(0, i), place(1, j), place(2, k)});
    }
  }
  return points;
}

PictureBlock::Field field_of(const FieldInfo& info, const std::vector<PointSample>& samples) {
  const FieldChoice choice{0, std::nullopt};
  PictureBlock::Field field;
  field.name = info.unit.empty() ? info.name : info.name + " [" + info.unit + "]";
  std::vector<double> values;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const PointSample& sample : samples) {
    const std::span<const double> all(sample.values);
    const double value =
        sample.inside() ? choice.scalar(all.subspan(info.offset, static_cast<std::size_t>(info.components)))
                        : std::nan("");
    values.push_back(value);
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(low <= high)) low = high = 0;
  field.low = low;
  field.high = high;
  constexpr double kParts = PictureBlock::kNothing - 1;
  const double width = high > low ? high - low : 1;
  for (const double value : values)
    field.parts.push_back(std::isfinite(value)
                              ? static_cast<std::uint8_t>(std::lround((value - low) / width * kParts))
                              : PictureBlock::kNothing);
  return field;
}

}  // namespace

bool turns(const std::filesystem::path& path) { return lower_extension(path) == ".html"; }

PictureBlock picture_block(const ResampledMesh& mesh, const DrawingOptions& options) {
  PictureBlock block;
  block.box = mesh.box;
  const Vec3 size = mesh.box.size();
  const double spacing = std::max({size.x, size.y, size.z}) / (kMostPoints - 1);
  for (int axis = 0; axis < 3; ++axis)
    block.counts[static_cast<std::size_t>(axis)] =
        std::max<std::size_t>(2, static_cast<std::size_t>(size[axis] / spacing) + 1);
  for (MaterialId m(0); m.value < mesh.materials.size(); ++m.value)
    block.materials.push_back({mesh.materials[m], colour_of(options.colours, mesh.materials[m], m.value)});
  const std::vector<PointSample> samples = probe(mesh, points_of(block));
  for (const PointSample& sample : samples)
    block.numbers.push_back(sample.inside() && sample.material < PictureBlock::kNothing
                                ? static_cast<std::uint8_t>(sample.material)
                                : PictureBlock::kNothing);
  for (const FieldInfo& info : mesh.fields) block.fields.push_back(field_of(info, samples));
  return block;
}

void write_surface_picture(const std::filesystem::path& path, const InterfaceMesh& mesh, const Box3& domain,
                           DrawingOptions options, std::optional<PictureBlock> block) {
  options.domain = domain;
  InterfacePicture drawn = interface_picture(to_interface_triangles(InterfaceMesh(mesh)), options);
  drawn.block = std::move(block);
  write_interfaces(drawn, path, surface_drawing(options));
}

}  // namespace adamas::workflow

namespace adamas {

void write_picture(const std::filesystem::path& path, const InterfaceTriangles& interfaces,
                   const AdaptiveMesh& mesh, const DrawingOptions& options) {
  picture::InterfacePicture drawn = picture::interface_picture(interfaces, options);
  if (workflow::turns(path)) drawn.block = workflow::picture_block(mesh.contents().mesh(), options);
  picture::write_interfaces(drawn, path, picture::surface_drawing(options));
}

}  // namespace adamas
