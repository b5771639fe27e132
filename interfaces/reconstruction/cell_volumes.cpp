#include "interfaces/reconstruction/cell_volumes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/sort_unique.h"
#include "core/geometry/divider.h"

namespace adamas::interfaces {

CellVolumes::CellVolumes(const RectilinearGrid& grid, const SiteValues& values, const SiteCells& cells)
    : grid_(grid), grid_sites_(grid), values_(values), cells_(cells) {
  const auto nx = static_cast<std::ptrdiff_t>(grid.sites(0)), ny = static_cast<std::ptrdiff_t>(grid.sites(1));
  for (std::size_t n = 0; n < SiteCell::kNeighbours; ++n) {
    const auto i = static_cast<std::ptrdiff_t>(n % 3) - 1, j = static_cast<std::ptrdiff_t>(n / 3 % 3) - 1,
               k = static_cast<std::ptrdiff_t>(n / 9) - 1;
    offsets_[n] = i + nx * (j + ny * k);
  }
}

void CellVolumes::set_site(std::size_t site) {
  place_ = grid_sites_.indices(site);
  cell_ = &cells_.at(place_[0], place_[1], place_[2], scratch_);
  find_neighbours(site);
  find_rows(site);
  values_round_.resize(count_), entries_.resize(count_), values_at_nodes_.resize(count_),
      volumes_.resize(count_);
  if (is_inside_ && !values_.has_regions()) return set_values_inside();
  for (auto& row : values_round_) row.fill(values_.far_value());
  for (auto& row : entries_) row.fill(kNone);
  is_pure_.assign(count_, NeighbourSet().set());
  is_whole_value_.assign(count_, NeighbourSet());
  const SiteValues::Entry* all = values_.entries().data();
  for (std::size_t n = 0; n < SiteCell::kNeighbours; ++n) {
    if (neighbours_[n] == kNoSite) continue;
    const std::span<const SiteValues::Entry> there = values_.at(neighbours_[n]);
    const SiteValues::Entry *entry = there.data(), *end = entry + there.size();
    for (std::size_t m = 0; m < count_; ++m) {
      const std::uint16_t number = numbers_[m];
      while (entry != end && entry->material < number) ++entry;
      const SiteValues::Entry* found = entry;
      if (found == end || found->material != number) {
        const std::uint16_t whole = values_.material_number(number);
        if (whole == number) continue;
        found = std::find_if(there.data(), end, [&](const auto& e) { return e.material == whole; });
        if (found == end) continue;
        is_whole_value_[m][n] = true;
      }
      values_round_[m][n] = found->value;
      entries_[m][n] = static_cast<std::uint32_t>(found - all);
      if (!found->is_pure()) is_pure_[m][n] = false;
    }
  }
}

bool CellVolumes::has_the_same_materials(std::span<const SiteValues::Entry> there) const {
  return there.size() == count_ &&
         std::equal(there.begin(), there.end(), numbers_.begin(),
                    [](const SiteValues::Entry& entry, std::uint16_t m) { return entry.material == m; });
}

/// Looks up the values round a site all of whose neighbours exist, where no material has regions.
void CellVolumes::set_values_inside() {
  const SiteValues::Entry* all = values_.entries().data();
  for (std::size_t n = 0; n < SiteCell::kNeighbours; ++n) {
    const std::span<const SiteValues::Entry> there = values_.at(neighbours_[n]);
    const SiteValues::Entry *entry = there.data(), *end = entry + there.size();
    if (has_the_same_materials(there)) {
      for (std::size_t m = 0; m < count_; ++m) {
        values_round_[m][n] = entry[m].value;
        entries_[m][n] = static_cast<std::uint32_t>(entry + m - all);
      }
      continue;
    }
    for (std::size_t m = 0; m < count_; ++m) {
      while (entry != end && entry->material < numbers_[m]) ++entry;
      const bool found = entry != end && entry->material == numbers_[m];
      values_round_[m][n] = found ? entry->value : values_.far_value();
      entries_[m][n] = found ? static_cast<std::uint32_t>(entry - all) : kNone;
    }
  }
}

/// Finds the rows of a site's materials. A material with regions at the site or beside it has one row for
/// each region instead of one for itself.
void CellVolumes::find_rows(std::size_t site) {
  materials_.clear();
  numbers_.clear();
  materials_of_rows_.clear();
  for (const SiteValues::Entry& entry : values_.at(site)) {
    const std::uint16_t whole = values_.material_number(entry.material);
    const auto known = std::find_if(materials_.begin(), materials_.end(),
                                    [&](const Material& m) { return m.number == whole; });
    const auto fraction = static_cast<double>(entry.fraction);
    if (known == materials_.end())
      materials_.push_back({whole, fraction});
    else
      known->fraction = std::max(known->fraction, fraction);
    numbers_.push_back(entry.material);
  }
  if (values_.has_regions()) {
    std::sort(materials_.begin(), materials_.end(),
              [](const Material& a, const Material& b) { return a.number < b.number; });
    const auto belongs = [&](std::uint16_t number) {
      return std::any_of(materials_.begin(), materials_.end(),
                         [&](const Material& m) { return m.number == values_.material_number(number); });
    };
    for (std::size_t n = 0; n < SiteCell::kNeighbours; ++n) {
      if (neighbours_[n] == kNoSite) continue;
      for (const SiteValues::Entry& entry : values_.at(neighbours_[n])) {
        if (values_.material_number(entry.material) != entry.material && belongs(entry.material))
          numbers_.push_back(entry.material);
      }
    }
    sort_unique(numbers_);
    std::erase_if(numbers_, [&](std::uint16_t number) {
      return std::any_of(numbers_.begin(), numbers_.end(), [&](std::uint16_t region) {
        return region != number && values_.material_number(region) == number;
      });
    });
  }
  count_ = numbers_.size();
  for (const std::uint16_t number : numbers_) {
    const auto found = std::find_if(materials_.begin(), materials_.end(), [&](const Material& m) {
      return m.number == values_.material_number(number);
    });
    materials_of_rows_.push_back(static_cast<std::size_t>(found - materials_.begin()));
  }
}

void CellVolumes::store_values() {
  stored_values_.resize(count_);
  for (std::size_t row = 0; row < count_; ++row) stored_values_[row] = value_at_site(row);
}

void CellVolumes::move_values(std::size_t m, double by, double most) {
  for (std::size_t row = 0; row < count_; ++row) {
    if (materials_of_rows_[row] != m || (count_ > materials_.size() && is_pure_[row][SiteCell::kSelf]))
      continue;
    values_round_[row][SiteCell::kSelf] = std::clamp(
        stored_values_[row] + by, std::min(-most, stored_values_[row]), std::max(most, stored_values_[row]));
  }
}

double CellVolumes::greatest_difference() const {
  const std::vector<double>& volumes = count_ == materials_.size() ? volumes_ : material_volumes_;
  double greatest = 0;
  for (std::size_t m = 0; m < materials_.size(); ++m)
    greatest = std::max(greatest, std::abs(volumes[m] - materials_[m].fraction));
  return greatest;
}

/// Finds the site itself and its neighbours.
void CellVolumes::find_neighbours(std::size_t site) {
  is_inside_ = true;
  for (std::size_t a = 0; a < 3; ++a)
    is_inside_ = is_inside_ && place_[a] > 0 && place_[a] + 1 < grid_.sites(static_cast<int>(a));
  if (is_inside_) {
    for (std::size_t n = 0; n < SiteCell::kNeighbours; ++n)
      neighbours_[n] = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(site) + offsets_[n]);
    at_border_ = false;
    return;
  }
  neighbours_.fill(kNoSite);
  neighbours_[SiteCell::kSelf] = site;
  std::size_t count = 1;
  grid_sites_.for_each_neighbour(site, [&](std::size_t other, int di, int dj, int dk) {
    neighbours_[static_cast<std::size_t>(di + 1 + 3 * (dj + 1) + 9 * (dk + 1))] = other;
    ++count;
  });
  at_border_ = count < SiteCell::kNeighbours && grid_.centering == Centering::kCells;
}

