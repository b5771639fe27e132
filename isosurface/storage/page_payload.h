#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "isosurface/storage/store_format.h"

namespace adamas::isosurface {

/// The parts of a page's bytes in a store. The samples carry the first bytes of the bounds along.
struct PagePayload {
  std::span<const std::byte> samples, bounds, gradients;
  std::size_t along = 0;  ///< number of these bytes; `bounds` has the others

  /// Returns whether the bounds are those that the page has at the step before, and have no bytes.
  [[nodiscard]] bool has_earlier_bounds() const { return along + bounds.size() == 0; }

  /// Returns all bytes of the bounds: those that the decoded samples carried along, and `bounds`; none where
  /// the samples carried another number of bytes.
  [[nodiscard]] std::optional<std::vector<std::byte>> all_bounds(const BytesAlong& carried) const;
};

std::vector<std::byte> join_payload(const PagePayload& parts);
/// Splits bytes of join_payload(). Returns false where they do not consist of three parts.
[[nodiscard]] bool split_payload(std::span<const std::byte> bytes, SampleCoding coding, PagePayload& parts);

/// Returns the bytes of a plain page: its samples are as predicted, its errors 0, its ranges as predicted,
/// and it has no gradients. Plain pages are not in the file.
std::span<const std::byte> plain_payload();
bool is_plain(std::span<const std::byte> payload, const PageSummary& summary);

}  // namespace adamas::isosurface
