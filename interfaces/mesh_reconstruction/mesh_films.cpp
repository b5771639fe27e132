#include "interfaces/mesh_reconstruction/mesh_films.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/parallel.h"
#include "interfaces/mesh_reconstruction/mesh_held_cells.h"

namespace adamas::interfaces {

namespace {

using Index = MeshSubdivision::Index;
using Entry = MeshValues::Entry;

constexpr std::uint32_t kNone = 0xffffffffu;
/// A film has cells without it beside at least this part of its cells, and layers of their own fit at least
/// kLeastFitted of these.
constexpr double kLeastThin = 0.9, kLeastFitted = 0.4;
/// A film has at least so many cells.
constexpr std::size_t kLeastCells = 12;
/// Layers are continued to so many rings of cells: to as many as values of points depend on, and those
/// beside.
constexpr int kRings = 3;
/// Layers whose normals have a cosine below this belong to different parts of a film.
constexpr double kAlike = 0.5;

/// A cell holds as much of what lies on the sides of a layer as is there, up to this part of the cell.
constexpr double kMostOff = 0.15;

bool is_held(const Entry& entry) { return entry.fraction > kFractionTrace; }

double fraction_of(const MeshValues& values, Index cell, std::uint16_t material) {
  for (const Entry& entry : values.at(cell)) {
    if (entry.material == material) return static_cast<double>(entry.fraction);
  }
  return 0;
}

}  // namespace

class MeshFilms::Search {
 public:
  Search(MeshFilms& films, MeshValues& values)
      : films_(films), values_(values), subdivision_(values.subdivision()), mesh_(subdivision_.mesh()) {}

  void run() {
    find_candidates();
    // Without one of them others may separate nothing.
    for (bool changed = true; changed && !candidates_.empty();) {
      mark();
      find_regions();
      find_sides();
      changed = std::erase_if(candidates_,
                              [this](const Candidate& candidate) { return !separates(candidate); }) > 0;
    }
    if (candidates_.empty()) return films_.in_film_.clear();
    for (int ring = 0; ring < kRings; ++ring) continue_layers();
    divide_materials();
    for (Index c = 0; c < mesh_.cell_count(); ++c) {
      if (layer_of_[c] != kNone) films_.layers_.emplace_back(c, layers_[layer_of_[c]]);
    }
  }

 private:
  /// Connected cells that may be those of a film, and the layers that fit there.
  struct Candidate {
    std::uint16_t film;
    std::vector<Index> cells;
    std::vector<std::optional<MeshLayer>> layers;
  };

  static bool are_enough(std::size_t layers, const Candidate& candidate) {
    return static_cast<double>(layers) >= kLeastFitted * static_cast<double>(candidate.cells.size());
  }

  /// Fits layers to the cells of materials that are thin everywhere.
  void find_candidates() {
    const MeshHeldCells held(values_);
    const std::vector<Index>& active = values_.active_cells();
    for (std::uint32_t group = 0; group < held.group_count(); ++group) {
      const auto places = held.places(group);
      if (places.size() < kLeastCells) continue;
      Candidate found{values_.at(active[places[0].n])[places[0].entry].material, {}, {}};
      for (const auto& place : places) found.cells.push_back(active[place.n]);
      std::vector<char> is_thin(found.cells.size());
      parallel_for(is_thin.size(), 64,
                   [&](std::size_t i) { is_thin[i] = has_others_round(found.cells[i], found.film) ? 1 : 0; });
      if (static_cast<double>(std::ranges::count(is_thin, 1)) <
          kLeastThin * static_cast<double>(is_thin.size()))
        continue;
      found.layers.resize(found.cells.size());
      parallel_for(found.layers.size(), 4,
                   [&](std::size_t i) { found.layers[i] = layer_at(found.cells[i], found.film); });
      const auto fitted =
          std::ranges::count_if(found.layers, [](const auto& layer) { return layer.has_value(); });
      if (are_enough(static_cast<std::size_t>(fitted), found)) candidates_.push_back(std::move(found));
    }
  }

  /// Marks the cells of candidates, and the layers there.
  void mark() {
    films_.in_film_.assign(mesh_.cell_count(), 0);
    layer_of_.assign(mesh_.cell_count(), kNone);
    layers_.clear();
    numbers_.clear(), with_region_.clear(), added_.clear(), whole_of_.clear();
    for (const Candidate& candidate : candidates_) {
      for (std::size_t i = 0; i < candidate.cells.size(); ++i) {
        const Index c = candidate.cells[i];
        // What two films share is left as it is.
        if (std::exchange(films_.in_film_[c], 1) != 0) {
          layer_of_[c] = kNone;
        } else if (candidate.layers[i]) {
          add(c, {*candidate.layers[i], candidate.film, {}});
        }
      }
    }
  }

