#include "interfaces/reconstruction/fraction_area.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "core/geometry/ownership_problem.h"
#include "core/geometry/plane.h"

namespace adamas::interfaces {

namespace {

/// Measures the interfaces in one lattice cell after another.
class CellInterfaces {
 public:
  using Index = MaterialLattice::Index;

  CellInterfaces(const MultiMaterialData& data, const SiteValues& values, const MaterialLattice& lattice)
      : data_(data), values_(values), lattice_(lattice), absent_(-0.5 * data.grid.least_spacing()) {}

  /// Returns the area in a row of lattice cells along x.
  double area_of_row(std::uint32_t j, std::uint32_t k) {
    double sum = 0;
    Index cell{0, j, k};
    find_sites(cell, 0);
    for (; cell[0] + 1 < lattice_.points(0); ++cell[0]) {
      find_sites(cell, 1);
      if (!has_one_material() && find_materials(cell) && !has_one_owner()) sum += area(cell);
      for (std::size_t c = 0; c < 8; c += 2) sites_[c] = sites_[c + 1];
    }
    return sum;
  }

 private:
  static Index corner(const Index& cell, unsigned c) {
    return {cell[0] + (c & 1u), cell[1] + (c >> 1 & 1u), cell[2] + (c >> 2)};
  }

  /// Finds the sites nearest to the corners of a cell at one end along x.
  void find_sites(const Index& cell, unsigned end) {
    for (unsigned c = end; c < 8; c += 2) sites_[c] = lattice_.nearest_site(data_.grid, corner(cell, c));
  }

  [[nodiscard]] bool has_one_material() const {
    const std::uint16_t first = values_.sole_material(sites_[0]);
    return first < data_.materials.size() && std::ranges::all_of(sites_, [&](std::size_t site) {
             return values_.sole_material(site) == first;
           });
  }

  double area(const Index& cell) {
    for (unsigned c = 0; c < 8; ++c) positions_[c] = lattice_.position(corner(cell, c));
    double sum = 0;
    for (const auto& path : MaterialLattice::kPaths) {
      const std::size_t first = std::size_t{1} << path[0], second = first | std::size_t{1} << path[1];
      sum += area_in({0, first, second, 7});
    }
    return sum;
  }

  /// Finds the materials at the corners of a lattice cell and their values there; returns false if there is
  /// only one.
  bool find_materials(const Index& cell) {
    found_.clear();
    for (const std::size_t site : sites_) {
      if (values_.sole_material(site) < data_.materials.size()) {
        found_.push_back(values_.sole_material(site));
        continue;
      }
      for (const SiteValues::Entry& entry : values_.at(site)) {
        const std::uint16_t number = values_.material_number(entry.material);
        if (data_.fraction(values_.material(number), site) > 0) found_.push_back(number);
      }
    }
    sort_unique(found_);
    if (found_.size() < 2) return false;
    at_corners_.resize(found_.size());
    for (unsigned c = 0; c < 8; ++c) {
      const Index p = corner(cell, c);
      const bool is_site = !lattice_.inwards(p);
      for (std::size_t m = 0; m < found_.size(); ++m) {
        const MaterialId material = values_.material(found_[m]);
        at_corners_[m][c] =
            is_site ? value_of_fraction(data_.fraction(material, sites_[c])) : value(material, p);
      }
    }
    return true;
  }

  /// Returns whether one of the materials found has the greatest value at all corners, so that there is no
  /// interface.
  [[nodiscard]] bool has_one_owner() const {
    const auto greatest = std::ranges::max_element(at_corners_, {}, [](const auto& row) { return row[0]; });
    return std::ranges::all_of(at_corners_, [&](const auto& row) {
      if (&row == &*greatest) return true;
      for (std::size_t c = 0; c < row.size(); ++c) {
        if (!(row[c] < (*greatest)[c])) return false;
      }
      return true;
    });
  }

