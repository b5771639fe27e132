#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <mutex>
#include <span>
#include <vector>

namespace adamas::isosurface {

/// Stretches of a file's bytes in memory, which several threads may share. The least recently used ones leave
/// when the memory is full.
class PageRuns {
 public:
  /// Returns whether some bytes of the file are all in memory.
  [[nodiscard]] bool has(std::uint64_t offset, std::uint64_t size) const;
  /// Copies bytes of the file. Returns false where they are not all in memory.
  bool copy(std::uint64_t offset, std::span<std::byte> to);
  /// Adds bytes that were read at an offset. `memory`: the number of bytes that all stretches may take.
  void put(std::uint64_t offset, std::span<const std::byte> bytes, std::size_t memory);

 private:
  struct Run {
    std::uint64_t offset = 0;
    std::vector<std::byte> bytes;
  };

  [[nodiscard]] std::list<Run>::const_iterator find(std::uint64_t offset, std::uint64_t size) const;

  mutable std::mutex mutex_;
  std::list<Run> runs_;  ///< the least recently used ones are first
  std::map<std::uint64_t, std::list<Run>::iterator> by_offset_;
  std::size_t taken_ = 0;
};

}  // namespace adamas::isosurface
