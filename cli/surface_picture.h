#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "cli/command.h"
#include "core/data/interface_mesh.h"
#include "core/picture/interface_picture.h"

namespace adamas::cli {

/// The options of a picture of surfaces in space: its file, and the camera.
struct PictureOptions {
  std::string file;      ///< empty where none is wanted
  bool own_file = true;  ///< whether the option `--picture` names the file
  std::string direction = "-0.62,0.72,-0.42", projection = "perspective", focus, size;

  /// Gives a picture its camera. Throws Error (kUsage).
  void aim(picture::InterfacePicture& picture) const;
  /// Width and height. Throws Error (kUsage).
  [[nodiscard]] picture::InterfacePictureOptions sizes() const;
  /// Throws Error (kUsage) for values that say nothing, and where there is no picture for them.
  void check() const;
};

/// `subject`: what the picture shows, for the help text. Without `own_file` the program chooses the files.
void add_picture_options(const Command& command, PictureOptions& options, const std::string& subject,
                         bool own_file = true);

/// The options of a picture of interfaces: the camera, and which of them it shows.
struct SurfacePictureOptions {
  PictureOptions camera;
  /// "A|B": the interface between two materials; "A": all interfaces of a material. Empty: all.
  std::vector<std::string> shown;
  bool triangle_edges = false;

  /// Throws Error (kUsage) for values that say nothing, and for options of a picture that is not wanted.
  void check() const;
  /// Throws Error, in the name of the source, for materials that are not among these.
  void check_materials(const IdVector<MaterialId, std::string>& materials, const std::string& source) const;
};

/// Without `own_file` the program chooses the files.
void add_surface_picture_options(const Command& command, SurfacePictureOptions& options,
                                 bool own_file = true);

/// Draws interfaces in their domain. Each side of an interface has the colour of the material that lies
/// behind it, as one sees it: so colours depend on materials alone. `block`: what a picture that turns shows
/// where it is cut.
void write_surface_picture(const std::filesystem::path& path, const InterfaceMesh& mesh, const Box3& domain,
                           const SurfacePictureOptions& options = {},
                           std::optional<picture::PictureBlock> block = std::nullopt);

}  // namespace adamas::cli
