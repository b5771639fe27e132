#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "adamas/progress.h"
#include "core/io/file_handle.h"
#include "core/io/volume_reader.h"
#include "core/io/volume_unpacking.h"

namespace adamas::io {

/// The number of bytes that are read together.
inline constexpr std::size_t kWholePiece = std::size_t{1} << 20;

/// Makes numbers of stored bytes that arrive in pieces.
template <class Number, class Take>
class NumberPieces {
 public:
  NumberPieces(bool turned, Take take) : turned_(turned), take_(std::move(take)) {}

  void put(std::span<const std::byte> bytes) {
    const std::size_t before = rest_.size(), count = (before + bytes.size()) / sizeof(Number),
                      whole = count * sizeof(Number);
    rest_.insert(rest_.end(), bytes.begin(), bytes.end());
    numbers_.resize(count);
    if (count > 0) std::memcpy(numbers_.data(), rest_.data(), whole);
    rest_.erase(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(whole));
    if (turned_) turn();
    take_(std::span<const Number>(numbers_));
  }

 private:
  void turn() {
    const std::span<std::byte> bytes = std::as_writable_bytes(std::span(numbers_));
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(Number)) {
      const std::span<std::byte> number = bytes.subspan(at, sizeof(Number));
      std::reverse(number.begin(), number.end());
    }
  }

  bool turned_;
  Take take_;
  std::vector<std::byte> rest_;  ///< bytes of a number that is not complete
  std::vector<Number> numbers_;
};

/// Calls take(std::span<const Number>) with all numbers of a source, stored as Number, in pieces and in the
/// order of the file; packed ones are unpacked piece by piece. Returns the remark on the file, if there is
/// one. Throws Error as VolumeReader and unpack_volume do, and what `take` throws.
template <class Number, class Take>
std::string for_each_piece(const VolumeSource& source, const Take& take) {
  if (source.packed()) {
    // Numbers in text come in this machine's byte order.
    const bool turned = source.big_endian && source.coding != SamplePacking::kText;
    NumberPieces<Number, Take> pieces(turned, take);
    return unpack_pieces(
               source, [&pieces](std::span<const std::byte> bytes) { pieces.put(bytes); },
               SilentProgress::instance())
        .remark;
  }
  VolumeReader reader(source);
  std::vector<Number> piece;
  for (std::uint64_t first = 0; first < source.values(); first += piece.size()) {
    piece.resize(std::min<std::uint64_t>(kWholePiece / sizeof(Number), source.values() - first));
    reader.read_stored(first, std::as_writable_bytes(std::span(piece)));
    take(std::span<const Number>(piece));
  }
  return reader.source().remark;
}

/// Opens a source to read its numbers in any order; packed ones are unpacked into memory first.
inline VolumeReader open_in_memory(VolumeSource source) {
  if (source.packed()) source = unpack_into(FileHandle::in_memory(), source, SilentProgress::instance());
  return VolumeReader(std::move(source));
}

/// Calls visit(Number()) with the type of the stored numbers where it is one of whole numbers that all are
/// values of std::int64_t. Returns whether it is.
template <class Visit>
bool visit_whole_type(StoredType type, const Visit& visit) {
  bool whole = false;
  visit_stored_type(type, [&]<class Stored>(Stored number) {
    if constexpr (std::is_integral_v<Stored> && !std::is_same_v<Stored, std::uint64_t>) {
      whole = true;
      visit(number);
    }
  });
  return whole;
}

}  // namespace adamas::io
