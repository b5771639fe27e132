#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/io/file_handle.h"

namespace adamas::io {

/// A file in a zip archive.
struct ZipMember {
  std::string name;
  std::uint64_t begin = 0;     ///< where its bytes begin in the archive
  std::uint64_t packed = 0;    ///< the number of its bytes there
  std::uint64_t size = 0;      ///< the number of its bytes when they are unpacked
  std::uint32_t checksum = 0;  ///< the CRC-32 of these
  bool deflated = false;  ///< whether they are one deflate stream without a header; else they are as they are
  bool is_readable = true;  ///< whether they are neither encrypted nor compressed in another way
};

/// Lists the files of a zip archive (APPNOTE 6.3), also of one of more than 4 GiB, in the order of its
/// directory. Their bytes lie within the archive; whether they have their checksums is not looked at. Throws
/// Error with the file's name if it has no whole directory, or one that leads elsewhere.
std::vector<ZipMember> list_zip_archive(const FileHandle& file);

}  // namespace adamas::io
