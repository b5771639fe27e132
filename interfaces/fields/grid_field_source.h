#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/fields/field_source.h"

namespace adamas::interfaces {

class FittedValues;

/// Fields on the sites of a rectilinear grid. A material's field is trilinear between sites that state a
/// value for the material: of a field per material if its fraction is no trace, of a mixed field if the site
/// is nearly pure. Other sites get the weighted least-squares linear fit of the nearest ones that state a
/// value, so that a linear field per material is reproduced exactly up to the interface and to the domain's
/// boundary. If no site nearby states a mixed field for a material, as in a thin layer, it is taken from
/// sites that hold some of the material, else from the nearest site that states it.
class GridFieldSource final : public FieldSource {
 public:
  /// `owners`: the material at each site's centre. Each site is a native element of that material, to which a
  /// mixed field's value belongs, and of each other material that states a value of its own there. `data`
  /// must outlive this.
  GridFieldSource(const MultiMaterialData& data, const std::vector<MaterialId>& owners);
  ~GridFieldSource() override;

  [[nodiscard]] const std::vector<FieldInfo>& fields() const override { return fields_; }
  [[nodiscard]] std::size_t row_size() const override { return row_size_; }
  void values(MaterialId material, const Vec3& p, std::span<double> row) const override;
  void values_and_gradients(MaterialId material, const Vec3& p, std::span<double> row,
                            std::span<Vec3> gradients) const override;
  /// The fit takes the sites that state a value within a box round `near` that reaches as far as p, but at
  /// most some steps; the box grows only until there are enough.
  void fitted_values(MaterialId material, const Vec3& p, const Vec3& near,
                     std::span<double> row) const override;
  [[nodiscard]] const std::vector<NativeElement>& native_elements() const override { return elements_; }
  void native_values(const NativeElement& element, std::span<double> row) const override;
  [[nodiscard]] bool interpolates(const NativeElement& element, std::size_t field) const override {
    return has_stated_value(field, element.material, element.site);
  }

 private:
  struct Cell;
  using Site = std::array<std::int32_t, 3>;

  [[nodiscard]] std::int32_t sites(std::size_t axis) const {
    return static_cast<std::int32_t>(coordinates_[axis].size()) - 2;
  }
  [[nodiscard]] double coordinate(std::size_t axis, std::int32_t i) const {
    return coordinates_[axis][static_cast<std::size_t>(i + 1)];
  }
  [[nodiscard]] Vec3 site_position(const Site& s) const {
    return {coordinate(0, s[0]), coordinate(1, s[1]), coordinate(2, s[2])};
  }
  /// Returns the step along each axis at a site.
  [[nodiscard]] Vec3 spacing(const Site& s) const;
  [[nodiscard]] bool inside(const Site& s) const;
  [[nodiscard]] std::size_t index(const Site& s) const;
  void place_owners(const std::vector<MaterialId>& owners);
  void place_minorities();
  /// Returns whether the site holds only its owner, except for a trace.
  [[nodiscard]] bool pure(std::size_t site) const;
  void find_mixed_sites();
  void find_stated_fields();
  void find_ranges();
  /// Returns whether the site states a value of the material's field.
  [[nodiscard]] bool has_stated_value(std::size_t field, MaterialId material, std::size_t site) const;
  [[nodiscard]] double stated_value(std::size_t field, MaterialId material, std::size_t site,
                                    int component) const;
  /// Finds the value at a site, stated or fitted; sites one step outside the grid are fitted.
  void site_values(std::size_t field, MaterialId material, const Site& site, std::span<double> out) const;
  struct Sample;
  /// Adds the sites `reach` steps away for which `states` holds.
  template <class States>
  void add_shell(std::size_t field, MaterialId material, const Site& site, std::int32_t reach,
                 const States& states, Sample& sample) const;
  /// Collects the values stated within `least` steps of the site, or within as many more steps as a linear
  /// fit needs.
  void collect(std::size_t field, MaterialId material, const Site& site, std::int32_t least,
               Sample& sample) const;
  void fit(std::size_t field, MaterialId material, const Site& site, std::span<double> out) const;
  [[nodiscard]] Cell locate(const Vec3& p) const;
  [[nodiscard]] Site nearest_site(const Vec3& p) const;

  const MultiMaterialData& data_;
  std::vector<FieldInfo> fields_;
  std::size_t row_size_ = 0;
  std::array<std::vector<double>, 3> coordinates_;  ///< the coordinates of sites -1, 0, ..., n
  std::vector<std::uint16_t> owner_;
  std::vector<IdVector<MaterialId, char>> stated_somewhere_;  ///< indexed by field
  /// by site: 1 if its values of mixed fields are those of its owner
  std::vector<std::uint8_t> mixed_stated_;
  std::vector<NativeElement> elements_;
  std::unique_ptr<FittedValues> cache_;
};

}  // namespace adamas::interfaces
