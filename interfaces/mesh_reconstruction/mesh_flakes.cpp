#include "interfaces/mesh_reconstruction/mesh_flakes.h"

#include <algorithm>
#include <optional>

#include "interfaces/mesh_reconstruction/mesh_held_cells.h"
#include "interfaces/mesh_reconstruction/mesh_interfaces.h"
#include "interfaces/mesh_reconstruction/mesh_locator.h"

namespace adamas::interfaces {

namespace {

using Entry = MeshValues::Entry;

class MeshFlakeCells : public FlakeCells {
 public:
  MeshFlakeCells(const MeshData& data, const MeshValues& values, const InterfaceMesh& mesh)
      : mesh_(data.mesh), values_(values) {
    const auto outside = std::ranges::find(mesh.materials, kOutside);
    if (outside != mesh.materials.end())
      outside_ = MaterialId(static_cast<std::size_t>(outside - mesh.materials.begin()));
  }

  [[nodiscard]] Box3 domain() const override { return mesh_.box(); }
  [[nodiscard]] std::uint32_t cell_at(const Vec3& p) const override {
    if (!locator_) locator_.emplace(values_.subdivision());
    return locator_->locate(p).cell;
  }
  [[nodiscard]] double volume(std::uint32_t cell) const override { return mesh_.cell_volume(cell); }
  [[nodiscard]] bool is_outside(MaterialId material) const override { return material == outside_; }
  [[nodiscard]] std::uint32_t group(std::uint32_t cell, MaterialId material) const override {
    std::vector<std::uint32_t> ring;
    values_.subdivision().find_ring(std::array{cell}, ring);
    ring.insert(ring.begin(), cell);
    for (const std::uint32_t each : ring) {
      for (const Entry& entry : values_.at(each)) {
        if (values_.material(entry.material) != material) continue;
        if (const std::uint32_t group = held().group(each, entry.material); group != kNone) return group;
      }
    }
    return kNone;
  }
  void for_each_fraction(std::uint32_t group, const std::function<void(double)>& visit) const override {
    for (const auto& [n, entry] : held().places(group))
      visit(static_cast<double>(values_.at(values_.active_cells()[n])[entry].fraction));
  }

 private:
  /// The groups, and the locator, are made when the first small body asks for them.
  [[nodiscard]] const MeshHeldCells& held() const {
    if (!held_) held_.emplace(values_);
    return *held_;
  }

  const PolyhedralMesh& mesh_;
  const MeshValues& values_;
  MaterialId outside_;
  mutable std::optional<MeshHeldCells> held_;
  mutable std::optional<MeshLocator> locator_;
};

}  // namespace

std::vector<Flake> find_flakes(const MeshData& data, const MeshValues& values, const InterfaceMesh& mesh,
                               const Bodies& bodies) {
  return find_flakes(MeshFlakeCells(data, values, mesh), mesh, bodies.sides, bodies.materials);
}

}  // namespace adamas::interfaces
