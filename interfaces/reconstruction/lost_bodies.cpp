#include "interfaces/reconstruction/lost_bodies.h"

#include <algorithm>

#include "interfaces/reconstruction/cell_volumes.h"
#include "interfaces/reconstruction/grid_sites.h"

namespace adamas {

namespace {

using Entry = SiteValues::Entry;

/// In cells: what a group holds at least, and what counts as nothing.
constexpr double kLeastHeld = 1e-3, kNothing = 1e-12;

class LostBodySearch {
 public:
  LostBodySearch(const MultiMaterialData& data, const SiteValues& values, const SiteCells& cells)
      : values_(values),
        sites_(data.grid),
        cell_(data.grid, values, cells),
        seen_(values.entries().size(), 0) {}

  std::vector<LostBody> run() {
    std::vector<LostBody> lost;
    for (const std::uint32_t site : values_.mixed()) {
      for (const Entry& entry : values_.at(site)) {
        // Of regions one stands for the material.
        if (!holds(entry) || &entry != find(site, material(entry)) || seen_[index(entry)] != 0) continue;
        collect(site, entry);
        double held = 0;
        for (const auto& [at, fraction] : group_) held += fraction;
        if (held > kLeastHeld && !shows(material(entry))) lost.push_back(describe(material(entry)));
      }
    }
    return lost;
  }

 private:
  static bool holds(const Entry& entry) { return entry.fraction > kFractionTrace; }
  [[nodiscard]] std::size_t index(const Entry& entry) const {
    return static_cast<std::size_t>(&entry - values_.entries().data());
  }
  [[nodiscard]] std::uint16_t material(const Entry& entry) const { return values_.whole(entry.material); }
  /// The entry of a material, or of that region of it which has the greatest part.
  [[nodiscard]] const Entry* find(std::size_t site, std::uint16_t number) const {
    const Entry* found = nullptr;
    for (const Entry& entry : values_.at(site)) {
      if (material(entry) == number && (found == nullptr || entry.fraction > found->fraction)) found = &entry;
    }
    return found;
  }

  /// The cells that hang together with one.
  void collect(std::size_t site, const Entry& first) {
    group_.assign(1, {site, static_cast<double>(first.fraction)});
    seen_[index(first)] = 1;
    for (std::size_t next = 0; next < group_.size(); ++next) {
      sites_.for_each_neighbour(group_[next].first, [&](std::size_t other, int, int, int) {
        const Entry* entry = find(other, material(first));
        if (entry == nullptr || !holds(*entry) || seen_[index(*entry)] != 0) return;
        seen_[index(*entry)] = 1;
        group_.emplace_back(other, static_cast<double>(entry->fraction));
      });
    }
  }

  /// Whether a material owns a part of a cell of the group; whose a site is is asked first, for most show
  /// there.
  bool shows(std::uint16_t number) {
    const bool at_site = std::any_of(group_.begin(), group_.end(), [&](const auto& member) {
      const auto own = values_.at(member.first);
      const auto most = std::max_element(own.begin(), own.end(),
                                         [](const Entry& a, const Entry& b) { return a.value < b.value; });
      return material(*most) == number;
    });
    return at_site || std::any_of(group_.begin(), group_.end(), [&](const auto& member) {
             cell_.go_to(member.first);
             const std::vector<double>& volumes = cell_.measure();
             for (std::size_t m = 0; m < volumes.size(); ++m) {
               if (cell_.materials()[m].number == number && volumes[m] > kNothing) return true;
             }
             return false;
           });
  }

  [[nodiscard]] LostBody describe(std::uint16_t material) const {
    LostBody body{values_.material(material), 0, group_.size(), {}};
    for (const auto& [site, fraction] : group_) {
      const double volume = fraction * sites_.cell(site).volume();
      body.volume += volume;
      body.place += volume * sites_.cell(site).center();
    }
    body.place *= 1 / body.volume;
    return body;
  }

  const SiteValues& values_;
  GridSites sites_;
  CellVolumes cell_;
  std::vector<char> seen_;                             // by entry
  std::vector<std::pair<std::size_t, double>> group_;  // sites with their fractions
};

}  // namespace

std::vector<LostBody> find_lost_bodies(const MultiMaterialData& data, const SiteValues& values,
                                       const SiteCells& cells) {
  return LostBodySearch(data, values, cells).run();
}

}  // namespace adamas
