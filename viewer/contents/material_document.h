#pragma once

#include <memory>
#include <string>

#include "viewer/contents/document.h"

namespace adamas::viewer {

/// Opens a resampled mesh, a saved hierarchy or interfaces. The document shows materials, their fields, and a
/// plane's cross section, which a thread computes. Throws Error for another file.
std::unique_ptr<Document> open_material_document(const std::string& path, Progress& progress);

}  // namespace adamas::viewer
