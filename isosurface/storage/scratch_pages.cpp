#include "isosurface/storage/scratch_pages.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/base/error.h"
#include "core/base/unnamed_file.h"

namespace adamas {

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

int scratch_file(const std::filesystem::path& folder) {
  const int file = open_unnamed_file(folder);
  if (file < 0)
    fail("{}: expected a folder for scratch data, found: {}", folder.string(), std::strerror(errno));
  return file;
}

}  // namespace

template <class Word>
ScratchPages<Word>::ScratchPages(const std::filesystem::path& folder, const PageGrid& grid,
                                 std::size_t memory, PageParts parts)
    : PageCache<Word>(grid, memory), parts_(parts), folder_(folder), file_(scratch_file(folder)) {
  for (int lod = 0; lod <= grid.top(); ++lod) {
    const LatticePoint n = grid.blocks(lod);
    offsets_.emplace_back(static_cast<std::size_t>(n.i) * static_cast<std::size_t>(n.j) *
                          static_cast<std::size_t>(n.k));
  }
}

template <class Word>
ScratchPages<Word>::~ScratchPages() {
  close(file_);
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
  for (std::size_t done = 0; done < buffer_.size();) {
    const ssize_t put =
        pwrite(file_, buffer_.data() + done, buffer_.size() - done, static_cast<off_t>(size_));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0)
      fail("{}: cannot hold {} bytes of scratch data: {}", folder_.string(), size_ + buffer_.size(),
           std::strerror(errno));
    done += static_cast<std::size_t>(put);
    size_ += static_cast<std::uint64_t>(put);
  }
}

template <class Word>
bool ScratchPages<Word>::load(const PageToLoad<Word>& page) {
  std::size_t points = 0;
  for_each_own_row(page.shape, [&](std::size_t, std::size_t count, std::size_t) { points += count; });
  // Samples come first.
  const std::size_t sample_bytes = points * sizeof(Word);
  const std::size_t begin = has_part(page.parts, PageParts::kSamples) ? 0 : sample_bytes;
  const std::size_t end = page.bounds == nullptr ? sample_bytes : points * point_bytes();
  buffer_.resize(end - begin);
  for (std::size_t done = 0; done < buffer_.size();) {
    const ssize_t got = pread(file_, buffer_.data() + done, buffer_.size() - done,
                              static_cast<off_t>(offset(page.id) + begin + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail("{}: scratch data cannot be read: {}", folder_.string(), std::strerror(errno));
    done += static_cast<std::size_t>(got);
  }
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

template class ScratchPages<std::uint8_t>;
template class ScratchPages<std::uint16_t>;
template class ScratchPages<std::uint32_t>;

}  // namespace adamas
