#include "core/base/digest_numbers.h"

#include "core/base/parallel.h"

namespace adamas::inline core {

namespace {

/// Fewer digests than this are numbered one after another.
constexpr std::size_t kFew = 4096;
constexpr std::size_t kChunk = 16384;
constexpr std::uint32_t kNone = 0xffffffffu;

}  // namespace

DigestNumbers::Added DigestNumbers::add(std::span<const Digest> digests) {
  Added added;
  added.numbers.resize(digests.size());
  if (digests.size() < kFew) {
    add_in_order(digests, added);
  } else {
    add_in_parallel(digests, added);
  }
  size_ += added.firsts.size();
  return added;
}

void DigestNumbers::add_in_order(std::span<const Digest> digests, Added& added) {
  for (std::uint32_t i = 0; i < digests.size(); ++i) {
    const auto next = static_cast<std::uint32_t>(size_ + added.firsts.size());
    const auto [number, fresh] = tables_[part(digests[i])].try_add(digests[i], next);
    added.numbers[i] = number;
    if (fresh) added.firsts.push_back(i);
  }
}

/// The digests are sorted by part, in their order. In each part, a new digest is first numbered by the place
/// where it comes first, then by its rank among these places.
void DigestNumbers::add_in_parallel(std::span<const Digest> digests, Added& added) {
  const std::size_t count = digests.size();
  std::vector<std::array<std::uint32_t, kParts>> places((count + kChunk - 1) / kChunk);
  parallel_chunks(count, kChunk, [&](std::size_t begin, std::size_t end) {
    auto& counts = places[begin / kChunk];
    counts.fill(0);
    for (std::size_t i = begin; i < end; ++i) ++counts[part(digests[i])];
  });
  std::array<std::uint32_t, kParts + 1> ends{};
  std::uint32_t total = 0;
  for (std::size_t p = 0; p < kParts; ++p) {
    for (auto& of_chunk : places) total += std::exchange(of_chunk[p], total);
    ends[p + 1] = total;
  }
  std::vector<std::uint32_t> order(count);
  parallel_chunks(count, kChunk, [&](std::size_t begin, std::size_t end) {
    auto& next = places[begin / kChunk];
    for (std::size_t i = begin; i < end; ++i) order[next[part(digests[i])]++] = static_cast<std::uint32_t>(i);
  });

  std::vector<std::uint32_t>& numbers = added.numbers;
  const auto known = static_cast<std::uint32_t>(size_);
  parallel_for(kParts, 1, [&](std::size_t p) {
    for (std::uint32_t k = ends[p]; k < ends[p + 1]; ++k)
      numbers[order[k]] = tables_[p].try_add(digests[order[k]], known + order[k]).first;
  });
  added.firsts =
      parallel_collect<std::uint32_t>(count, kChunk, [&](std::size_t begin, std::size_t end, auto& list) {
        for (std::size_t i = begin; i < end; ++i) {
          if (numbers[i] == known + i) list.push_back(static_cast<std::uint32_t>(i));
        }
      });
  std::vector<std::uint32_t> ranks(count, kNone);
  for (std::uint32_t k = 0; k < added.firsts.size(); ++k) ranks[added.firsts[k]] = known + k;
  parallel_for(kParts, 1, [&](std::size_t p) {
    for (std::uint32_t k = ends[p]; k < ends[p + 1]; ++k) {
      const std::uint32_t i = order[k];
      if (ranks[i] != kNone) tables_[p].set(digests[i], ranks[i]);
    }
  });
  parallel_for(count, kChunk, [&](std::size_t i) {
    if (numbers[i] >= known) numbers[i] = ranks[numbers[i] - known];
  });
}

std::vector<Digest> DigestNumbers::digests() const {
  std::vector<Digest> result(size_);
  for (const DigestTable& table : tables_)
    table.for_each([&](const Digest& digest, std::uint32_t number) { result[number] = digest; });
  return result;
}

}  // namespace adamas::inline core
