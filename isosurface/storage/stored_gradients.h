#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/geometry/vec3.h"
#include "isosurface/compression/gradient_codec.h"
#include "isosurface/storage/page_cache.h"
#include "isosurface/storage/store_file.h"

namespace adamas {

/// The directions of gradients that one step of a store keeps, page by page as they are asked for.
class StoredGradients {
 public:
  /// `memory`: bytes that decoded pages may take. Throws Error where the store has no gradients or their
  /// tables are damaged. The file must outlive this.
  StoredGradients(StoreFile& file, std::uint32_t step, std::size_t memory);

  /// The page, with OctahedralCodes as samples, the first byte lowest; null where it is damaged or predicted
  /// from one that is. Valid until the next call.
  const PageSamples<std::uint16_t>* page(const PageId& id) { return tree_.samples(id); }
  /// At a point, whose coordinates count samples and are not negative: a unit vector, or zero where nothing
  /// changes. Beyond the data it is that of the nearest sample. Nothing where the page cannot be had.
  std::optional<Vec3> direction(LatticePoint p);
  /// The damaged page for which a page could not be had, when that was last so.
  [[nodiscard]] const PageId& last_damaged() const { return last_damaged_; }

 private:
  bool load(const PageId& id, const PageShape& shape, const GradientCodesAround& around,
            GradientCodes& codes);

  StoreFile& file_;
  std::uint32_t step_;
  GradientCodec codec_;
  PageCache<std::uint16_t> tree_;
  PageId last_damaged_;
};

}  // namespace adamas
