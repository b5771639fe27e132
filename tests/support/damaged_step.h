#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "isosurface/storage/store_file.h"

namespace adamas::test {

using namespace isosurface;

/// Changes a byte in the middle of every page that a store has of a step, copies included. Later steps of the
/// same block that are coded with it are lost too.
inline void damage_step(const std::filesystem::path& path, std::uint32_t step) {
  StoreFile file(path.string());
  std::fstream bytes(path, std::ios::in | std::ios::out | std::ios::binary);
  for (std::uint64_t number = 1; number < std::uint64_t{2} << (3 * file.grid().top()); ++number) {
    const PageId id = file.grid().page(number);
    if (!file.grid().contains(id)) continue;
    const PageEntry entry = file.entry(step, id).value();
    for (const std::uint64_t offset : {entry.offset, entry.copy}) {
      if (offset == 0 || entry.size == 0) continue;
      const auto at = static_cast<std::streamoff>(offset + entry.size / 2);
      bytes.seekg(at);
      const auto byte = static_cast<char>(bytes.get() ^ 0x55);
      bytes.seekp(at);
      bytes.put(byte);
    }
  }
}

}  // namespace adamas::test
