#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <mutex>
#include <span>
#include <vector>

namespace adamas::isosurface {

/// How much is read at a time of a series: beside the bytes of a page at a step those of its group at the
/// steps that follow, which lie behind them (stretch_to_read).
struct ReadAhead {
  std::uint64_t bytes = 0;   ///< of one read, a quarter more or less; 0: what is asked for alone
  bool is_backward = false;  ///< the steps before are read instead
  std::size_t memory = 0;    ///< for what was read and not asked for yet
  [[nodiscard]] bool is_on() const { return bytes > 0; }
  /// How long a read at a place is: slightly different each time, so that not all pages are read in the same
  /// frame when a series is played.
  [[nodiscard]] std::uint64_t length(std::uint64_t offset) const;
};

/// Stretches of a file's bytes in memory, which several threads may share. The ones that were used least
/// recently leave when it is full.
class PageRuns {
 public:
  /// Whether some bytes of the file are all in memory.
  [[nodiscard]] bool has(std::uint64_t offset, std::uint64_t size) const;
  /// Copies them. Returns false where they are not.
  bool copy(std::uint64_t offset, std::span<std::byte> to);
  /// Takes what was read at a place. `memory`: bytes that all may take.
  void put(std::uint64_t offset, std::span<const std::byte> bytes, std::size_t memory);

 private:
  struct Run {
    std::uint64_t offset = 0;
    std::vector<std::byte> bytes;
  };

  [[nodiscard]] std::list<Run>::const_iterator find(std::uint64_t offset, std::uint64_t size) const;

  mutable std::mutex mutex_;
  std::list<Run> runs_;  ///< those used least recently first
  std::map<std::uint64_t, std::list<Run>::iterator> by_offset_;
  std::size_t taken_ = 0;
};

}  // namespace adamas::isosurface
