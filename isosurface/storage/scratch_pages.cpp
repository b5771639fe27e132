#include "isosurface/storage/scratch_pages.h"

#include <cstring>

#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

namespace {

/// Calls fn(first place, number of places, step) for the rows of a page's own points.
template <class Fn>
void for_each_own_row(const PageShape& shape, Fn&& fn) {
  for (std::int32_t k = 0; k < shape.count.k; ++k) {
    for (std::int32_t j = 0; j < shape.count.j; ++j) {
      const bool all = shape.complete || ((j | k) & 1) != 0;
      const std::size_t row = PageGrid::place({0, j, k}, 0);
      const auto count = static_cast<std::size_t>(shape.count.i);
      if (all) {
        fn(row, count, std::size_t{1});
      } else {
        fn(row + 1, count / 2, std::size_t{2});
      }
    }
  }
}

}  // namespace

template <class Word>
ScratchPages<Word>::ScratchPages(const std::filesystem::path& folder, const PageGrid& grid,
                                 std::size_t memory, PageParts parts)
    : PageCache<Word>(grid, memory), parts_(parts), file_(folder) {
  for (int lod = 0; lod <= grid.top(); ++lod) {
    const LatticePoint n = grid.blocks(lod);
    offsets_.emplace_back(static_cast<std::size_t>(n.i) * static_cast<std::size_t>(n.j) *
                          static_cast<std::size_t>(n.k));
  }
}

template <class Word>
std::uint64_t& ScratchPages<Word>::offset(const PageId& id) {
  const LatticePoint n = this->grid().blocks(id.lod), b = id.block;
  const auto at = [](std::int32_t x) { return static_cast<std::size_t>(x); };
  return offsets_[at(id.lod)][at(b.i) + at(n.i) * (at(b.j) + at(n.j) * at(b.k))];
}

template <class Word>
void ScratchPages<Word>::put(const PageId& id, const Page<Word>& page) {
  const PageShape shape = page_shape(this->grid(), id);
  buffer_.clear();
  const auto append = [&](const auto& numbers) {
    for_each_own_row(shape, [&](std::size_t first, std::size_t count, std::size_t step) {
      for (std::size_t n = 0; n < count; ++n) {
        const auto value = numbers[first + n * step];
        const auto* bytes = reinterpret_cast<const std::byte*>(&value);
        buffer_.insert(buffer_.end(), bytes, bytes + sizeof(value));
      }
    });
  };
  append(page.samples);
  if (has_part(parts_, PageParts::kBounds)) {
    append(page.low);
    append(page.high);
    append(page.errors);
  }
  offset(id) = size_;
  file_.write(size_, buffer_);
  size_ += buffer_.size();
}

template <class Word>
bool ScratchPages<Word>::load(const PageToLoad<Word>& page) {
  std::size_t points = 0;
  for_each_own_row(page.shape, [&](std::size_t, std::size_t count, std::size_t) { points += count; });
  // Samples come first in the file.
  const std::size_t sample_bytes = points * sizeof(Word);
  const std::size_t begin = has_part(page.parts, PageParts::kSamples) ? 0 : sample_bytes;
  const std::size_t end = page.bounds == nullptr ? sample_bytes : points * point_bytes();
  buffer_.resize(end - begin);
  file_.read(offset(page.id) + begin, buffer_);
  const std::byte* from = buffer_.data();
  const auto take = [&](auto& numbers) {
    for_each_own_row(page.shape, [&](std::size_t first, std::size_t count, std::size_t step) {
      for (std::size_t n = 0; n < count; ++n) {
        auto& value = numbers[first + n * step];
        std::memcpy(&value, from, sizeof(value));
        from += sizeof(value);
      }
    });
  };
  if (has_part(page.parts, PageParts::kSamples)) take(page.samples.samples);
  if (page.bounds == nullptr) return true;
  take(page.bounds->low);
  take(page.bounds->high);
  take(page.bounds->errors);
  return true;
}

ADAMAS_INSTANTIATE_FOR_WORDS(ScratchPages);

}  // namespace adamas::isosurface