const std::vector<double>& CellVolumes::measure(bool growth) {
  with_growth_ = growth;
  pairs_.clear();
  if (at_border_) extend();
  measure_rows();
  if (count_ == materials_.size()) return volumes_;
  material_volumes_.assign(materials_.size(), 0.0);
  for (std::size_t row = 0; row < count_; ++row) material_volumes_[materials_of_rows_[row]] += volumes_[row];
  return material_volumes_;
}

void CellVolumes::measure_rows() {
  std::fill(volumes_.begin(), volumes_.end(), 0.0);
  find_contenders();
  if (contenders_.size() == 1) {
    volumes_[contenders_[0]] = 1;
    return;
  }
  if (contenders_.size() == 2) {
    with_growth_ ? measure_two<true>(contenders_[0], contenders_[1])
                 : measure_two<false>(contenders_[0], contenders_[1]);
  } else {
    find_nodes();
    for (const SiteCell::Part& part : cell_->parts) measure_part(part);
  }
  if (at_border_) {
    for (Pair& pair : pairs_) fold(pair.growth);
  }
}

/// Leaves out rows that are nowhere round the cell above some other row; of equal rows the first one stays.
void CellVolumes::find_contenders() {
  contenders_.clear();
  for (std::size_t m = 0; m < count_; ++m) {
    bool out = false;
    for (std::size_t l = 0; l < count_ && !out; ++l) {
      if (l == m) continue;
      bool above = false, below = false;
      for (std::size_t n = 0; n < SiteCell::kNeighbours && !above; ++n) {
        above = values_round_[m][n] > values_round_[l][n];
        below = below || values_round_[m][n] < values_round_[l][n];
      }
      out = !above && (below || l < m);
    }
    if (!out) contenders_.push_back(m);
  }
}

