#include "interfaces/reconstruction/label_lattice.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/parallel.h"
#include "interfaces/reconstruction/grid_sites.h"

namespace adamas::interfaces {

namespace {

/// Other materials own no part of a tetrahedron if offsets differ by less than this part of the least value:
/// where four regions meet, each of four values is at least minus a half of it.
constexpr double kPlainSpread = 0.45;
/// A value that is less by this part of the greatest one is surely less.
constexpr double kSurely = 1e-9;
/// Spacings are even if the lengths of cells' sides along an axis differ by this factor at most: by two, as
/// those of points do at the border, but for coordinates that are rounded to floats or to some decimals.
constexpr double kEven = 2.001;
/// Lengths that differ by at most this part are equal.
constexpr double kRoundOff = 1e-12;

}  // namespace

LabelLattice::LabelLattice(const MultiMaterialData& data)
    : by_name_(materials_by_name(data.materials)), runs_(data, places_of(by_name_)) {
  set_geometry(data);
  offsets_.resize(by_name_.size());
  far_ = far_value(data.grid);
  std::array<double, 3> least{}, inner{};
  equal_sites_ = equal_cells_ = true;
  double shortest = std::numeric_limits<double>::infinity(), longest = shortest;
  for (std::size_t a = 0; a < 3; ++a) {
    least[a] = std::ranges::min(sides_[a]);
    even_spacing_ = even_spacing_ && std::ranges::max(sides_[a]) <= kEven * least[a];
    // Sites on the border have smaller cells in data of points.
    const std::size_t skip = margin_[a] != 0 ? 0 : 1;
    if (sides_[a].size() < 2 * skip + 2) {
      equal_sites_ = equal_cells_ = false;
      continue;
    }
    const auto [low, high] = std::minmax_element(sides_[a].begin() + static_cast<std::ptrdiff_t>(skip),
                                                 sides_[a].end() - static_cast<std::ptrdiff_t>(skip));
    inner[a] = *low;
    shortest = std::min(shortest, *low), longest = std::min(longest, *high);
    const auto& x = coordinates_[a];
    for (std::size_t i = 1; i + 2 < x.size(); ++i)
      equal_cells_ = equal_cells_ && std::abs(x[i + 1] - x[i] - (x[2] - x[1])) <= kRoundOff * (x[2] - x[1]);
  }
  equal_sites_ = equal_sites_ && longest - shortest <= kRoundOff * shortest;
  half_ = 0.5 * std::ranges::min(inner);
  least_half_ = 0.5 * std::ranges::min(least);
  update_plain();
}

LabelLattice::LabelLattice(const MultiMaterialData& data, SiteValues&& smoothed) : LabelLattice(data) {
  plain_ = false;
  far_ = smoothed.far_value();
  smoothed_.emplace(std::move(smoothed));
}

void LabelLattice::set_geometry(const MultiMaterialData& data) {
  const bool margin = data.grid.centering == Centering::kCells;
  const GridSites grid_sites(data.grid);
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const auto& nodes = data.grid.nodes[a];
    auto& x = coordinates_[a];
    sites_[a] = data.grid.sites(axis);
    margin_[a] = margin ? 1 : 0;
    if (margin) x.push_back(nodes.front()), sites_of_[a].push_back(0);
    for (std::size_t i = 0; i < sites_[a]; ++i) {
      x.push_back(data.grid.site_coordinate(axis, i));
      sites_of_[a].push_back(static_cast<std::uint32_t>(i));
      const std::size_t stride = a == 0 ? 1 : a == 1 ? sites_[0] : sites_[0] * sites_[1];
      sides_[a].push_back(grid_sites.cell(i * stride).size()[axis]);
    }
    if (margin) x.push_back(nodes.back()), sites_of_[a].push_back(static_cast<std::uint32_t>(sites_[a] - 1));
    if (!margin || sites_[a] < 2) continue;
    const std::size_t last = x.size() - 1;
    steps_[a] = {(x[0] - x[1]) / (x[1] - x[2]), (x[last] - x[last - 1]) / (x[last - 1] - x[last - 2])};
  }
}

