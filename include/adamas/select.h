#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adamas/certified_distance.h"
#include "adamas/error_target.h"
#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/input.h"
#include "adamas/progress.h"
#include "adamas/resample.h"

namespace adamas ADAMAS_API {

/// Options that say which mesh is selected from a hierarchy. Without errors and a size it is the whole mesh.
struct SelectOptions {
  /// The greatest distance of the interfaces: a length, a part of the domain's diagonal, or in voxels of the
  /// input's grid.
  std::optional<ErrorTarget> interface_error{};
  /// The greatest errors of fields by name, in the field's unit or as a part of its range.
  std::vector<std::pair<std::string, ErrorTarget>> field_errors{};
  std::optional<std::size_t> max_tetrahedra{};  ///< the selection stops at this number, whatever the errors
};

/// Describes a mesh that was selected from a hierarchy.
struct SelectReport {
  std::string input;  ///< the name of the input that was resampled
  std::size_t tetrahedra = 0, vertices = 0;
  std::size_t changed_tetrahedra = 0;  ///< tetrahedra that were made and removed on the way from the roots
  bool whole_hierarchy = false;        ///< whether the mesh is the whole saved hierarchy
  bool limited = false;                ///< whether the greatest number of tetrahedra has ended the selection

  std::optional<double> interface_error_target;  ///< in units of length
  /// The distances from the input's interfaces that were measured when the hierarchy was saved; none where
  /// this mesh was not.
  std::optional<InterfaceDistances> certificate;
  double interface_error_estimate = 0;  ///< the greatest estimate of a cell, if there is no certificate

  struct Field {
    std::string name, unit;
    std::optional<double> target;
    double max_error = 0, mean_error = 0;  ///< errors in the field's unit
    double reducible_max_error = 0;        ///< the greatest error that smaller cells would lower
    std::size_t elements = 0;              ///< number of places where errors were measured
  };
  std::vector<Field> fields;

  struct Material {
    std::string name;
    std::optional<double> volume_input;  ///< volume in the input, in the cube of the unit of length
    double volume_mesh = 0;
  };
  std::vector<Material> materials;

  /// A wanted error that was not reached.
  struct Unreached {
    std::string what;  ///< "the interface error wanted" and the like
    double found = 0, wanted = 0;
    /// The place of the greatest error: a measured one, or the middle of the cell with the greatest error of
    /// its own. None where it is not known: files of hierarchies do not have the places of distances.
    std::optional<Vec3> place{};
  };
  std::vector<Unreached> unreached;
  std::string reason;  ///< the reason why they were not reached
};

/// A mesh that was selected from a hierarchy. `mesh` keeps no input.
struct SelectedMesh {
  AdaptiveMesh mesh;
  SelectReport report;
};

/// All meshes that can be reached by splitting and merging cells of a resampled mesh: its hierarchy of
/// tetrahedra, without its input, with certified or estimated errors (docs/method.md, Selections).
class MultiresolutionMesh {
 public:
  MultiresolutionMesh(MultiresolutionMesh&&) noexcept;
  MultiresolutionMesh& operator=(MultiresolutionMesh&&) noexcept;
  ~MultiresolutionMesh();

  [[nodiscard]] const std::string& name() const;  ///< the name in messages: the file's name
  [[nodiscard]] const Box3& domain() const;
  /// Returns the names of the materials, by number.
  [[nodiscard]] std::vector<std::string> materials() const;
  [[nodiscard]] std::vector<FieldDescription> fields() const;
  /// Returns the interface error that the hierarchy was built for, in units of length.
  [[nodiscard]] double interface_error() const;
  /// Returns the number of tetrahedra of the whole mesh.
  [[nodiscard]] std::size_t tetrahedra() const;

  /// Selects the smallest mesh that is within the errors, as far as the hierarchy goes and the size allows.
  /// Throws Error for an unknown field, an error that is not positive or greater than the domain, and fewer
  /// tetrahedra than the coarsest mesh has.
  [[nodiscard]] SelectedMesh select(const SelectOptions& options = {},
                                    Progress& progress = SilentProgress::instance()) const;

  /// The library itself uses the members below.
  struct Contents;
  explicit MultiresolutionMesh(std::unique_ptr<Contents> contents);
  [[nodiscard]] const Contents& contents() const { return *contents_; }

 private:
  std::unique_ptr<Contents> contents_;
};

/// Checks options. Throws Error where they do not suit a hierarchy, as select() does before its work.
void check(const SelectOptions& options, const MultiresolutionMesh& mesh);

/// Makes the hierarchy of a mesh that keeps its input, and measures the errors of all cells and of some
/// meshes in between. Throws Error where the mesh keeps no input, and Cancelled where the progress says so.
MultiresolutionMesh multiresolution_mesh(const AdaptiveMesh& mesh,
                                         Progress& progress = SilentProgress::instance());

}  // namespace adamas
