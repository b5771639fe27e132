#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/data/mesh_data.h"
#include "interfaces/fields/field_source.h"
#include "interfaces/mesh_reconstruction/mesh_locator.h"
#include "interfaces/mesh_reconstruction/mesh_subdivision.h"

namespace adamas::interfaces {

class FittedValues;

/// Fields on the cells or the points of a mesh of polyhedra. A material's field is linear in the tetrahedra
/// of the subdivision (MeshSubdivision): at cells or points that state a value for the material it has this
/// value, at other ones, and at those to which the field does not belong, that of the linear function that
/// fits the nearest ones that state a value, by least squares, so that a linear field per material is
/// reproduced exactly up to the interface and to the boundary. A cell states a value of a mixed field if it
/// is nearly pure, or no cell round it is purer; of a field per material, if the fraction is no trace. A
/// point states the value for the material that owns it or, with labels, for those of all cells round it.
class MeshFieldSource final : public FieldSource {
 public:
  /// `material_at`: the material at a place. The data must outlive this.
  MeshFieldSource(const MeshData& data, const std::function<MaterialId(const Vec3&)>& material_at);
  ~MeshFieldSource() override;

  [[nodiscard]] const std::vector<FieldInfo>& fields() const override { return fields_; }
  [[nodiscard]] std::size_t row_size() const override { return row_size_; }
  void values(MaterialId material, const Vec3& p, std::span<double> row) const override;
  void values_and_gradients(MaterialId material, const Vec3& p, std::span<double> row,
                            std::span<Vec3> gradients) const override;
  void fitted_values(MaterialId material, const Vec3& p, const Vec3& near,
                     std::span<double> row) const override;
  [[nodiscard]] const std::vector<NativeElement>& native_elements() const override { return elements_; }
  void native_values(const NativeElement& element, std::span<double> row) const override;
  [[nodiscard]] bool interpolates(const NativeElement& element, std::size_t field) const override;

 private:
  using Index = MeshSubdivision::Index;
  struct Sample;

  /// Elements are numbered with cells first, then points.
  [[nodiscard]] bool is_cell(std::size_t site) const { return site < data_.mesh.cell_count(); }
  [[nodiscard]] bool belongs(std::size_t field, std::size_t site) const;
  [[nodiscard]] std::size_t index_in_field(std::size_t site) const {
    return is_cell(site) ? site : site - data_.mesh.cell_count();
  }
  [[nodiscard]] Vec3 site_position(std::size_t site) const;
  [[nodiscard]] bool states(std::size_t field, MaterialId material, std::size_t site) const;
  [[nodiscard]] double stated(std::size_t field, MaterialId material, std::size_t site, std::size_t c) const;
  void find_owners(const std::function<MaterialId(const Vec3&)>& material_at);
  void find_stated_fields();
  void find_ranges();
  void point_values(std::size_t field, MaterialId material, Index point, std::span<double> out) const;
  void collect(std::size_t field, MaterialId material, Index cell, int least, Sample& sample) const;
  [[nodiscard]] bool add_sites(std::size_t field, MaterialId material, std::span<const Index> cells,
                               const std::vector<char>& known, bool any_part, Sample& sample) const;

  const MeshData& data_;
  MeshSubdivision subdivision_;
  MeshLocator locator_;
  std::vector<FieldInfo> fields_;
  std::size_t row_size_ = 0;
  std::vector<std::uint16_t> owner_;        ///< by site
  std::vector<std::uint8_t> mixed_stated_;  ///< by cell: whether its values of mixed fields are its owner's
  std::array<bool, 3> extends_{};           ///< along which axes the cells' centres are at different places
  std::vector<std::vector<char>> stated_somewhere_;  ///< by field and material: whether it has any value
  std::vector<NativeElement> elements_;
  std::unique_ptr<FittedValues> cache_;
};

}  // namespace adamas::interfaces
