#include "interfaces/reconstruction/grid_flakes.h"

#include <optional>

#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/held_cells.h"

namespace adamas::interfaces {

namespace {

class GridFlakeCells : public FlakeCells {
 public:
  GridFlakeCells(const MultiMaterialData& data, const SiteValues& values)
      : data_(data), values_(values), sites_(data.grid) {}

  [[nodiscard]] Box3 domain() const override { return data_.grid.domain(); }
  [[nodiscard]] std::uint32_t cell_at(const Vec3& p) const override {
    return static_cast<std::uint32_t>(sites_.site_at(p));
  }
  [[nodiscard]] double volume(std::uint32_t cell) const override { return sites_.cell(cell).volume(); }
  [[nodiscard]] std::uint32_t group(std::uint32_t cell, MaterialId material) const override {
    const HeldCells& cells = held();
    std::size_t site = cell;
    sites_.for_each_neighbour(cell, [&](std::size_t other, int, int, int) {
      if (cells.find(site, material) == nullptr) site = other;
    });
    return cells.group(site, material);
  }
  void for_each_fraction(std::uint32_t group, const std::function<void(double)>& visit) const override {
    held().for_each_cell(group, [&](std::size_t, double fraction) {
      visit(fraction);
      return true;
    });
  }

 private:
  /// The groups are found when the first small body asks for one.
  [[nodiscard]] const HeldCells& held() const {
    if (!held_) held_.emplace(data_, values_);
    return *held_;
  }

  const MultiMaterialData& data_;
  const SiteValues& values_;
  GridSites sites_;
  mutable std::optional<HeldCells> held_;
};

}  // namespace

std::vector<Flake> find_flakes(const MultiMaterialData& data, const SiteValues& values,
                               const InterfaceMesh& mesh, const std::vector<std::array<BodyId, 2>>& bodies,
                               const IdVector<BodyId, MaterialId>& body_materials) {
  return find_flakes(GridFlakeCells(data, values), mesh, bodies, body_materials);
}

}  // namespace adamas::interfaces
