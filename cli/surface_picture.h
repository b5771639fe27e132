#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/picture_options.h"
#include "core/data/interface_mesh.h"
#include "core/geometry/vec3.h"

namespace adamas {

/// The options of a picture of interfaces: the camera, and which of them it shows.
struct SurfacePictureOptions {
  PictureOptions camera;
  /// "A|B": the interface between two materials; "A": all interfaces of a material. Empty: all.
  std::vector<std::string> shown;
  bool triangle_edges = false;

  /// Throws UsageError for values that say nothing, and for options of a picture that is not wanted.
  void check() const;
  /// Throws Error, in the name of the source, for materials that are not among these.
  void check_materials(const IdVector<MaterialId, std::string>& materials, const std::string& source) const;
};

/// Without `own_file` the program chooses the files.
void add_surface_picture_options(const Command& command, SurfacePictureOptions& options,
                                 bool own_file = true);

/// Draws interfaces in their domain. Each side of an interface has the colour of the material that lies
/// behind it, as one sees it: so colours depend on materials alone.
void write_surface_picture(const std::filesystem::path& path, const InterfaceMesh& mesh, const Box3& domain,
                           const SurfacePictureOptions& options = {});

}  // namespace adamas
