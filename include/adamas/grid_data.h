#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "adamas/export.h"
#include "adamas/geometry.h"

namespace adamas {
inline namespace core {
struct MultiMaterialData;
}
}  // namespace adamas

namespace adamas ADAMAS_API {

/// The elements of a grid at which values are given.
enum class Centering { kCells, kPoints };

/// A rectilinear grid with ascending node coordinates along each axis. Its *sites*, the cell centres or the
/// nodes, carry the values. Sites are numbered with x fastest.
struct RectilinearGrid {
  std::array<std::vector<double>, 3> nodes;
  Centering centering = Centering::kCells;

  /// Makes a grid of so many sites along x, y and z, `spacing` apart. `origin`: the lower corner of the first
  /// cell, or the first point.
  static RectilinearGrid uniform(const std::array<std::size_t, 3>& sites, const Vec3& origin,
                                 const Vec3& spacing, Centering centering = Centering::kCells);

  /// Returns the number of sites along an axis.
  [[nodiscard]] std::size_t sites(int axis) const {
    const std::size_t n = nodes[static_cast<std::size_t>(axis)].size();
    return centering == Centering::kPoints || n == 0 ? n : n - 1;
  }
  [[nodiscard]] std::size_t site_count() const { return sites(0) * sites(1) * sites(2); }
  [[nodiscard]] std::size_t site_index(std::size_t i, std::size_t j, std::size_t k) const {
    return i + sites(0) * (j + sites(1) * k);
  }
  /// Returns the coordinate of site i along an axis.
  [[nodiscard]] double site_coordinate(int axis, std::size_t i) const {
    const auto& n = nodes[static_cast<std::size_t>(axis)];
    return centering == Centering::kPoints ? n[i] : 0.5 * (n[i] + n[i + 1]);
  }
  [[nodiscard]] Vec3 site(std::size_t i, std::size_t j, std::size_t k) const {
    return {site_coordinate(0, i), site_coordinate(1, j), site_coordinate(2, k)};
  }
  /// Returns the box spanned by the nodes.
  [[nodiscard]] Box3 domain() const {
    return {{nodes[0].front(), nodes[1].front(), nodes[2].front()},
            {nodes[0].back(), nodes[1].back(), nodes[2].back()}};
  }
  /// Returns the least distance of neighbouring nodes along any axis.
  [[nodiscard]] double least_spacing() const;
  /// Returns the length along an axis of the region that site i along it stands for (site_volume).
  [[nodiscard]] double site_extent(int axis, std::size_t i) const;
  /// Returns the volume of the region that site (i, j, k) stands for: its cell, or the part of the domain
  /// nearer to it than to other sites along each axis.
  [[nodiscard]] double site_volume(std::size_t i, std::size_t j, std::size_t k) const;
};

/// A view of numbers in an array of the caller, which must outlive it.
using NumberSpan = std::variant<std::span<const float>, std::span<const double>,
                                std::span<const std::uint8_t>, std::span<const std::int16_t>,
                                std::span<const std::uint16_t>, std::span<const std::int32_t>>;

/// A scalar or vector field on the sites of a grid. It is either mixed, with one value per site for all
/// materials, or has separate values for each material; only one of `values` and `material_values` is given.
struct GridField {
  std::string name;
  std::string unit{};  ///< the unit, for texts; may be empty
  int components = 1;
  /// Mixed: component c at site s is `values[s * components + c]`.
  NumberSpan values{};
  /// Per material: an array like `values` for each material; empty for materials without this field.
  std::vector<NumberSpan> material_values{};
};

/// Simulation data of several materials on a rectilinear grid. The arrays belong to the caller: a call reads
/// them in place and keeps nothing of them. Two kinds of arrays are copied: floating-point fractions that do
/// not add up to 1 within a millionth at each site, which are scaled; and arrays of another type than the
/// computation's: float for fractions, float or double for fields (double for int32), uint16 for labels.
struct GridData {
  std::string name = "data";  ///< the name in messages
  RectilinearGrid grid;
  std::vector<std::string> materials;
  /// Volume fractions: one array per material, one number in [0, 1] per site. Their sums may be off by 5%.
  std::vector<NumberSpan> fractions{};
  /// Labels, in place of fractions: the number of the one material at each site, in an array of whole
  /// numbers.
  NumberSpan labels{};
  std::vector<GridField> fields{};
};

/// Checks data. Throws Error, in one line that begins with the data's name, at the first problem: a grid
/// without volume, coordinates that do not ascend, arrays of the wrong length, numbers that are not finite,
/// labels beyond the materials, both labels and fractions or neither, fractions that do not add up to 1.
void check(const GridData& data);

/// Returns the volume of each material according to fractions or labels, in the cube of the unit of length.
/// Throws Error as check() does.
std::vector<double> material_volumes(const GridData& data);

/// GridData that own their arrays, such as data read from files and made from scenes.
class OwnedGridData {
 public:
  explicit OwnedGridData(std::unique_ptr<MultiMaterialData> data);
  OwnedGridData(OwnedGridData&&) noexcept;
  OwnedGridData& operator=(OwnedGridData&&) noexcept;
  ~OwnedGridData();

  /// Returns a view of the data, whose spans are valid as long as this object.
  [[nodiscard]] GridData view() const;

  /// Gives the data away; the library itself uses this.
  [[nodiscard]] std::unique_ptr<MultiMaterialData> release() &&;

 private:
  std::unique_ptr<MultiMaterialData> data_;
};

}  // namespace adamas