void LabelLattice::update_plain() {
  inside_.clear(), outside_.clear();
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t m = 0; m < offsets_.size(); ++m) {
    const auto number = static_cast<std::uint16_t>(m);
    inside_.push_back(moved(half_, number));
    outside_.push_back(moved(-half_, number));
    low = std::min(low, moved(0, number));
    high = std::max(high, moved(0, number));
  }
  plain_ = !smoothed_ && equal_sites_ && high - low < kPlainSpread * half_;
}

bool LabelLattice::labels_stay() const {
  if (smoothed_) return true;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t m = 0; m < offsets_.size(); ++m) {
    low = std::min(low, moved(0, static_cast<std::uint16_t>(m)));
    high = std::max(high, moved(0, static_cast<std::uint16_t>(m)));
  }
  // Values at the border, which are continued from two sites, keep their signs if those at sites do.
  return high - low < kPlainSpread * 2 * least_half_;
}

void LabelLattice::shift(std::span<const double> offsets, double most) {
  if (smoothed_) {
    std::vector<SiteValues::Entry>& entries = smoothed_->entries();
    const double least = smoothed_->least_label_value();
    parallel_for(entries.size(), 1 << 14, [&](std::size_t e) {
      SiteValues::Entry& entry = entries[e];
      entry.value += std::clamp(offsets[entry.material], -most, most);
      entry.value = entry.fraction > 0 ? std::max(entry.value, least) : std::min(entry.value, -least);
    });
    return;
  }
  for (std::size_t m = 0; m < offsets_.size(); ++m)
    offsets_[m].push_back(std::clamp(offsets[m], -most, most));
  update_plain();
}

/// Returns whether a material has a value at a site: whether the site or one of its neighbours has its label.
/// `block`: that of labels round the site, or null.
bool LabelLattice::is_near(const Index& site, std::uint16_t number, const Block* block) const {
  const std::size_t low = site[0] - std::min(site[0], 1u),
                    high = std::min<std::size_t>(site[0] + 2, sites_[0]);
  std::array<std::uint16_t, 3> numbers{};
  std::span<const std::uint16_t> row(numbers.data(), high - low);
  for (std::size_t k = site[2] - std::min(site[2], 1u); k <= site[2] + 1 && k < sites_[2]; ++k) {
    for (std::size_t j = site[1] - std::min(site[1], 1u); j <= site[1] + 1 && j < sites_[1]; ++j) {
      if (block == nullptr) {
        runs_.read(low, j + sites_[1] * k, std::span(numbers).first(row.size()));
      } else {
        row = std::span(block->numbers[k - block->low[2]][j - block->low[1]])
                  .subspan(low - block->low[0], row.size());
      }
      if (std::ranges::find(row, number) != row.end()) return true;
    }
  }
  return false;
}

/// Returns the value of a material at a site. `block`: that of labels round the site, or null.
double LabelLattice::site_value(const Index& site, std::uint16_t number, const Block* block) const {
  if (smoothed_) {
    const auto* entry = find_entry(std::as_const(*smoothed_).at(site_index(site)), number);
    return entry == nullptr ? far_ : entry->value;
  }
  const double half = half_side(site);
  const std::uint16_t own = block == nullptr ? this->number(site[0], site[1], site[2]) : block->at(site);
  if (own == number) return moved(half, number);
  return is_near(site, number, block) ? moved(-half, number) : far_;
}

LabelLattice::Inwards LabelLattice::inwards(const Index& p, std::size_t axis) const {
  const bool low = p[axis] == 0;
  Inwards result{p, p, steps_[axis][low ? 0 : 1]};
  result.one[axis] = low ? 1 : p[axis] - 1;
  result.two[axis] = low ? 2 : p[axis] - 2;
  return result;
}

double LabelLattice::value(const Index& p, std::uint16_t number, const Block* block) const {
  // Values are continued along one axis after another, along the last one in the end.
  for (std::size_t a = 3; a-- > 0;) {
    if (!is_at_border(a, p[a])) continue;
    if (sites_[a] < 2) break;
    const auto [one, two, step] = inwards(p, a);
    return continued(value(one, number, block), value(two, number, block), step, far_, true);
  }
  return site_value(nearest_site(p), number, block);
}

