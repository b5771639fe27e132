#include "isosurface/storage/stored_gradients.h"

#include <algorithm>

#include "core/base/error.h"
#include "isosurface/gradients/direction_code.h"
#include "isosurface/storage/stored_pages.h"

namespace adamas {

namespace {

GradientCodec codec_of(const StoreFile& file) {
  const StoreHeader& header = file.header();
  if (!header.gradients) fail("{}: expected gradients, found none", file.name());
  return GradientCodec::parse(coding_of_bytes(header.coding), header.gradient_tables, file.name());
}

}  // namespace

StoredGradients::StoredGradients(StoreFile& file, std::uint32_t step, std::size_t memory)
    : file_(file),
      step_(step),
      codec_(codec_of(file)),
      tree_(file.grid(), memory,
            [this](const PageId& id, const PageShape& shape, const Surroundings<std::uint16_t>& around,
                   PageParts, PageSamples<std::uint16_t>& page,
                   PageBounds<std::uint16_t>*) { return load(id, shape, around.samples, page.samples); }) {}

bool StoredGradients::load(const PageId& id, const PageShape& shape, const GradientCodesAround& around,
                           GradientCodes& codes) {
  const StoreFile::Payload payload = file_.read(step_, id);
  PagePayload parts;
  if (payload.state != PageState::kDamaged && split_payload(payload.bytes, parts) &&
      codec_.decode(parts.gradients, shape, around, codes))
    return true;
  last_damaged_ = id;
  return false;
}

std::optional<Vec3> StoredGradients::direction(LatticePoint p) {
  const PageGrid& grid = tree_.grid();
  // Not all points beyond the data are among those that pages have.
  for (int axis = 0; axis < 3; ++axis) p[axis] = std::min(p[axis], grid.last()[axis]);
  const PageId id = grid.page(p);
  const PageSamples<std::uint16_t>* found = tree_.samples(id);
  if (found == nullptr) return {};
  const unsigned code = found->samples[PageGrid::place(p, id.lod)];
  return decode_direction(DirectionCode::kOctahedral,
                          {static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(code >> 8), 0});
}

}  // namespace adamas
