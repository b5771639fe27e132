#pragma once

#include <filesystem>
#include <vector>

#include "core/io/image_header.h"
#include "core/io/xml_file.h"

namespace adamas::io {

/// The names of arrays of text in the field data of a .vti, for what VTK has no words for: units and the
/// space of coordinates, as in VolumeGrid.
inline constexpr const char *kVtiLengthUnit = "length_unit", *kVtiValueUnit = "value_unit",
                            *kVtiSpace = "space";

/// Reads the header of an image file of VTK from its tags (read_xml_tags); sizes of files are not checked.
/// Arrays of texts, and those that mark ghosts, are left out; ImageArray::other_form marks those that only
/// VTK reads. Throws Error with `path` at anything that is no such file.
ImageHeader vti_header(const std::vector<XmlTag>& tags, const std::filesystem::path& path);

}  // namespace adamas::io