/// Computes the volumes that two rows own if no other row owns a part of the cell.
template <bool kGrowth>
void CellVolumes::measure_two(std::size_t m, std::size_t n) {
  std::array<double, SiteCell::kNeighbours> above;
  for (std::size_t i = 0; i < above.size(); ++i) above[i] = values_round_[m][i] - values_round_[n][i];
  const std::size_t nodes = cell_->nodes.size();
  differences_at_nodes_.resize(nodes);
  is_positive_.resize(nodes);
  std::size_t positives = 0;
  for (std::size_t i = 0; i < nodes; ++i) {
    differences_at_nodes_[i] = cell_->nodes[i].interpolate(above);
    is_positive_[i] = differences_at_nodes_[i] > 0 ? 1 : 0;
    positives += is_positive_[i];
  }
  if (positives == 0 || positives == nodes) {
    volumes_[positives == 0 ? n : m] = cell_->volume;
    return;
  }
  if constexpr (kGrowth) growth_at_nodes_.assign(nodes, 0.0);
  double own = 0;
  for (const SiteCell::Part& part : cell_->parts) {
    const auto& [a, b, c, d] = part.nodes;
    const int positive = is_positive_[a] + is_positive_[b] + is_positive_[c] + is_positive_[d];
    if (positive == 4) own += part.volume;
    if (positive == 0 || positive == 4) continue;
    const Values corners{differences_at_nodes_[a], differences_at_nodes_[b], differences_at_nodes_[c],
                         differences_at_nodes_[d]};
    const PositivePart found = positive_part(corners);
    own += part.volume * found.volume;
    if constexpr (kGrowth) {
      for (std::size_t i = 0; i < 4; ++i) growth_at_nodes_[part.nodes[i]] += part.volume * found.growth[i];
    }
  }
  volumes_[m] = own;
  volumes_[n] = cell_->volume - own;
  if (!kGrowth || materials_of_rows_[m] == materials_of_rows_[n]) return;
  Pair& pair = pairs_.emplace_back(Pair{m, n, {}});
  for (std::size_t i = 0; i < nodes; ++i) {
    if (growth_at_nodes_[i] == 0) continue;
    const auto& [points, weights] = cell_->nodes[i];
    for (std::size_t c = 0; c < 4; ++c) pair.growth[points[c]] += growth_at_nodes_[i] * weights[c];
  }
}