double LabelLattice::share(const Index& p, std::uint16_t number) const {
  if (!smoothed_) return 1;
  for (std::size_t a = 3; a-- > 0;) {
    if (!is_at_border(a, p[a])) continue;
    if (sites_[a] < 2) break;
    const auto [one, two, step] = inwards(p, a);
    return (1 + step) * share(one, number) - step * share(two, number);
  }
  const auto* entry = find_entry(std::as_const(*smoothed_).at(site_index(nearest_site(p))), number);
  return entry != nullptr && std::abs(entry->value) > smoothed_->least_label_value() ? 1 : 0;
}

LabelLattice::Tetrahedron LabelLattice::tetrahedron(const Index& cell, std::size_t path,
                                                    const std::array<std::uint16_t, 4>& owners) {
  Tetrahedron result{{cell, cell, cell, cell}, owners};
  for (std::size_t step = 0; step < 3; ++step) {
    for (std::size_t c = step + 1; c < 4; ++c)
      ++result.corners[c][static_cast<std::size_t>(MaterialLattice::kPaths[path][step])];
  }
  return result;
}

LabelLattice::Tetrahedron LabelLattice::tetrahedron(const Index& cell, std::size_t path) const {
  Tetrahedron result = tetrahedron(cell, path, {});
  for (std::size_t c = 0; c < 4; ++c) result.owners[c] = owner(result.corners[c]);
  return result;
}

/// Returns the numbers of the sites from `low` to `high`, which are next to each other or the same along each
/// axis, and of those round them. At the border they are the same, and values are continued from them and the
/// next ones: those round these are added.
LabelLattice::Block LabelLattice::block_round(const Index& low, const Index& high) const {
  Block block{};
  Index count{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::uint32_t round = low[a] == high[a] ? 2 : 1;
    block.low[a] = low[a] - std::min(low[a], round);
    count[a] = std::min(high[a] + round, static_cast<std::uint32_t>(sites_[a]) - 1) - block.low[a] + 1;
  }
  for (std::uint32_t k = 0; k < count[2]; ++k) {
    for (std::uint32_t j = 0; j < count[1]; ++j)
      runs_.read(block.low[0], block.low[1] + j + sites_[1] * (block.low[2] + k),
                 std::span(block.numbers[k][j]).first(count[0]));
  }
  return block;
}

/// Calls add(number, value) for each material that has a value at a site, perhaps more than once. `block`:
/// that of labels round the site, where they are not smoothed.
template <class Add>
void LabelLattice::for_each_near(const Index& site, const Block& block, Add&& add) const {
  if (smoothed_) {
    for (const SiteValues::Entry& entry : std::as_const(*smoothed_).at(site_index(site)))
      add(entry.material, entry.value);
    return;
  }
  const double half = half_side(site);
  const Index at{site[0] - block.low[0], site[1] - block.low[1], site[2] - block.low[2]};
  const std::uint16_t own = block.at(site);
  add(own, moved(half, own));
  for (std::size_t k = at[2] - std::min(at[2], 1u); k <= at[2] + 1 && block.low[2] + k < sites_[2]; ++k) {
    for (std::size_t j = at[1] - std::min(at[1], 1u); j <= at[1] + 1 && block.low[1] + j < sites_[1]; ++j) {
      for (std::size_t i = at[0] - std::min(at[0], 1u); i <= at[0] + 1 && block.low[0] + i < sites_[0]; ++i) {
        const std::uint16_t other = block.numbers[k][j][i];
        if (other != own) add(other, moved(-half, other));
      }
    }
  }
}

