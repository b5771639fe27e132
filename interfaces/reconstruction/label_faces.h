#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/data/multi_material_data.h"
#include "core/geometry/vec3.h"

namespace adamas {

/// The faces between voxels of different labels, each twice: once for the voxel on either side. The faces of
/// one side are a surface, in which each has a neighbour across each of its edges, but for edges on the
/// domain's boundary. Where only two opposite ones of the four voxels round an edge share a label, the
/// surface bends round each of them.
class LabelFaces {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  /// A direction is 2 * axis, and one more where it points down the axis.
  static constexpr int kDirections = 6;
  struct Face {
    std::uint32_t site;  ///< whose face it is
    int direction;       ///< of the way out of the site's voxel
  };

  explicit LabelFaces(const MultiMaterialData& data);

  [[nodiscard]] std::size_t size() const { return faces_.size(); }
  [[nodiscard]] const Face& at(std::size_t face) const { return faces_[face]; }
  /// The number of a site's face in a direction, kNone where the site has none there.
  [[nodiscard]] std::uint32_t find(std::size_t site, int direction) const {
    const unsigned mask = mask_[site], bit = 1u << static_cast<unsigned>(direction);
    if ((mask & bit) == 0) return kNone;
    return first_[site] + static_cast<std::uint32_t>(std::popcount(mask & (bit - 1)));
  }
  /// The faces across the edges: up and down the first other axis (in the cyclic order of axes), and up and
  /// down the second.
  [[nodiscard]] std::array<std::uint32_t, 4> neighbours(std::size_t face) const;
  /// The middle of a face: halfway to the other site along its axis for data of points.
  [[nodiscard]] Vec3 middle(std::size_t face) const;

 private:
  /// The site next to another one in a direction; the number of sites where there is none.
  [[nodiscard]] std::size_t step(std::size_t site, int direction) const;
  [[nodiscard]] std::array<std::size_t, 3> place(std::size_t site) const {
    return {site % n_[0], site / n_[0] % n_[1], site / (n_[0] * n_[1])};
  }

  const MultiMaterialData& data_;
  std::array<std::size_t, 3> n_;
  std::vector<std::uint8_t> mask_;    // by site: bits of the directions of its faces
  std::vector<std::uint32_t> first_;  // by site: its first face
  std::vector<Face> faces_;
};

}  // namespace adamas
