#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "adamas/export.h"
#include "adamas/fractions.h"
#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "adamas/input.h"
#include "adamas/meshes.h"
#include "adamas/progress.h"
#include "adamas/simplify.h"

namespace adamas ADAMAS_API {

struct ReconstructOptions {
  /// Reconstruct interfaces of labels without the staircase of voxels, within half a voxel of it along each
  /// axis. Only labels have this option.
  bool smooth_labels = false;
  FractionOptions fractions{};
  SimplifyOptions simplify{};

  /// Returns the name, on the command line, of the first option given that says how interfaces are
  /// reconstructed; empty where there is none.
  [[nodiscard]] std::string option() const {
    return smooth_labels ? std::string("--smooth-labels") : fractions.option();
  }
};

/// The agreement of the volumes that interfaces enclose in cells with the fractions there. Differences are
/// relative to a cell's volume.
struct CellAgreement {
  std::size_t mixed_cells = 0;  ///< cells with several materials
  /// Those among them where a material's volume or, for a blurred one, the predicted fraction differs from
  /// its fraction by more than the tolerance.
  std::size_t cells_off = 0;
  /// A thousandth of the cell, or three standard deviations of the fractions' errors if these are more.
  double tolerance = 0;
  double greatest_difference = 0, mean_difference = 0;  ///< in mixed cells
  std::size_t full_cells_off = 0;  ///< cells that one material fills and in which others get more than 0.1%
  double greatest_in_full_cell = 0;
};

/// A material of the volume fractions or labels that no interface shows.
struct LostMaterial {
  std::size_t material = 0;  ///< its number
  double volume = 0;         ///< its volume according to the fractions, in the cube of the unit of length
  /// Whether its fractions are no greater than one step of the stored numbers.
  bool within_one_step = false;
};

/// Connected cells that hold a material, according to their fractions, which no interface there shows.
struct LostPlace {
  std::size_t material = 0;  ///< its number
  double volume = 0;  ///< its volume there according to the fractions, in the cube of the unit of length
  std::size_t cells = 0;
  double greatest_fraction = 0;
  Vec3 place;                    ///< the middle of that volume
  bool within_one_step = false;  ///< whether the fractions are no greater than one step of the stored numbers
};

/// The interface between two materials.
struct InterfaceArea {
  std::array<std::uint32_t, 2> materials{};  ///< their numbers, the lower one first
  std::size_t triangles = 0;
  /// Area in the square of the unit of length; for given interfaces, of the part in the domain.
  double area = 0;
};

/// The result of reconstruct().
struct ReconstructedInterfaces {
  InterfaceTriangles mesh;
  std::string input;  ///< the name of the input, for messages
  Box3 domain;
  struct Material {
    std::string name;
    /// The volume according to fractions or labels, in the cube of the unit of length; none for given
    /// interfaces.
    std::optional<double> volume_input;
    /// The volume that the interfaces enclose, before they are simplified; none where given interfaces are
    /// not closed.
    std::optional<double> volume_reconstructed;
  };
  std::vector<Material> materials;
  std::size_t bodies = 0;                     ///< connected parts of materials
  std::vector<InterfaceArea> interfaces;      ///< those of `mesh`, in the order of their materials
  std::optional<FractionFindings> fractions;  ///< findings about volume fractions, for inputs that have these
  std::optional<CellAgreement> agreement;     ///< agreement, for data on a grid
  std::vector<LostMaterial> lost_materials;   ///< lost materials, without those that are all dispersed
  std::vector<LostPlace> lost_places;
  std::optional<SimplificationReport> simplification;  ///< what simplification did, where it was asked for
};

/// Reconstructs material interfaces from volume fractions or labels: each mixed cell has the volumes of its
/// fractions, without gaps or overlaps (docs/method.md, Interfaces from volume fractions; after Bonnell et
/// al., Material interface reconstruction, 2003). Given interfaces are repaired and checked, as resample()
/// does. The memory of an input that is moved here and has no copies is released as soon as possible. Throws
/// Error where the options do not suit the input and at interfaces that cannot be used, and Cancelled where
/// the progress says so.
ReconstructedInterfaces reconstruct(Input input, const ReconstructOptions& options = {},
                                    Progress& progress = SilentProgress::instance());

/// Reconstructs the interfaces of data on a grid: reconstruct(Input(data), ...).
ReconstructedInterfaces reconstruct(const GridData& data, const ReconstructOptions& options = {},
                                    Progress& progress = SilentProgress::instance());

}  // namespace adamas