void LabelLattice::find_materials(const Index& cell, CellMaterials& found) const {
  found.clear();
  const Block block =
      smoothed_ ? Block{}
                : block_round(nearest_site(cell), nearest_site({cell[0] + 1, cell[1] + 1, cell[2] + 1}));
  for (std::uint32_t c = 0; c < 8; ++c) {
    const Index p{cell[0] + (c & 1u), cell[1] + (c >> 1 & 1u), cell[2] + (c >> 2)};
    for_each_near(nearest_site(p), block, [&](std::uint16_t number, double value) {
      auto at = std::ranges::find_if(found, [&](const CellMaterial& m) { return m.number >= number; });
      if (at == found.end() || at->number != number) {
        at = found.insert(at, {number, 0, {}});
        at->values.fill(far_);
      }
      at->near |= static_cast<std::uint8_t>(1u << c);
      at->values[c] = value;
    });
    if (!is_at_border(0, p[0]) && !is_at_border(1, p[1]) && !is_at_border(2, p[2])) continue;
    for (CellMaterial& material : found) {
      if ((material.near >> c & 1u) != 0)
        material.values[c] = value(p, material.number, smoothed_ ? nullptr : &block);
    }
  }
}

std::array<std::uint8_t, 4> LabelLattice::cell_corners(std::size_t path) {
  const auto& steps = MaterialLattice::kPaths[path];
  const unsigned second = 1u << static_cast<unsigned>(steps[0]),
                 third = second | 1u << static_cast<unsigned>(steps[1]);
  return {0, static_cast<std::uint8_t>(second), static_cast<std::uint8_t>(third), 7};
}

void LabelLattice::find_owners(const std::array<std::uint16_t, 4>& owners,
                               std::vector<Candidate>& found) const {
  found.clear();
  for (const std::uint16_t number : owners) {
    const auto at =
        std::ranges::find_if(found, [&](const Candidate& other) { return other.number >= number; });
    if (at != found.end() && at->number == number) continue;
    Candidate& candidate = *found.insert(at, {number, {}});
    for (std::size_t c = 0; c < 4; ++c)
      candidate.values[c] = owners[c] == number ? inside_[number] : outside_[number];
  }
}

void LabelLattice::find_candidates(const Index& cell, std::size_t path,
                                   const std::array<std::uint16_t, 4>& owners,
                                   std::vector<Candidate>& found) const {
  if (is_plain(cell)) return find_owners(owners, found);
  CellMaterials materials;
  find_materials(cell, materials);
  find_candidates(materials, cell_corners(path), owners, found);
}

void LabelLattice::find_candidates(const CellMaterials& cell, const std::array<std::uint8_t, 4>& corners,
                                   const std::array<std::uint16_t, 4>& owners,
                                   std::vector<Candidate>& found) const {
  found.clear();
  unsigned bits = 0;
  for (const std::uint8_t corner : corners) bits |= 1u << corner;
  for (const CellMaterial& material : cell) {
    if ((material.near & bits) == 0) continue;
    const auto& v = material.values;
    found.push_back({material.number, {v[corners[0]], v[corners[1]], v[corners[2]], v[corners[3]]}});
  }
  if (found.size() < 3) return;
  const std::uint16_t a = owners[0];
  std::uint16_t b = a;
  for (const std::uint16_t owner : owners) {
    if (owner == a) continue;
    if (b != a && owner != b) return;
    b = owner;
  }
  // Two materials own the corners. They are equal on a polygon with corners on edges, where others are below
  // if they own no part.
  const Values va = std::ranges::find(found, a, &Candidate::number)->values,
               vb = std::ranges::find(found, b, &Candidate::number)->values;
  std::erase_if(found, [&](const Candidate& other) {
    if (other.number == a || other.number == b) return false;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        if (owners[i] == owners[j]) continue;
        const double di = va[i] - vb[i], dj = va[j] - vb[j], t = di / (di - dj);
        const double height = (1 - t) * va[i] + t * va[j],
                     below = (1 - t) * other.values[i] + t * other.values[j];
        if (!(below < height + kSurely * far_)) return false;
      }
    }
    return true;
  });
}

void LabelLattice::set_problem(std::span<const Candidate> candidates, OwnershipProblem& problem) {
  problem.clear();
  for (const Candidate& candidate : candidates) {
    problem.add_candidate(candidate.number);
    problem.add_function(candidate.values, candidate.number);
  }
}

}  // namespace adamas::interfaces