  [[nodiscard]] bool separates(const Candidate& candidate) const {
    const auto layers =
        std::ranges::count_if(candidate.cells, [this](Index c) { return layer_of_[c] != kNone; });
    return are_enough(static_cast<std::size_t>(layers), candidate);
  }

  void add(Index cell, const Layer& layer) {
    layer_of_[cell] = static_cast<std::uint32_t>(layers_.size());
    layers_.push_back(layer);
  }

  /// Returns whether a cell without the film lies round a cell.
  [[nodiscard]] bool has_others_round(Index cell, std::uint16_t film) const {
    thread_local std::vector<Index> ring;
    subdivision_.find_ring(std::array{cell}, ring);
    return std::ranges::any_of(ring,
                               [&](Index c) { return fraction_of(values_, c, film) <= kFractionTrace; });
  }

  [[nodiscard]] std::optional<MeshLayer> layer_at(Index cell, std::uint16_t film) const {
    thread_local std::vector<Index> ring;
    thread_local std::vector<double> fractions;
    if (!(mesh_.cell_volume(cell) > 0)) return {};
    subdivision_.find_ring(std::array{cell}, ring);
    fractions.clear();
    for (const Index c : ring) fractions.push_back(fraction_of(values_, c, film));
    return fit_layer(subdivision_, cell, ring, fractions);
  }

  /// Finds what lies on the two sides of layers: materials of cells outside of films, and the connected parts
  /// of their regions there. Layers with the same on both sides, as at the rim of a film, are dropped, and
  /// those whose cells do not hold what would lie on their sides.
  void find_sides() {
    std::vector<std::array<std::uint32_t, 2>> sides(mesh_.cell_count(), {kNone, kNone});
    parallel_for(mesh_.cell_count(), 64, [&](std::size_t c) {
      if (layer_of_[c] != kNone) sides[c] = sides_at(static_cast<Index>(c));
    });
    std::vector<Layer> kept;
    for (Index c = 0; c < mesh_.cell_count(); ++c) {
      if (layer_of_[c] == kNone) continue;
      Layer layer = layers_[layer_of_[c]];
      layer_of_[c] = kNone;
      const auto [above, below] = sides[c];
      if (above == kNone || below == kNone || above == below || !fits(c, layer, above, below)) continue;
      layer.sides = {number_of(above), number_of(below)};
      layer_of_[c] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(layer);
    }
    layers_ = std::move(kept);
  }

  /// Returns whether a cell holds about as much of the materials of two regions as lies beyond a layer.
  [[nodiscard]] bool fits(Index cell, const Layer& layer, std::uint32_t above, std::uint32_t below) const {
    const LayerParts parts = parts_of_cell(subdivision_, cell, layer.layer, mesh_.cell_center(cell));
    const double rest = 1 - parts.inside - parts.above;
    const std::uint16_t first = material_of_region(above), second = material_of_region(below);
    if (first == second) return true;
    return std::abs(fraction_of(values_, cell, first) - parts.above) <= kMostOff &&
           std::abs(fraction_of(values_, cell, second) - rest) <= kMostOff;
  }

  [[nodiscard]] std::uint16_t material_of_region(std::uint32_t region) const {
    const auto cell = static_cast<Index>(std::ranges::upper_bound(firsts_, region) - firsts_.begin() - 1);
    return std::as_const(values_).at(cell)[region - firsts_[cell]].material;
  }

  /// Finds the connected parts of materials' regions outside of films; cells are connected by faces.
  void find_regions() {
    firsts_.assign(1, 0);
    for (Index c = 0; c < mesh_.cell_count(); ++c)
      firsts_.push_back(firsts_.back() + static_cast<std::uint32_t>(values_.at(c).size()));
    DisjointSets sets(firsts_.back());
    for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
      const auto [a, b] = mesh_.cells_of_face(f);
      if (b == PolyhedralMesh::kNone || films_.in_film_[a] != 0 || films_.in_film_[b] != 0) continue;
      const auto of_a = std::as_const(values_).at(a), of_b = std::as_const(values_).at(b);
      for (std::uint32_t i = 0; i < of_a.size(); ++i) {
        if (!is_held(of_a[i])) continue;
        const auto found = std::ranges::find(of_b, of_a[i].material, &Entry::material);
        if (found != of_b.end() && is_held(*found))
          sets.join(firsts_[a] + i, firsts_[b] + static_cast<std::uint32_t>(found - of_b.begin()));
      }
    }
    regions_ = std::move(sets).roots();
  }

