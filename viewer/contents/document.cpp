#include "viewer/contents/document.h"

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "viewer/contents/material_contents.h"

namespace adamas::viewer {

using namespace io;

std::unique_ptr<Document> open_document(const std::string& path, const DocumentOptions& options,
                                        Progress& progress) {
  if (file_extension(path) == ".adm") return open_store_document(path, options);
  check_input_file(path);
  if (MaterialContents::can_open(path)) return open_material_document(path, progress);
  fail(
      "{}: expected a store (.adm), a resampled mesh (.vtu), a saved hierarchy (.h5) or interfaces (.vtp, "
      ".ply, "
      ".arec, .txt), found another file; adamas store makes a store of a volume",
      path);
}

}  // namespace adamas::viewer