/// Finds the values at the corners of the cell's parts, and the row with the greatest value at each.
void CellVolumes::find_nodes() {
  const std::size_t nodes = cell_->nodes.size();
  node_owners_.assign(nodes, 0);
  for (std::size_t m = 0; m < count_; ++m) {
    auto& row = values_at_nodes_[m];
    row.resize(nodes);
    for (std::size_t n = 0; n < nodes; ++n) {
      const double sum = row[n] = cell_->nodes[n].interpolate(values_round_[m]);
      if (sum > values_at_nodes_[node_owners_[n]][n]) node_owners_[n] = m;
    }
  }
}

double CellVolumes::border_step(int axis, bool high) const {
  const std::size_t n = grid_.sites(axis);
  if (n < 2) return 0;
  const auto& x = grid_.nodes[static_cast<std::size_t>(axis)];
  const double near = grid_.site_coordinate(axis, high ? n - 1 : 0),
               next = grid_.site_coordinate(axis, high ? n - 2 : 1);
  return ((high ? x.back() : x.front()) - near) / (near - next);
}

/// Calls visit(point, nearest, next, step) for the lattice points on the border along an axis, which continue
/// the values at the nearest and the next point.
template <class Visit>
void CellVolumes::for_each_border(Visit&& visit) const {
  std::size_t stride = 1;
  for (int axis = 0; axis < 3; ++axis, stride *= 3) {
    const std::size_t sites = grid_.sites(axis);
    for (const bool high : {false, true}) {
      if (place_[static_cast<std::size_t>(axis)] != (high ? sites - 1 : 0)) continue;
      const double step = border_step(axis, high);
      for (std::size_t n = 0; n < SiteCell::kNeighbours; ++n) {
        if (n / stride % 3 != (high ? 2u : 0u)) continue;
        const std::size_t nearest = high ? n - stride : n + stride;
        const std::size_t next = sites < 2 ? nearest : high ? n - 2 * stride : n + 2 * stride;
        visit(n, nearest, next, step);
      }
    }
  }
}

/// Continues values to the lattice points on the border of the domain, along one axis after another.
void CellVolumes::extend() {
  for_each_border([&](std::size_t n, std::size_t nearest, std::size_t next, double step) {
    for (std::size_t m = 0; m < count_; ++m) {
      auto& row = values_round_[m];
      is_pure_[m][n] = is_pure_[m][nearest];
      // A material's own value is not continued from that of one of its regions.
      is_whole_value_[m][n] = is_whole_value_[m][nearest];
      const bool apart = is_whole_value_[m][nearest] && !is_whole_value_[m][next];
      row[n] = continued(row[nearest], apart ? values_.far_value() : row[next], step, values_.far_value(),
                         is_pure_[m][n]);
    }
  });
}

/// Converts derivatives with respect to values at lattice points on the border into derivatives with respect
/// to values at sites. This is the transpose of extend().
void CellVolumes::fold(std::array<double, SiteCell::kNeighbours>& round) const {
  struct Step {
    std::size_t n, nearest, next;
    double step;
  };
  thread_local std::vector<Step> steps;
  steps.clear();
  for_each_border([&](std::size_t n, std::size_t nearest, std::size_t next, double step) {
    steps.push_back({n, nearest, next, step});
  });
  for (auto s = steps.rbegin(); s != steps.rend(); ++s) {
    const double growth = round[s->n];
    round[s->n] = 0;
    round[s->nearest] += (1 + s->step) * growth;
    round[s->next] -= s->step * growth;
  }
}

void CellVolumes::measure_part(const SiteCell::Part& part) {
  const std::size_t owner = node_owners_[part.nodes[0]];
  const bool whole = std::all_of(part.nodes.begin() + 1, part.nodes.end(),
                                 [&](std::uint16_t n) { return node_owners_[n] == owner; });
  if (!whole) return share(part);
  volumes_[owner] += part.volume;
}

