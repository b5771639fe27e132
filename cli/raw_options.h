#pragma once

#include <optional>
#include <string>

#include "cli/command.h"
#include "core/io/volume_reader.h"

namespace adamas::cli {

/// The options that say what files of bare samples hold.
struct RawOptions {
  std::string dimensions, type, spacing, origin, endian, header_bytes;

  /// The first of them that is given, for messages; empty where there is none.
  [[nodiscard]] std::string option() const;
};

/// `origin`: the names of that for the first sample; `of`: what spacing and places are of.
void add_raw_options(const Command& command, RawOptions& options, const char* origin, const char* of);

/// Nothing where no dimensions are given. Throws Error (kUsage) where options do not go together.
std::optional<RawVolume> raw_volume(const RawOptions& options);

/// 1, 1, 1 where none is given.
Vec3 raw_spacing(const RawOptions& options);
Vec3 raw_origin(const RawOptions& options);

}  // namespace adamas::cli