  /// Returns the value at a site: a length in proportion to the fraction less a half.
  [[nodiscard]] double value_of_fraction(float fraction) const {
    return (0.5 - static_cast<double>(fraction)) * 2 * absent_;
  }

  /// Returns the value of a material at a lattice point.
  [[nodiscard]] double value(MaterialId material, const Index& p) const {
    const float fraction = data_.fraction(material, lattice_.nearest_site(data_.grid, p));
    const std::optional<MaterialLattice::Inwards> inwards = lattice_.inwards(p);
    if (!inwards) return value_of_fraction(fraction);
    constexpr double kNone = -std::numeric_limits<double>::infinity();
    return continued(value(material, inwards->nearest), value(material, inwards->next), inwards->step, kNone,
                     fraction <= 0 || fraction >= 1);
  }

  /// Returns the area in the tetrahedron of these corners of the lattice cell.
  double area_in(const std::array<std::size_t, 4>& corners) {
    problem_.clear();
    for (std::size_t m = 0; m < found_.size(); ++m) {
      const auto& row = at_corners_[m];
      const std::array<double, 4> own{row[corners[0]], row[corners[1]], row[corners[2]], row[corners[3]]};
      // A material that is absent from all corners owns nothing.
      if (*std::ranges::max_element(own) <= absent_) continue;
      problem_.add_candidate(found_[m]);
      problem_.add_function(own, found_[m]);
    }
    if (problem_.candidates.size() < 2) return 0;
    if (const std::optional<TwoOwners> two = two_owners(problem_))
      return area_of(
          section_between(problem_.functions[two->first->first], problem_.functions[two->second->first]),
          corners);
    contacts_.clear();
    contact_polygons(problem_, contacts_);
    double sum = 0;
    for (const ContactPolygon& contact : contacts_) {
      polygon_.assign(contact.corners.size(), {});
      for (std::size_t i = 0; i < polygon_.size(); ++i) {
        for (std::size_t v = 0; v < 4; ++v)
          polygon_[i] += contact.corners[i].weights[v] * positions_[corners[v]];
      }
      sum += polygon_area(polygon_);
    }
    return sum;
  }

  [[nodiscard]] double area_of(const TetrahedronSection& section,
                               const std::array<std::size_t, 4>& corners) const {
    std::array<Vec3, 4> p;
    for (std::size_t c = 0; c < section.count; ++c) {
      const TetrahedronSection::Corner& cut = section.corners[c];
      p[c] = (1 - cut.t) * positions_[corners[cut.low]] + cut.t * positions_[corners[cut.high]];
    }
    return section.count == 4 ? 0.5 * norm(cross(p[2] - p[0], p[3] - p[1]))
                              : 0.5 * norm(cross(p[1] - p[0], p[2] - p[0]));
  }

  const MultiMaterialData& data_;
  const SiteValues& values_;
  const MaterialLattice& lattice_;
  double absent_;                                  // the value of a fraction of 0
  std::array<std::size_t, 8> sites_{};             // the sites nearest to the lattice cell's corners
  std::array<Vec3, 8> positions_;                  // of these corners
  std::vector<std::uint16_t> found_;               // the materials there, by their numbers
  std::vector<std::array<double, 8>> at_corners_;  // their values
  OwnershipProblem problem_;
  std::vector<ContactPolygon> contacts_;
  std::vector<Vec3> polygon_;
};

}  // namespace

double interface_area_of_fractions(const MultiMaterialData& data, const SiteValues& values,
                                   const MaterialLattice& lattice) {
  std::vector<double> areas(lattice.points(2) - 1, 0);
  parallel_for(areas.size(), 1, [&](std::size_t k) {
    CellInterfaces cells(data, values, lattice);
    for (std::uint32_t j = 0; j + 1 < lattice.points(1); ++j)
      areas[k] += cells.area_of_row(j, static_cast<std::uint32_t>(k));
  });
  return std::accumulate(areas.begin(), areas.end(), 0.0);
}

}  // namespace adamas::interfaces