/// Divides a part of the cell that belongs to several materials.
void CellVolumes::share(const SiteCell::Part& part) {
  // A row may own something if its greatest value is not below the least value of another row.
  double sure = -std::numeric_limits<double>::infinity();
  for (std::size_t m = 0; m < count_; ++m) {
    const Values v = at_corners(part, m);
    sure = std::max(sure, *std::min_element(v.begin(), v.end()));
  }
  contenders_.clear();
  for (std::size_t m = 0; m < count_; ++m) {
    const Values v = at_corners(part, m);
    if (*std::max_element(v.begin(), v.end()) >= sure) contenders_.push_back(m);
  }
  if (contenders_.size() > 2) drop_contenders_without_part(part);
  if (contenders_.size() == 2) {
    share_between_two(part, contenders_[0], contenders_[1]);
  } else {
    share_between_all(part);
  }
}

/// Keeps the contenders that own a corner or for which something is left when the regions of all others are
/// cut off.
void CellVolumes::drop_contenders_without_part(const SiteCell::Part& part) {
  for (std::size_t i = contenders_.size(); i-- > 0;) {
    const std::size_t m = contenders_[i];
    if (std::any_of(part.nodes.begin(), part.nodes.end(),
                    [&](std::uint16_t n) { return node_owners_[n] == m; }))
      continue;
    pieces_.assign(1, kWholeTetrahedron);
    for (const std::size_t l : contenders_) {
      if (l != m) keep_positive(difference(part, m, l), pieces_, scratch_pieces_);
    }
    if (pieces_.empty()) contenders_.erase(contenders_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

void CellVolumes::share_between_two(const SiteCell::Part& part, std::size_t m, std::size_t n) {
  const PositivePart found = positive_part(difference(part, m, n));
  volumes_[m] += part.volume * found.volume;
  volumes_[n] += part.volume * (1 - found.volume);
  if (with_growth_ && found.volume > 0 && found.volume < 1) add_growth(part, m, n, found.growth);
}

/// Divides the part between all contenders. For each pair, the region where both are above all others is
/// divided between the two: this gives the volume of the first and its derivatives.
void CellVolumes::share_between_all(const SiteCell::Part& part) {
  const std::size_t count = contenders_.size();
  double rest = 1;
  for (std::size_t m = 0; m + 1 < count; ++m) {
    double own = 0;
    // Without growth, one pair per contender is enough.
    for (std::size_t n = with_growth_ ? m + 1 : count - 1; n < count; ++n) {
      const PositivePart found = with_growth_ ? first_of_two<true>(part, contenders_[m], contenders_[n])
                                              : first_of_two<false>(part, contenders_[m], contenders_[n]);
      own = found.volume;
      if (with_growth_) add_growth(part, contenders_[m], contenders_[n], found.growth);
    }
    volumes_[contenders_[m]] += part.volume * own;
    rest -= own;
  }
  volumes_[contenders_.back()] += part.volume * rest;
}

/// Returns the volume that the first of two contenders owns of a part.
template <bool kGrowth>
PositivePart CellVolumes::first_of_two(const SiteCell::Part& part, std::size_t m, std::size_t n) {
  pieces_.assign(1, kWholeTetrahedron);
  for (const std::size_t l : contenders_) {
    if (l != m && l != n) keep_positive(difference(part, m, l), pieces_, scratch_pieces_);
  }
  return positive_part_of<kGrowth>(pieces_, difference(part, m, n));
}

void CellVolumes::add_growth(const SiteCell::Part& part, std::size_t m, std::size_t n, const Values& growth) {
  if (materials_of_rows_[m] == materials_of_rows_[n]) return;
  auto pair = std::find_if(pairs_.begin(), pairs_.end(),
                           [&](const Pair& p) { return p.first == m && p.second == n; });
  if (pair == pairs_.end()) pair = pairs_.insert(pair, {m, n, {}});
  for (std::size_t c = 0; c < 4; ++c) {
    const SiteCell::Node& node = cell_->nodes[part.nodes[c]];
    for (std::size_t i = 0; i < 4; ++i)
      pair->growth[node.points[i]] += part.volume * growth[c] * node.weights[i];
  }
}

}  // namespace adamas::interfaces
