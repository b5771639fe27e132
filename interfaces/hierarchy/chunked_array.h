#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <vector>

namespace adamas::interfaces {

/// An array that grows in chunks: elements are made in place and never move, so references stay valid. An
/// empty type takes no memory.
template <class T>
class ChunkedArray {
 public:
  T& operator[](std::size_t i) {
    if constexpr (kIsEmpty)
      return nothing_;
    else
      return (*chunks_[i / kChunk])[i % kChunk];
  }
  const T& operator[](std::size_t i) const {
    if constexpr (kIsEmpty)
      return nothing_;
    else
      return (*chunks_[i / kChunk])[i % kChunk];
  }

  /// Makes room for the indices below `count`; new elements are value-initialised.
  void grow(std::size_t count) {
    if constexpr (!kIsEmpty) {
      while (chunks_.size() * kChunk < count) chunks_.push_back(std::make_unique<Chunk>());
    }
  }
  [[nodiscard]] std::size_t bytes() const {
    return chunks_.size() * sizeof(Chunk) + chunks_.capacity() * sizeof(chunks_[0]);
  }

 private:
  static constexpr bool kIsEmpty = std::is_empty_v<T>;
  static constexpr std::size_t kChunk = 1024;
  using Chunk = std::array<T, kChunk>;

  std::vector<std::unique_ptr<Chunk>> chunks_;
  [[no_unique_address]] std::conditional_t<kIsEmpty, T, std::array<T, 0>> nothing_{};
};

}  // namespace adamas::interfaces
