#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/thin_sheets.h"

namespace adamas::interfaces {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
/// Places beside each other are of one sheet where the cosine of their normals is at least this, and their
/// heights between them differ by no more cells.
constexpr double kLeastCosine = 0.5, kMostStep = 0.6;
/// The cells with layers fitted to what is round them that a sheet has at least, also as a part of its own.
constexpr std::size_t kFewest = 12;
constexpr double kLeastFitted = 0.4, kLeastFittedBlurred = 0.04;
/// What the cells between two hold of a sheet that runs through, in relation to its thickness.
constexpr double kLeastBetween = 0.4;

/// Sides of places: 2 p for what lies before place p, 2 p + 1 for what lies behind. A set of sides knows
/// which others lie across sheets, and never becomes one with these.
class SideSets {
 public:
  explicit SideSets(std::size_t places) : parent_(2 * places), across_(2 * places) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    for (std::uint32_t s = 0; s < parent_.size(); ++s) across_[s] = {s ^ 1u};
  }

  std::uint32_t find(std::uint32_t side) {
    while (parent_[side] != side) side = parent_[side] = parent_[parent_[side]];
    return side;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    if (a == b || lies_across(a, b)) return;
    if (across_[a].size() < across_[b].size()) std::swap(a, b);
    parent_[b] = a;
    // Those across are one in most cases.
    for (const std::uint32_t s : across_[b]) {
      const std::uint32_t root = find(s);
      if (std::none_of(across_[a].begin(), across_[a].end(),
                       [&](std::uint32_t t) { return find(t) == root; }))
        across_[a].push_back(root);
    }
    across_[b] = {};
  }

 private:
  bool lies_across(std::uint32_t a, std::uint32_t b) {
    return std::any_of(across_[a].begin(), across_[a].end(), [&](std::uint32_t s) { return find(s) == b; }) ||
           std::any_of(across_[b].begin(), across_[b].end(), [&](std::uint32_t s) { return find(s) == a; });
  }

  std::vector<std::uint32_t> parent_;
  std::vector<std::vector<std::uint32_t>> across_;  // by root
};

class RegionSearch {
 public:
  RegionSearch(const MultiMaterialData& data, const SiteValues& values, ThinSheets& sheets)
      : data_(data),
        values_(values),
        grid_sites_(data.grid),
        sheets_(sheets),
        sets_(sheets.places.size()),
        place_of_(data.grid.site_count(), kNone) {
    for (std::size_t p = 0; p < sheets.places.size(); ++p)
      place_of_[sheets.places[p].site] = static_cast<std::uint32_t>(p);
  }

  void run() {
    drop_unclear_sheets();
    for_each_pair([&](std::uint32_t p, std::uint32_t q, const Vec3& d) { join_along_sheet(p, q, d); });
    for_each_pair([&](std::uint32_t p, std::uint32_t q, const Vec3&) { join_through_cells(p, q); });
    drop_ends();
    number();
  }

 private:
  [[nodiscard]] const SheetPlace& place(std::uint32_t p) const { return sheets_.places[p]; }
  [[nodiscard]] bool are_blurred(std::uint32_t p) const { return place(p).slab.width > 0; }

  /// Calls visit(p, q, offset of q from p) for places that are beside each other.
  template <class Visit>
  void for_each_pair(const Visit& visit) {
    for (std::uint32_t p = 0; p < sheets_.places.size(); ++p) {
      grid_sites_.for_each_neighbour(place(p).site, [&](std::size_t other, int di, int dj, int dk) {
        const std::uint32_t q = place_of_[other];
        if (q == kNone || q < p) return;
        visit(p, q, Vec3{static_cast<double>(di), static_cast<double>(dj), static_cast<double>(dk)});
      });
    }
  }

  /// Leaves out sheets that touch sheets of another material, where it is not clear what is on whose side,
  /// and those with fits for few of their cells: fractions of a simulation that are smeared look like it here
  /// and there.
  void drop_unclear_sheets() {
    const std::size_t count = sheets_.places.size();
    DisjointSets sets(count);
    std::vector<char> mixed(count, 0);
    std::vector<std::size_t> fitted(count, 0), held(count, 0);
    for_each_pair([&](std::uint32_t p, std::uint32_t q, const Vec3&) {
      if (place(p).material == place(q).material && are_blurred(p) == are_blurred(q)) sets.join(p, q);
    });
    for_each_pair([&](std::uint32_t p, std::uint32_t q, const Vec3&) {
      if (place(p).material != place(q).material) mixed[sets.find(p)] = mixed[sets.find(q)] = 1;
    });
    for (std::uint32_t p = 0; p < count; ++p) {
      fitted[sets.find(p)] += place(p).is_fitted ? 1 : 0;
      held[sets.find(p)] += is_beside(p) ? 0 : 1;
    }
    std::vector<SheetPlace> kept;
    std::fill(place_of_.begin(), place_of_.end(), kNone);
    for (std::uint32_t p = 0; p < count; ++p) {
      const std::uint32_t sheet = sets.find(p);
      const double least = place(p).slab.width > 0 ? kLeastFittedBlurred : kLeastFitted;
      const bool is_clear = fitted[sheet] >= kFewest &&
                            static_cast<double>(fitted[sheet]) >= least * static_cast<double>(held[sheet]);
      if (mixed[sheet] != 0 || !is_clear) continue;
      place_of_[place(p).site] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(place(p));
    }
    sheets_.places = std::move(kept);
  }

