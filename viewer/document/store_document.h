#pragma once

#include <memory>
#include <string>

#include "viewer/document/document.h"

namespace adamas::viewer {

/// A store: the surfaces of its isovalues, refined for the viewpoint in a thread of its own. Throws Error
/// where the file is no store, or damaged in what says where things lie.
std::unique_ptr<Document> open_store_document(const std::string& path, const DocumentOptions& options);

}  // namespace adamas::viewer
