#include "isosurface/storage/page_payload.h"

#include <algorithm>
#include <array>

#include "isosurface/compression/byte_stream.h"

namespace adamas::isosurface {

std::vector<std::byte> join_payload(const PagePayload& parts) {
  std::vector<std::byte> bytes;
  bytes.reserve(parts.samples.size() + parts.bounds.size() + parts.gradients.size() + 8);
  ByteWriter out(bytes);
  out.sized_bytes(parts.samples);
  out.varint(parts.along + parts.bounds.size());
  out.bytes(parts.bounds);
  out.bytes(parts.gradients);
  return bytes;
}

std::span<const std::byte> plain_payload() {
  static const std::vector<std::byte> kBytes = [] {
    const std::array smooth{std::byte{1}}, bounds{std::byte{4}};
    return join_payload({smooth, bounds, {}, 0});
  }();
  return kBytes;
}

bool is_plain(std::span<const std::byte> payload, const PageSummary& summary) {
  return summary.error == 0 && std::ranges::equal(payload, plain_payload());
}

std::optional<std::vector<std::byte>> PagePayload::all_bounds(const BytesAlong& carried) const {
  const auto end = carried.begin() + static_cast<std::ptrdiff_t>(along);
  if (std::any_of(end, carried.end(), [](std::byte byte) { return byte != std::byte{0}; })) return {};
  std::vector<std::byte> all(carried.begin(), end);
  all.insert(all.end(), bounds.begin(), bounds.end());
  return all;
}

bool split_payload(std::span<const std::byte> bytes, SampleCoding coding, PagePayload& parts) {
  ByteReader in(bytes);
  parts.samples = in.sized_bytes();
  const std::uint64_t size = in.varint();
  parts.along = parts.samples.empty() ? 0 : carried_along(coding, parts.samples[0], size);
  parts.bounds = in.bytes(size - parts.along);
  parts.gradients = in.rest();
  return in.good();
}

}  // namespace adamas::isosurface
