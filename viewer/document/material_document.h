#pragma once

#include <memory>
#include <string>

#include "viewer/document/document.h"

namespace adamas::viewer {

/// A resampled mesh, a saved hierarchy or interfaces: materials, their fields, and a plane's cross section,
/// which is worked out in a thread of its own. Throws Error for another file.
std::unique_ptr<Document> open_material_document(const std::string& path, Progress& progress);

}  // namespace adamas::viewer
