#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/io/volume_reader.h"

namespace adamas::io {

/// Opens a volume of pictures, TIFF or PNG, one plane each in the order given, or of the pages of one TIFF.
/// They are unpacked first, as open_volume does it. Throws Error, with the file's name, if one cannot be
/// read, is no gray picture or differs in size or type from the first.
VolumeReader open_volume_stack(const std::vector<std::filesystem::path>& paths,
                               const Vec3& spacing = {1, 1, 1}, const Vec3& origin = {},
                               const VolumeOptions& options = {},
                               Progress& progress = SilentProgress::instance());

/// The files of a folder whose names fit a pattern, in natural order (9 before 10). In the file's name '*'
/// stands for any characters, '?' for one, a run of '#' for a number of at least as many digits, and '%d' or
/// '%04d' for a number as printf writes it, of up to 20 digits. Throws Error with the pattern if no file fits
/// or it contains no placeholder, and with the first missing file if numbers have gaps, which is checked if
/// the pattern has one number and no '*' or '?'.
std::vector<std::filesystem::path> match_stack(const std::filesystem::path& pattern);

/// The name that a pattern with one number and no other placeholder has for a number. Empty for other
/// patterns, and if the number is to have more than 20 digits.
std::string numbered_name(const std::string& pattern, std::size_t number);

/// Whether text `a` comes before `b` when runs of digits are compared as numbers.
bool natural_less(const std::string& a, const std::string& b);

}  // namespace adamas::io