  void join_along_sheet(std::uint32_t p, std::uint32_t q, const Vec3& d) {
    const Slab &a = place(p).slab, &b = place(q).slab;
    const double cosine = dot(a.normal, b.normal), sign = cosine < 0 ? -1 : 1;
    if (place(p).material != place(q).material || std::abs(cosine) < kLeastCosine) return;
    if (std::abs(a.height(0.5 * d) - sign * b.height(-0.5 * d)) > kMostStep) return;
    const std::uint32_t turned = sign < 0 ? 1 : 0;
    sets_.join(2 * p, 2 * q + turned);
    sets_.join(2 * p + 1, 2 * q + (1 - turned));
  }

  /// Whether a place is in a cell that holds nothing of the sheet.
  [[nodiscard]] bool is_beside(std::uint32_t p) const {
    return place(p).is_beside({}, data_.fractions[values_.material(place(p).material)][place(p).site]);
  }
  /// The side on which a place in such a cell is.
  [[nodiscard]] std::uint32_t home(std::uint32_t p) const {
    return 2 * p + (place(p).slab.offset > 0 ? 1 : 0);
  }

  void join_through_cells(std::uint32_t p, std::uint32_t q) {
    if (is_beside(p) && is_beside(q)) sets_.join(home(p), home(q));
  }

  /// The cells of the box that two sites beside each other span hold together so much of a material.
  [[nodiscard]] double held_between(std::size_t site, const Vec3& d, std::uint16_t material) const {
    const SiteArray<float>& fractions = data_.fractions[values_.material(material)];
    double sum = static_cast<double>(fractions[site]);
    grid_sites_.for_each_neighbour(site, [&](std::size_t other, int di, int dj, int dk) {
      const auto within = [](int step, double end) { return step == 0 || static_cast<double>(step) == end; };
      if (within(di, d.x) && within(dj, d.y) && within(dk, d.z)) sum += static_cast<double>(fractions[other]);
    });
    return sum;
  }

  /// Between two cells without it there is no sheet if those between them hold next to nothing of it: where
  /// the two are on two sides of one it has ended.
  void drop_ends() {
    std::vector<char> ended(sheets_.places.size(), 0);
    for_each_pair([&](std::uint32_t p, std::uint32_t q, const Vec3& d) {
      if (!is_beside(p) || !is_beside(q) || sets_.find(home(p)) == sets_.find(home(q))) return;
      if (held_between(place(p).site, d, place(p).material) < kLeastBetween * place(p).slab.thickness)
        ended[p] = ended[q] = 1;
    });
    for (std::uint32_t p = 0; p < ended.size(); ++p) {
      SheetPlace& dropped = sheets_.places[p];
      dropped.regions = {ended[p] != 0 ? kNone : sets_.find(2 * p),
                         ended[p] != 0 ? kNone : sets_.find(2 * p + 1)};
    }
    std::erase_if(sheets_.places, [](const SheetPlace& p) { return p.regions[0] == kNone; });
  }

  void number() {
    std::vector<std::uint32_t> number_of;
    for (SheetPlace& p : sheets_.places) {
      for (std::uint32_t& region : p.regions) {
        if (number_of.size() <= region) number_of.resize(region + std::size_t{1}, kNone);
        if (number_of[region] == kNone) number_of[region] = static_cast<std::uint32_t>(sheets_.regions++);
        region = number_of[region];
      }
    }
  }

  const MultiMaterialData& data_;
  const SiteValues& values_;
  GridSites grid_sites_;
  ThinSheets& sheets_;
  SideSets sets_;
  std::vector<std::uint32_t> place_of_;
};

}  // namespace

void join_regions(const MultiMaterialData& data, const SiteValues& values, ThinSheets& sheets) {
  RegionSearch(data, values, sheets).run();
}

}  // namespace adamas::interfaces
