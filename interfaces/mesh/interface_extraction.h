#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "adamas/progress.h"
#include "core/data/contact_mesh.h"
#include "core/data/interface_mesh.h"
#include "interfaces/ownership/cell_ownership.h"

namespace adamas::interfaces {

/// Cells whose interfaces are to be extracted: their number, their corners, and the distances at their
/// vertices.
struct CellSet {
  std::size_t count = 0;
  std::function<std::array<std::uint32_t, 4>(std::size_t)> corners;
  std::function<Vec3(std::uint32_t)> position;
  std::function<const VertexDistances&(std::uint32_t)> distances;

  [[nodiscard]] std::array<Vec3, 4> positions(const std::array<std::uint32_t, 4>& vertices) const {
    return {position(vertices[0]), position(vertices[1]), position(vertices[2]), position(vertices[3])};
  }
  void ownership(const InterfaceTable& table, const std::array<std::uint32_t, 4>& vertices,
                 CellOwnership& result) const {
    find_cell_ownership(
        table,
        {&distances(vertices[0]), &distances(vertices[1]), &distances(vertices[2]), &distances(vertices[3])},
        result);
  }
};

/// Triangles of the approximated interfaces, with the bodies in front and behind.
struct ExtractedInterfaces {
  InterfaceMesh mesh;
  std::vector<std::array<BodyId, 2>> bodies;
  std::vector<ContactBuffer::Key> keys{};  ///< of the points, if they are asked for
};

/// Extracts the approximated interfaces of a conforming mesh, welded and closed up to the domain's boundary
/// (docs/method.md, Who owns a point of a cell). The names of materials and of the source are set by the
/// caller.
ExtractedInterfaces extract_interfaces(const InterfaceTable& table, const CellSet& cells, const Box3& domain,
                                       Progress& progress = SilentProgress::instance());

/// Returns the network of the contacts in a builder, between bodies as owners; the builder is empty
/// afterwards. `with_keys`: whether the keys of points are wanted.
ExtractedInterfaces finish_extraction(const InterfaceTable& table, ContactMeshBuilder& builder,
                                      bool with_keys = false);

/// Returns the volumes that bodies own in the cells, in the order of the cells, with one entry for each cell
/// and body, in the cube of the unit of length.
std::vector<std::pair<BodyId, double>> owned_volumes(const InterfaceTable& table, const CellSet& cells);

/// Returns the volume of each body, in the cube of the unit of length.
IdVector<BodyId, double> body_volumes(const InterfaceTable& table, const CellSet& cells);

/// Returns the volume of each material, in the cube of the unit of length. `materials`: the number of
/// materials.
IdVector<MaterialId, double> material_volumes(const InterfaceTable& table, const CellSet& cells,
                                              std::size_t materials);

/// Returns 1 for each cell that an approximated interface crosses, else 0. Throws Cancelled if `progress`
/// requests it.
std::vector<char> cells_with_interfaces(const InterfaceTable& table, const CellSet& cells,
                                        const Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
