#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>

#include "adamas/progress.h"
#include "isosurface/storage/restore.h"

namespace adamas::test {

/// Gives the planes of a part of a store's first step, in ascending order of k, to `sink`. `memory` is the
/// number of bytes that decoded pages may take. Throws DamagedPage.
inline PageReads restore(isosurface::StoreFile& file, const isosurface::RestoredPart& part,
                         std::size_t memory, const std::function<void(std::span<const std::byte>)>& sink) {
  using namespace isosurface;
  return with_sample_type(part.grid.type, [&](auto sample) {
    using Sample = decltype(sample);
    using Word = OrderedWord<Sample>;
    StoredPages<Word> pages(file, 0, std::min(memory, restored_page_bytes<Word>(file.grid(), part)));
    SlabRestorer<Sample> restorer(pages, part);
    restore_slabs(std::span(&restorer, 1), part, SilentProgress::instance(),
                  [&](const SlabRestorer<Sample>&, std::span<const std::byte> plane) { sink(plane); });
    return pages.counts();
  });
}

}  // namespace adamas::test
