#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "adamas/volume.h"
#include "core/geometry/vec3.h"

namespace adamas::io {

// The text or bytes that go before the samples of a volume in files of some formats, and after them.

/// `data_name`: the file of the samples, empty where they follow.
std::string nrrd_header_text(const VolumeGrid& grid, const std::string& data_name);
std::string meta_image_header_text(VolumeGrid grid, const std::string& data_name);
/// An array of a .vti: its values are slope * sample + intercept, which attributes of it say where they are
/// other numbers than the samples.
struct VtiArray {
  std::string name;
  double slope = 1, intercept = 0;
};
/// Before each array's samples, which follow, vti_count() has to go. Throws Error with `name` where there are
/// too many along an axis.
std::string vti_header_text(const std::string& name, const VolumeGrid& grid,
                            const std::vector<VtiArray>& arrays);
std::string vti_count(const VolumeGrid& grid);
inline constexpr const char* kVtiEnd = "\n  </AppendedData>\n</VTKFile>\n";
std::string nifti_header_bytes(VolumeGrid grid);

}  // namespace adamas::io
