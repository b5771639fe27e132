#pragma once

#include <filesystem>
#include <string_view>

#include "core/io/image_header.h"

namespace adamas::io {

/// Reads the header at the beginning of an MRC or CCP4 file (MRC2014: Cheng et al., J. Struct. Biol. 192,
/// 2015), of either byte order, as that of an image; sizes of files are not checked. Coordinates are in the
/// file's units, ångströms. The words MAPC, MAPR and MAPS say along which axis of the cell each axis of the
/// array lies. The first sample is at ORIGIN or, where that is zero, at the indices NXSTART, NYSTART and
/// NZSTART. Volumes of a stack (space groups from 401 on) are times. Throws Error, with the path, at complex
/// numbers and at numbers of 4 bits or of half precision.
ImageHeader mrc_image(std::string_view text, const std::filesystem::path& path);

}  // namespace adamas::io