  /// Returns the regions that most cells within two rings have on either side of a cell's layer.
  [[nodiscard]] std::array<std::uint32_t, 2> sides_at(Index cell) const {
    thread_local std::vector<Index> ring, wider;
    const MeshLayer& layer = layers_[layer_of_[cell]].layer;
    subdivision_.find_ring(std::array{cell}, ring);
    subdivision_.find_ring(ring, wider);
    std::array<std::map<std::uint32_t, double>, 2> counts;
    for (const Index c : wider) {
      if (films_.in_film_[c] != 0) continue;
      const Vec3 d = mesh_.cell_center(c) - mesh_.cell_center(cell);
      const double height = layer.height(d);
      const std::span<const Entry> own = std::as_const(values_).at(c);
      const auto most = std::ranges::max_element(own, {}, &Entry::fraction);
      counts[height > 0 ? 0 : 1][regions_[firsts_[c] + static_cast<std::uint32_t>(most - own.begin())]] +=
          std::abs(height) / squared_norm(d);
    }
    std::array<std::uint32_t, 2> result{kNone, kNone};
    for (std::size_t side = 0; side < 2; ++side) {
      double most = 0;
      for (const auto& [region, count] : counts[side]) {
        if (count > most) most = count, result[side] = region;
      }
    }
    return result;
  }

  /// Returns the number of a region beside a film, which is that of its material for the first region of a
  /// material, and a new one for others.
  std::uint16_t number_of(std::uint32_t region) {
    const auto known = numbers_.find(region);
    if (known != numbers_.end()) return known->second;
    const std::uint16_t material = material_of_region(region);
    std::uint16_t number = material;
    if (!with_region_.insert(material).second) {
      number = static_cast<std::uint16_t>(values_.material_count() + added_.size());
      added_.push_back(values_.material(material));
      whole_of_.push_back(material);
    }
    numbers_.emplace(region, number);
    return number;
  }

  /// Gives what lies on different sides of films numbers of its own.
  void divide_materials() {
    if (added_.empty()) return;
    std::vector<std::vector<std::pair<std::uint16_t, float>>> held(mesh_.cell_count());
    parallel_for(held.size(), 256, [&](std::size_t c) {
      const std::span<const Entry> own = std::as_const(values_).at(c);
      for (std::uint32_t e = 0; e < own.size(); ++e) {
        if (own[e].fraction > 0) divide(static_cast<Index>(c), e, held[c]);
      }
    });
    values_.divide(added_, held);
  }

  /// Adds what a cell holds of a material, by number of the regions.
  void divide(Index cell, std::uint32_t e, std::vector<std::pair<std::uint16_t, float>>& held) const {
    const Entry& entry = std::as_const(values_).at(cell)[e];
    if (films_.in_film_[cell] == 0) {
      const auto number = numbers_.find(regions_[firsts_[cell] + e]);
      return held.emplace_back(number == numbers_.end() ? entry.material : number->second, entry.fraction),
             void();
    }
    const auto is_of_material = [&](std::uint16_t number) { return material_of(number) == entry.material; };
    std::optional<Layer> layer;
    if (layer_of_[cell] != kNone) layer = layers_[layer_of_[cell]];
    if (layer && is_of_material(layer->sides[0]) && is_of_material(layer->sides[1])) {
      const LayerParts parts = parts_of_cell(subdivision_, cell, layer->layer, mesh_.cell_center(cell));
      const double below = std::max(0.0, 1 - parts.inside - parts.above), both = parts.above + below;
      const float above = both > 0 ? static_cast<float>(parts.above / both) : 0.5f;
      if (above > 0) held.emplace_back(layer->sides[0], above * entry.fraction);
      if (above < 1) held.emplace_back(layer->sides[1], (1 - above) * entry.fraction);
      return;
    }
    held.emplace_back(number_round(cell, entry.material), entry.fraction);
  }

  [[nodiscard]] std::uint16_t material_of(std::uint16_t number) const {
    return number < values_.material_count() ? number : whole_of_[number - values_.material_count()];
  }

  /// Returns the number that most cells round a cell have for a material.
  [[nodiscard]] std::uint16_t number_round(Index cell, std::uint16_t material) const {
    thread_local std::vector<Index> ring;
    subdivision_.find_ring(std::array{cell}, ring);
    std::map<std::uint16_t, double> counts;
    for (const Index c : ring) {
      if (films_.in_film_[c] != 0) continue;
      const std::span<const Entry> there = std::as_const(values_).at(c);
      for (std::uint32_t e = 0; e < there.size(); ++e) {
        if (there[e].material != material || !is_held(there[e])) continue;
        const auto number = numbers_.find(regions_[firsts_[c] + e]);
        const Vec3 d = mesh_.cell_center(c) - mesh_.cell_center(cell);
        counts[number == numbers_.end() ? material : number->second] +=
            static_cast<double>(there[e].fraction) / squared_norm(d);
      }
    }
    std::uint16_t result = material;
    double most = 0;
    for (const auto& [number, count] : counts) {
      if (count > most) most = count, result = number;
    }
    return result;
  }

