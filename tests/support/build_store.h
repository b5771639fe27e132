#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "adamas/progress.h"
#include "isosurface/storage/block_builder.h"
#include "isosurface/storage/store_file_writer.h"

namespace adamas::test {

/// Makes a store of one step of a volume by a BlockBuilder alone. Messages name `shown`.
inline isosurface::StoreFigures build_store(const std::filesystem::path& path, const std::string& shown,
                                            const VolumeGrid& grid, const isosurface::PlaneSource& planes,
                                            const isosurface::StoreOptions& options) {
  using namespace isosurface;
  StoreFigures figures;
  StoreFileWriter writer(path, shown, grid, options.group_pages);
  const BlockSource source{0, {0}, [&planes](std::uint32_t) { return planes; }};
  with_sample_type(grid.type, [&](auto sample) {
    const auto builder =
        std::make_unique<BlockBuilder<decltype(sample)>>(grid, options, SilentProgress::instance());
    builder->build(writer, source, figures);
  });
  return figures;
}

}  // namespace adamas::test
