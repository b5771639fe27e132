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
  /// Applies to labels: reconstruct interfaces without the staircase of voxels, within half a voxel of it
  /// along each axis.
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
/// parts of a cell's volume.
struct CellAgreement {
  std::size_t mixed_cells = 0;  ///< cells with several materials
  std::size_t cells_off = 0;    ///< those among them that differ by more than the tolerance
  double greatest_difference = 0, mean_difference = 0;
  std::size_t full_cells_off = 0;  ///< cells that one material fills and of which others get more than 0.1%
  double greatest_in_full_cell = 0;
};

/// A material that is in the volume fractions or labels and that the interfaces show nothing of.
struct LostMaterial {
  std::size_t material = 0;  ///< its number
  double volume = 0;         ///< by the fractions, in the cube of the unit of length
  /// Whether its fractions are no more than a step of the stored numbers.
  bool within_one_step = false;
};

/// Connected cells that hold a material, by their fractions, of which the interfaces show nothing.
struct LostPlace {
  std::size_t material = 0;  ///< its number
  double volume = 0;         ///< by the fractions, in the cube of the unit of length
  std::size_t cells = 0;
  double greatest_fraction = 0;
  Vec3 place;                    ///< the middle of that volume
  bool within_one_step = false;  ///< whether the fractions are no more than a step of the stored numbers
};

/// The interface between two materials.
struct InterfaceArea {
  std::array<std::uint32_t, 2> materials{};  ///< their numbers, the lower one first
  std::size_t triangles = 0;
  double area = 0;  ///< in the square of the unit of length; of given interfaces that in the domain
};

/// The result of reconstruct().
struct ReconstructedInterfaces {
  InterfaceTriangles mesh;
  std::string input;  ///< the name of the input, for messages
  Box3 domain;
  struct Material {
    std::string name;
    /// The volume as fractions or labels say, in the cube of the unit of length; none of given interfaces.
    std::optional<double> volume_input;
    /// The volume as the interfaces enclose it, before they are simplified; none where given interfaces are
    /// not closed.
    std::optional<double> volume_reconstructed;
  };
  std::vector<Material> materials;
  std::size_t bodies = 0;                     ///< connected parts of materials
  std::vector<InterfaceArea> interfaces;      ///< those of `mesh`, in the order of their materials
  std::optional<FractionFindings> fractions;  ///< of volume fractions
  std::optional<CellAgreement> agreement;     ///< of data on a grid
  std::vector<LostMaterial> lost_materials;   ///< without those that are all dispersed
  std::vector<LostPlace> lost_places;
  std::optional<SimplificationReport> simplification;  ///< where the interfaces were simplified
};

/// Reconstructs material interfaces from volume fractions or labels: each mixed cell holds what its fractions
/// say, without gaps or overlaps (docs/method.md, Interfaces from volume fractions; after Bonnell et al.,
/// Material interface reconstruction, 2003). Given interfaces are mended and checked, as resample() does.
/// An input that is moved here and has no copies is given back as soon as it is not needed. Throws Error
/// where the options do not suit the input and at interfaces that cannot be used, and Cancelled where the
/// progress says so.
ReconstructedInterfaces reconstruct(Input input, const ReconstructOptions& options = {},
                                    Progress& progress = SilentProgress::instance());

/// Reconstructs the interfaces of data on a grid: reconstruct(Input(data), ...).
ReconstructedInterfaces reconstruct(const GridData& data, const ReconstructOptions& options = {},
                                    Progress& progress = SilentProgress::instance());

}  // namespace adamas