  /// Continues layers to the cells round those that have one.
  void continue_layers() {
    std::vector<std::optional<Layer>> found(mesh_.cell_count());
    parallel_for(found.size(), 64, [&](std::size_t c) {
      if (layer_of_[c] == kNone) found[c] = continued(static_cast<Index>(c));
    });
    for (Index c = 0; c < found.size(); ++c) {
      if (found[c]) add(c, *found[c]);
    }
  }

  /// Returns the mean of the layers round a cell that are alike the nearest one of these.
  [[nodiscard]] std::optional<Layer> continued(Index cell) const {
    thread_local std::vector<Index> ring;
    subdivision_.find_ring(std::array{cell}, ring);
    const Layer* nearest = nullptr;
    double least = 0;
    for (const Index c : ring) {
      if (layer_of_[c] == kNone) continue;
      const double squared = squared_norm(mesh_.cell_center(c) - mesh_.cell_center(cell));
      if (nearest == nullptr || squared < least) nearest = &layers_[layer_of_[c]], least = squared;
    }
    if (nearest == nullptr) return {};
    Layer result = *nearest;
    result.layer = {};
    double weights = 0;
    for (const Index c : ring) {
      if (layer_of_[c] == kNone) continue;
      const Layer& other = layers_[layer_of_[c]];
      if (other.film != nearest->film) continue;
      const double turn = other.sides == nearest->sides ? 1 : -1;
      if (turn < 0 && (other.sides[0] != nearest->sides[1] || other.sides[1] != nearest->sides[0])) continue;
      const Vec3 normal = turn * other.layer.normal;
      if (dot(normal, nearest->layer.normal) < kAlike) continue;
      const Vec3 d = mesh_.cell_center(cell) - mesh_.cell_center(c);
      const double squared = squared_norm(d), w = 1 / (squared * squared);
      result.layer.normal += w * normal;
      result.layer.middle -= w * turn * other.layer.height(d);
      result.layer.thickness += w * other.layer.thickness;
      for (std::size_t i = 0; i < 6; ++i) result.layer.bend[i] += w * turn * other.layer.bend[i];
      weights += w;
    }
    if (!(weights > 0) || !std::isfinite(weights)) return {};
    result.layer.normal = normalized(result.layer.normal);
    result.layer.middle /= weights;
    result.layer.thickness /= weights;
    for (double& bend : result.layer.bend) bend /= weights;
    return result;
  }

  MeshFilms& films_;
  MeshValues& values_;
  const MeshSubdivision& subdivision_;
  const PolyhedralMesh& mesh_;
  std::vector<Candidate> candidates_;
  std::vector<Layer> layers_;
  std::vector<std::uint32_t> layer_of_;             // by cell, or kNone
  std::vector<std::uint32_t> firsts_, regions_;     // by cell: its first entry; by entry
  std::map<std::uint32_t, std::uint16_t> numbers_;  // by region beside a film
  std::set<std::uint16_t> with_region_;             // materials that have such a region
  std::vector<MaterialId> added_;
  std::vector<std::uint16_t> whole_of_;  // by added number: that of the whole material
};

MeshFilms::MeshFilms(MeshValues& values) { Search(*this, values).run(); }

void MeshFilms::set_values(MeshValues& values) const {
  const PolyhedralMesh& mesh = values.subdivision().mesh();
  for (const auto& each : layers_) {
    const Index cell = each.first;
    const Layer& layer = each.second;
    double height = layer.layer.height({});
    const double half = 0.5 * layer.layer.thickness, size = values.size(cell);
    const std::span<Entry> own = values.at(cell);
    // Cells that the film does not reach lie beyond its faces.
    if (in_film_[cell] == 0) {
      const auto most = std::ranges::max_element(own, {}, &Entry::fraction);
      const double least = half + inner_radius(mesh, cell);
      if (most->material == layer.sides[0])
        height = std::max(height, least);
      else if (most->material == layer.sides[1])
        height = std::min(height, -least);
      else
        continue;
    }
    const double of_film = half - std::abs(height);
    const auto is_third = [&](const Entry& entry) {
      return entry.material != layer.film && entry.material != layer.sides[0] &&
             entry.material != layer.sides[1];
    };
    // What ends at a third material is no farther from its boundary than that.
    double most = std::numeric_limits<double>::infinity();
    for (const Entry& entry : own) {
      if (is_third(entry) && !values.is_part(entry.material)) most = std::min(most, -entry.value);
    }
    for (Entry& entry : own) {
      if (entry.material == layer.film) {
        entry.value = std::min(of_film, most);
      } else if (entry.material == layer.sides[0]) {
        entry.value = std::min(of_film + 2 * (height - half), most);
      } else if (entry.material == layer.sides[1]) {
        entry.value = std::min(of_film + 2 * (-height - half), most);
      } else if (values.is_part(entry.material)) {
        entry.value = -4 * size;
      }
    }
  }
}

}  // namespace adamas::interfaces
