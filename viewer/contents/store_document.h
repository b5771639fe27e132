#pragma once

#include <memory>
#include <string>

#include "viewer/contents/document.h"

namespace adamas::viewer {

/// Opens a store. The document shows the surfaces of its isovalues, which a thread refines for the viewpoint.
/// Throws Error if the file is no store, or if its tables are damaged.
std::unique_ptr<Document> open_store_document(const std::string& path, const DocumentOptions& options);

}  // namespace adamas::viewer
