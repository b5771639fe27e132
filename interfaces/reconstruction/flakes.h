#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/data/interface_mesh.h"

namespace adamas::interfaces {

/// A part of a cell that goes from one material to another.
struct VolumeMove {
  std::uint32_t cell;
  MaterialId from, to;
  double part;  ///< relative to the cell's volume
};

/// A body far smaller than a cell that the correction of volumes has cut off from cells which hold far more
/// of its material.
struct Flake {
  BodyId body;
  /// The neighbour with the greatest common area, among those whose material no other neighbour has.
  BodyId neighbour;
  VolumeMove move;  ///< to the neighbour, in the cell that holds the middle of the flake's bounding box
  double volume;    ///< in the cube of the unit of length
};

/// The cells of a grid or a mesh, as the search for flakes sees them.
class FlakeCells {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  FlakeCells() = default;
  FlakeCells(const FlakeCells&) = delete;
  FlakeCells& operator=(const FlakeCells&) = delete;
  virtual ~FlakeCells() = default;

  [[nodiscard]] virtual Box3 domain() const = 0;
  [[nodiscard]] virtual std::uint32_t cell_at(const Vec3& p) const = 0;
  [[nodiscard]] virtual double volume(std::uint32_t cell) const = 0;
  /// Whether a material is nothing that the cells hold but what is beyond them.
  [[nodiscard]] virtual bool is_outside(MaterialId) const { return false; }
  /// Returns the group of connected cells that hold a material to which a cell, or one beside it, belongs;
  /// kNone if none of these holds the material.
  [[nodiscard]] virtual std::uint32_t group(std::uint32_t cell, MaterialId material) const = 0;
  /// Calls visit(fraction) for the cells of a group.
  virtual void for_each_fraction(std::uint32_t group, const std::function<void(double)>& visit) const = 0;
};

/// Finds the flakes of reconstructed interfaces; `bodies`: the bodies in front of each triangle and behind
/// it, invalid for triangles that do not count.
std::vector<Flake> find_flakes(const FlakeCells& cells, const InterfaceMesh& mesh,
                               const std::vector<std::array<BodyId, 2>>& bodies,
                               const IdVector<BodyId, MaterialId>& body_materials);

/// Finds flakes of interfaces that enclose the volumes `given`, and closes totals again until they are right
/// with the flakes counted for their neighbours. `wanted`: the volumes of materials; `domain`: that of all;
/// find(): finds the flakes; close(volumes): closes totals to these volumes, makes interfaces again and
/// returns the volumes that they enclose. On return `given` counts the flakes for their neighbours.
std::vector<Flake> settle_flakes(
    const IdVector<MaterialId, double>& wanted, double domain,
    const std::function<std::vector<Flake>()>& find,
    const std::function<IdVector<MaterialId, double>(const IdVector<MaterialId, double>&)>& close,
    IdVector<MaterialId, double>& given);

/// Gives flakes to their neighbours: removes the triangles between the two and changes the bodies of the
/// others and the materials of bodies. Returns the new number of each body.
IdVector<BodyId, BodyId> drop_flakes(const std::vector<Flake>& flakes, InterfaceMesh& mesh,
                                     std::vector<std::array<BodyId, 2>>& bodies,
                                     IdVector<BodyId, MaterialId>& body_materials);

}  // namespace adamas::interfaces
