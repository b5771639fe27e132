#include "interfaces/reconstruction/thin_sheets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/loop_progress.h"
#include "core/base/median.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

namespace {

using Entry = SiteValues::Entry;
constexpr std::uint32_t kNone = 0xffffffffu, kBeside = 0xfffffffeu;

/// A sheet's fit leaves out cells of which the sheet and the materials on its sides have less than this part.
constexpr double kLeastOfThree = 0.97;
/// Sheets are continued to this many rings of sites round those with a fit of their own; blurred sheets to
/// more rings, by their width.
constexpr int kRings = 2;
/// Layers continue each other if the cosine of their normals is at least kLeastCosine and their heights
/// differ by at most kMostStep cells.
constexpr double kLeastCosine = 0.7, kMostStep = 0.5;
/// A sheet may end at a cell if the places that continue it lie on one side: their middle is farther away
/// than this, in cells.
constexpr double kAside = 0.4;
/// It ends there if the cell should hold at least kMissing of it and has none. If the cell has less than
/// kHalf of what it should hold, the layer becomes thinner in proportion. Blurred fractions count as missing
/// only if they miss more than kAboveNoise times the noise.
constexpr double kMissing = 0.1, kHalf = 0.5, kAboveNoise = 2;
/// A sharp layer is accepted if the remaining differences are at most kExact of the fractions. kFailed stands
/// for no fit.
constexpr double kExact = 0.1, kFailed = std::numeric_limits<double>::infinity();
/// Only blurred layers cut at least this many of a cell's 26 neighbours.
constexpr int kDeep = 22;
/// Blurred layers of at most this width, in cells, count as sharp.
constexpr double kSharpWidth = 0.4;
/// Blurred sheets are sought where the greatest fraction nearby is from kLowest to kHighest and that of the
/// cell is at least kOfHighest of it.
constexpr double kLowest = 0.06, kHighest = 0.8, kOfHighest = 0.3;
/// Noise is estimated from cells with steps of at least kLeastWidth cells: from about kMostCells at most, and
/// only if there are kLeastCells.
constexpr double kLeastWidth = 0.8;
constexpr std::size_t kMostCells = 20000, kLeastCells = 100;

/// A sheet has at least this number of cells with layers fitted to the fractions round them, and these are at
/// least this part of the cells that hold some of it.
constexpr std::size_t kFewest = 12;
constexpr double kLeastFitted = 0.4, kLeastFittedBlurred = 0.04;

/// The part that fits of layers take of the time to find thin sheets.
constexpr double kFitShare = 0.8;

class SheetSearch {
 public:
  SheetSearch(const MultiMaterialData& data, const SiteValues& values)
      : data_(data),
        values_(values),
        sites_(data.grid),
        n_{static_cast<std::int64_t>(data.grid.sites(0)), static_cast<std::int64_t>(data.grid.sites(1)),
           static_cast<std::int64_t>(data.grid.sites(2))},
        noise_(data.materials.size(), 0) {}

  ThinSheets run() {
    for (std::uint16_t m = 0; m < noise_.size(); ++m) noise_[m] = noise(m);
    find_own();
    if (places_.empty()) return {};
    double widest = 0, noise = 0;
    std::size_t wide = 0;
    for (const SheetPlace& place : places_) {
      widest = std::max(widest, place.slab.width);
      if (place.slab.width >= kLeastWidth) noise += noise_[place.material], ++wide;
    }
    if (wide > 0) noise /= static_cast<double>(wide);
    const int rings = kRings + static_cast<int>(std::ceil(widest));
    for (int ring = 0; ring < rings; ++ring) add_ring(ring >= kRings);
    drop_unclear_sheets();
    find_inherited_sides();
    std::sort(places_.begin(), places_.end(),
              [](const SheetPlace& a, const SheetPlace& b) { return a.site < b.site; });
    return {std::move(places_), 0, noise};
  }

 private:
  [[nodiscard]] double fraction(std::uint16_t number, std::size_t site) const {
    return static_cast<double>(data_.fractions[values_.material(number)][site]);
  }

  [[nodiscard]] float own_fraction(const SheetPlace& place) const {
    return data_.fractions[values_.material(place.material)][place.site];
  }

  /// Returns the standard deviation of errors of a material's blurred fractions, from the products of second
  /// differences along all three axes, which nearly vanish for a blurred step.
  [[nodiscard]] double noise(std::uint16_t material) const {
    const auto& mixed = values_.mixed_sites();
    const std::size_t stride = mixed.size() / kMostCells + 1;
    std::vector<double> sizes;
    for (std::size_t n = 0; n < mixed.size(); n += stride) {
      const Entry* entry = find_entry(values_.at(mixed[n]), material);
      if (entry == nullptr || values_.width(*entry) < kLeastWidth * sites_.least_side(mixed[n])) continue;
      double sum = -8 * static_cast<double>(entry->fraction);
      int count = 0;
      sites_.for_each_neighbour(mixed[n], [&](std::size_t other, int di, int dj, int dk) {
        const double f = fraction(material, other);
        const int zeros = (di == 0 ? 1 : 0) + (dj == 0 ? 1 : 0) + (dk == 0 ? 1 : 0);
        sum += f * (zeros % 2 == 0 ? 1 : -1) * (1 << zeros);
        count += f > 0 && f < 1 ? 1 : 0;
      });
      if (count == 26) sizes.push_back(std::abs(sum));
    }
    if (sizes.size() < kLeastCells) return 0;
    return kDeviationByMedian * median(sizes) / std::sqrt(216.0);
  }

  /// Fits layers to the fractions round each mixed site.
  void find_own() {
    const auto& mixed = values_.mixed_sites();
    LoopProgress::begin_part(kFitShare, static_cast<double>(mixed.size()));
    places_ = parallel_collect<SheetPlace>(
        mixed.size(), 64, [&](std::size_t begin, std::size_t end, std::vector<SheetPlace>& list) {
          for (std::size_t n = begin; n < end; ++n) {
            std::optional<SheetPlace> found;
            for (const Entry& entry : values_.at(mixed[n])) {
              if (entry.fraction <= 0) continue;
              const auto place = fit(mixed[n], entry);
              if (place && (!found || place->slab.thickness < found->slab.thickness)) found = place;
            }
            if (found) list.push_back(*found);
          }
        });
  }

  /// Calls visit(cell, site) for the sites of a window round a site until it returns false; returns whether
  /// all were visited. Sites beyond the domain are left out, and every second one of a blurred layer's
  /// window, since half of the fractions are enough.
  template <class Visit>
  bool for_each_in_window(std::size_t site, int reach, const Visit& visit) const {
    const std::array<std::size_t, 3> p = sites_.indices(site);
    std::array<int, 3> least{}, most{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<std::int64_t>(p[axis]);
      least[axis] = static_cast<int>(std::max<std::int64_t>(-reach, -at));
      most[axis] = static_cast<int>(std::min<std::int64_t>(reach, n_[axis] - 1 - at));
    }
    const bool half = reach == SheetWindow::kBlurredReach;
    const int side = 2 * reach + 1;
    for (int dk = least[2]; dk <= most[2]; ++dk) {
      for (int dj = least[1]; dj <= most[1]; ++dj) {
        const auto row = static_cast<std::int64_t>(site) + n_[0] * (dj + n_[1] * dk);
        const int cell_of_row = reach + side * (dj + reach + side * (dk + reach));
        const int first = half && (least[0] + dj + dk) % 2 != 0 ? least[0] + 1 : least[0];
        for (int di = first; di <= most[0]; di += half ? 2 : 1) {
          if (!visit(static_cast<std::size_t>(cell_of_row + di), static_cast<std::size_t>(row + di)))
            return false;
        }
      }
    }
    return true;
  }

  /// Fits the layer of an entry's material at its site. Fractions that seem blurred may belong to a sharp
  /// layer, so the better fit of the two is taken.
  [[nodiscard]] std::optional<SheetPlace> fit(std::size_t site, const Entry& entry) const {
    double off = kFailed, off_blurred = kFailed;
    std::optional<SheetPlace> sharp;
    if (entry.width == 0 || !is_deep(site, entry.material)) {
      sharp = fit(site, entry.material, false, off);
      if (entry.width == 0 || (sharp && off < kExact)) return sharp;
    }
    if (!is_on_body_centred_lattice(site) || !may_be_blurred_sheet(site, entry)) return {};
    const auto blurred = fit(site, entry.material, true, off_blurred);
    const bool is_sharp = off < off_blurred || (blurred && blurred->slab.width <= kSharpWidth);
    return sharp && is_sharp ? sharp : blurred;
  }

  /// Returns whether the indices of a site are all even or all odd. Blurred layers are fitted at these sites,
  /// a quarter of all, and continued to the others, each of which has six of them as neighbours.
  [[nodiscard]] bool is_on_body_centred_lattice(std::size_t site) const {
    const auto [i, j, k] = sites_.indices(site);
    return (i + j) % 2 == 0 && (j + k) % 2 == 0;
  }

  /// Returns whether a material has a part of nearly all cells round a site, which a sharp layer has not.
  [[nodiscard]] bool is_deep(std::size_t site, std::uint16_t material) const {
    const float* fractions = data_.fractions[values_.material(material)].data();
    int mixed = 0;
    sites_.for_each_neighbour(site, [&](std::size_t other, int, int, int) {
      mixed += fractions[other] > 0 && fractions[other] < 1 ? 1 : 0;
    });
    return mixed >= kDeep;
  }

  /// Returns whether a blurred material has only a part of the cells near a site, and enough of this one.
  [[nodiscard]] bool may_be_blurred_sheet(std::size_t site, const Entry& entry) const {
    const float* fractions = data_.fractions[values_.material(entry.material)].data();
    double most = 0;
    for_each_in_window(site, SheetWindow::kReach, [&](std::size_t, std::size_t other) {
      most = std::max(most, static_cast<double>(fractions[other]));
      return most <= kHighest;
    });
    return most >= kLowest && most <= kHighest && static_cast<double>(entry.fraction) >= kOfHighest * most;
  }

  [[nodiscard]] std::optional<SheetPlace> fit(std::size_t site, std::uint16_t material, bool blurred,
                                              double& off) const {
    SheetWindow window(blurred);
    if (blurred) window.noise = noise_[material];
    // There is no thin sheet if the material fills a cell and its neighbours.
    const bool thin = for_each_in_window(site, SheetWindow::kReach, [&](std::size_t, std::size_t other) {
      return !values_.at(other).empty() || values_.sole_material(other) != material;
    });
    if (!thin) return {};
    const float* own = data_.fractions[values_.material(material)].data();
    for_each_in_window(site, window.reach, [&](std::size_t cell, std::size_t other) {
      window.known[cell] = 1;
      window.fraction[cell] = own[other];
      return true;
    });
    const auto guess = guess_sheet(window);
    if (!guess) return {};
    SheetPlace place{static_cast<std::uint32_t>(site), material, {material, material}, {}, {}, false};
    place.sides = sides_of(place, *guess);
    if (place.sides[0] == material) return {};
    const float* front = data_.fractions[values_.material(place.sides[0])].data();
    const float* back = data_.fractions[values_.material(place.sides[1])].data();
    for_each_in_window(site, window.reach, [&](std::size_t cell, std::size_t other) {
      double sum = static_cast<double>(own[other]) + static_cast<double>(front[other]);
      if (front != back) sum += static_cast<double>(back[other]);
      if (sum < kLeastOfThree) window.known[cell] = 0;
      return true;
    });
    const auto slab = fit_sheet(window, *guess, off);
    if (!slab) return {};
    place.slab = *slab;
    place.is_fitted = true;
    return place;
  }

  /// Returns the materials with the greatest sums of fractions before a layer and behind it; the layer's own
  /// material if there is no other.
  [[nodiscard]] std::array<std::uint16_t, 2> sides_of(const SheetPlace& place, const Slab& slab) const {
    std::vector<std::uint16_t> near(place.sides.begin(), place.sides.end());
    for (const Entry& entry : values_.at(place.site)) near.push_back(entry.material);
    sort_unique(near);
    std::erase(near, place.material);
    struct Held {
      const float* fractions;
      std::array<double, 2> sums{0, 0};
    };
    std::vector<Held> held;
    for (const std::uint16_t m : near) held.push_back({data_.fractions[values_.material(m)].data()});
    const int reach = slab.width > 0 ? SheetWindow::kBlurredReach : SheetWindow::kReach;
    const std::vector<Vec3>& places = SheetWindow::places_within(reach);
    for_each_in_window(place.site, reach, [&](std::size_t cell, std::size_t other) {
      const double y = slab.height(places[cell]);
      if (std::abs(y) <= 0.5 * slab.thickness || std::abs(y) >= reach + 0.2) return true;
      for (Held& each : held) each.sums[y > 0 ? 0 : 1] += static_cast<double>(each.fractions[other]);
      return true;
    });
    std::array<std::uint16_t, 2> sides = place.sides;
    std::array<double, 2> most{0, 0};
    for (std::size_t m = 0; m < near.size(); ++m) {
      for (std::size_t side = 0; side < 2; ++side) {
        if (held[m].sums[side] > most[side]) most[side] = held[m].sums[side], sides[side] = near[m];
      }
    }
    if (most[0] == 0 || most[1] == 0) return place.sides;
    return sides;
  }

  /// Continues sheets to sites beside the known places.
  void add_ring(bool blurred_alone) {
    std::vector<std::uint32_t> place_of(data_.grid.site_count(), kNone);
    for (std::size_t p = 0; p < places_.size(); ++p)
      place_of[places_[p].site] = static_cast<std::uint32_t>(p);
    std::vector<std::uint32_t> beside;
    for (const SheetPlace& place : places_) {
      if (blurred_alone && place.slab.width == 0) continue;
      sites_.for_each_neighbour(place.site, [&](std::size_t other, int, int, int) {
        if (place_of[other] != kNone || values_.at(other).empty()) return;
        place_of[other] = kBeside;
        beside.push_back(static_cast<std::uint32_t>(other));
      });
    }
    std::sort(beside.begin(), beside.end());
    for (const std::uint32_t site : beside) place_of[site] = kNone;
    const std::vector<Continued> found = parallel_collect<Continued>(
        beside.size(), 256, [&](std::size_t begin, std::size_t end, std::vector<Continued>& list) {
          for (std::size_t n = begin; n < end; ++n) {
            const auto each = continued_to(beside[n], place_of);
            if (each && !(blurred_alone && each->place.slab.width == 0)) list.push_back(*each);
          }
        });
    nearest_.resize(places_.size(), kNone);
    for (const Continued& each : found) {
      places_.push_back(each.place);
      nearest_.push_back(each.place.slab.width > 0 ? each.nearest : kNone);
    }
  }

  /// A place to which a layer is continued, without the sides of a blurred one, and the number of the nearest
  /// place.
  struct Continued {
    SheetPlace place;
    std::uint32_t nearest;
  };

  [[nodiscard]] std::optional<Continued> continued_to(std::size_t site,
                                                      const std::vector<std::uint32_t>& place_of) const {
    // The layer is continued from the nearest place and those that agree with it.
    std::optional<SheetPlace> nearest;
    std::array<double, 2> least{};
    std::uint32_t number = kNone;
    const auto for_each_place = [&](auto&& visit) {
      sites_.for_each_neighbour(site, [&](std::size_t other, int di, int dj, int dk) {
        if (place_of[other] == kNone) return;
        const Vec3 d{static_cast<double>(di), static_cast<double>(dj), static_cast<double>(dk)};
        const SheetPlace& place = places_[place_of[other]];
        visit(place, place.slab.offset + dot(place.slab.normal, d), squared_norm(d), d);
      });
    };
    for_each_place([&](const SheetPlace& place, double offset, double squared, const Vec3&) {
      const std::array<double, 2> rank{squared, std::abs(offset)};
      if (nearest && !(rank < least)) return;
      nearest = place, least = rank;
      nearest->slab.offset = offset;
      number = place_of[place.site];
    });
    if (!nearest) return {};
    Vec3 normal, middle;
    double offset = 0, thickness = 0, width = 0, weights = 0;
    for_each_place([&](const SheetPlace& place, double own_offset, double squared, const Vec3& d) {
      const double cosine = dot(place.slab.normal, nearest->slab.normal), sign = cosine < 0 ? -1 : 1;
      if (place.material != nearest->material || std::abs(cosine) < kLeastCosine ||
          (place.slab.width > 0) != (nearest->slab.width > 0) ||
          std::abs(sign * own_offset - nearest->slab.offset) > kMostStep)
        return;
      const double w = 1 / squared;
      normal += w * sign * place.slab.normal;
      offset += w * sign * own_offset;
      thickness += w * place.slab.thickness;
      width += w * place.slab.width;
      weights += w;
      middle += w * d;
    });
    Continued result{*nearest, number};
    SheetPlace& place = result.place;
    place.site = static_cast<std::uint32_t>(site);
    place.is_fitted = false;
    place.slab = {normalized(normal), offset / weights, thickness / weights, width / weights};
    middle *= 1 / weights;
    if (!exists(place, norm(middle - dot(middle, place.slab.normal) * place.slab.normal))) return {};
    return result;
  }

  /// Returns whether a layer exists in a cell to which it is continued; if so, corrects the thickness of a
  /// sharp one and sets its sides. `aside`: the distance, along the layer, of the places from which it is
  /// continued.
  [[nodiscard]] bool exists(SheetPlace& place, double aside) const {
    const double own = fraction(place.material, place.site), part = place.slab.part_of_cell({});
    if (place.slab.width > 0) return !(own < kHalf * part) || is_held(place, own, part);
    if (own > 0) {
      if (aside > kAside && own < kHalf * part) place.slab.thickness *= own / part;
      place.sides = sides_of(place, place.slab);
      return true;
    }
    if (aside > kAside && part > kMissing) return false;
    // The material on the cell's side is the one with the greatest fraction in the cell.
    double most = 0;
    for (const Entry& entry : values_.at(place.site)) {
      if (static_cast<double>(entry.fraction) <= most) continue;
      most = static_cast<double>(entry.fraction);
      place.sides[place.slab.offset > 0 ? 1 : 0] = entry.material;
    }
    return true;
  }

  /// Returns whether a blurred layer exists in a cell that seems to hold too little of it: the difference may
  /// be noise, and the cell together with its neighbours holds enough.
  [[nodiscard]] bool is_held(const SheetPlace& place, double own, double part) const {
    if (own + kAboveNoise * noise_[place.material] < kHalf * part) return false;
    sites_.for_each_neighbour(place.site, [&](std::size_t other, int di, int dj, int dk) {
      own += fraction(place.material, other);
      part += place.slab.part_of_cell(
          {static_cast<double>(di), static_cast<double>(dj), static_cast<double>(dk)});
    });
    return own >= kHalf * part;
  }

  /// Leaves out sheets that touch sheets of another material, where it is not clear what is on whose side,
  /// and those with fits for few of their cells: fractions of a simulation that are smeared look like it here
  /// and there.
  void drop_unclear_sheets() {
    const std::size_t count = places_.size();
    std::vector<std::uint32_t> place_of(data_.grid.site_count(), kNone);
    for (std::uint32_t p = 0; p < count; ++p) place_of[places_[p].site] = p;
    DisjointSets sets(count);
    std::vector<std::uint32_t> touching;
    for (std::uint32_t p = 0; p < count; ++p) {
      const SheetPlace& place = places_[p];
      bool touches = false;
      sites_.for_each_neighbour(place.site, [&](std::size_t other, int, int, int) {
        const std::uint32_t q = place_of[other];
        if (q == kNone) return;
        touches = touches || places_[q].material != place.material;
        if (q < p || places_[q].material != place.material) return;
        if ((places_[q].slab.width > 0) == (place.slab.width > 0)) sets.join(p, q);
      });
      if (touches) touching.push_back(p);
    }
    std::vector<char> mixed(count, 0);
    for (const std::uint32_t p : touching) mixed[sets.find(p)] = 1;
    std::vector<std::uint32_t> fitted(count, 0), held(count, 0);
    for (std::uint32_t p = 0; p < count; ++p) {
      const SheetPlace& place = places_[p];
      fitted[sets.find(p)] += place.is_fitted ? 1 : 0;
      held[sets.find(p)] += place.is_beside({}, own_fraction(place)) ? 0 : 1;
    }
    std::vector<std::uint32_t> number(count, kNone);
    std::uint32_t kept = 0;
    for (std::uint32_t p = 0; p < count; ++p) {
      const std::uint32_t sheet = sets.find(p);
      const double least = places_[p].slab.width > 0 ? kLeastFittedBlurred : kLeastFitted;
      const bool is_clear = fitted[sheet] >= kFewest &&
                            static_cast<double>(fitted[sheet]) >= least * static_cast<double>(held[sheet]);
      if (mixed[sheet] != 0 || !is_clear) continue;
      // The nearest place is of the same sheet and has been kept.
      nearest_[kept] = nearest_[p] == kNone ? kNone : number[nearest_[p]];
      places_[kept] = places_[p];
      number[p] = kept++;
    }
    places_.resize(kept);
    nearest_.resize(kept);
  }

  /// Finds the sides of the places to which blurred sheets were continued. They depend on those of the
  /// nearest places, which belong to rings before.
  void find_inherited_sides() {
    for (std::size_t begin = 0, end = 0; begin < places_.size(); begin = end) {
      while (end < places_.size() && (nearest_[end] == kNone || nearest_[end] < begin)) ++end;
      parallel_for(end - begin, 256, [&](std::size_t n) {
        const std::uint32_t nearest = nearest_[begin + n];
        if (nearest == kNone) return;
        SheetPlace& place = places_[begin + n];
        place.sides = places_[nearest].sides;
        place.sides = sides_of(place, place.slab);
      });
    }
  }

  const MultiMaterialData& data_;
  const SiteValues& values_;
  GridSites sites_;
  std::array<std::int64_t, 3> n_;
  std::vector<double> noise_;  // by number of the material
  std::vector<SheetPlace> places_;
  // By place: the place from which a blurred sheet was continued to it, whose sides are found last; else
  // kNone.
  std::vector<std::uint32_t> nearest_;
};

/// Places beside each other belong to one sheet if the cosine of their normals is at least kLeastCosineBeside
/// and their heights halfway between them differ by at most kMostStepBeside cells.
constexpr double kLeastCosineBeside = 0.5, kMostStepBeside = 0.6;
/// The cells between two places on either side of a continuous sheet together hold at least this much of it,
/// relative to its thickness.
constexpr double kLeastBetween = 0.4;

/// Disjoint sets of the sides of places: side 2 p lies before place p, side 2 p + 1 behind it. A set knows
/// which other sets lie across sheets and is never joined with these.
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
    // In most cases all sides across belong to one set.
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
  std::vector<std::vector<std::uint32_t>> across_;  // by root of a set
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
    for_each_pair([&](std::uint32_t p, std::uint32_t q, const Vec3& d) { join_along_sheet(p, q, d); });
    for_each_pair([&](std::uint32_t p, std::uint32_t q, const Vec3&) { join_through_cells(p, q); });
    drop_ends();
    number();
  }

 private:
  [[nodiscard]] const SheetPlace& place(std::uint32_t p) const { return sheets_.places[p]; }

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

  void join_along_sheet(std::uint32_t p, std::uint32_t q, const Vec3& d) {
    const Slab &a = place(p).slab, &b = place(q).slab;
    const double cosine = dot(a.normal, b.normal), sign = cosine < 0 ? -1 : 1;
    if (place(p).material != place(q).material || std::abs(cosine) < kLeastCosineBeside) return;
    if (std::abs(a.height(0.5 * d) - sign * b.height(-0.5 * d)) > kMostStepBeside) return;
    const std::uint32_t turned = sign < 0 ? 1 : 0;
    sets_.join(2 * p, 2 * q + turned);
    sets_.join(2 * p + 1, 2 * q + (1 - turned));
  }

  /// Returns whether a place is in a cell that holds nothing of the sheet.
  [[nodiscard]] bool is_beside(std::uint32_t p) const {
    return place(p).is_beside({}, data_.fractions[values_.material(place(p).material)][place(p).site]);
  }
  /// Returns the side of its sheet on which a place in such a cell lies.
  [[nodiscard]] std::uint32_t home(std::uint32_t p) const {
    return 2 * p + (place(p).slab.offset > 0 ? 1 : 0);
  }

  void join_through_cells(std::uint32_t p, std::uint32_t q) {
    if (is_beside(p) && is_beside(q)) sets_.join(home(p), home(q));
  }

  /// Returns the sum of a material's fractions in the cells of the box spanned by two neighbouring sites.
  [[nodiscard]] double held_between(std::size_t site, const Vec3& d, std::uint16_t material) const {
    const SiteArray<float>& fractions = data_.fractions[values_.material(material)];
    double sum = static_cast<double>(fractions[site]);
    grid_sites_.for_each_neighbour(site, [&](std::size_t other, int di, int dj, int dk) {
      const auto within = [](int step, double end) { return step == 0 || static_cast<double>(step) == end; };
      if (within(di, d.x) && within(dj, d.y) && within(dk, d.z)) sum += static_cast<double>(fractions[other]);
    });
    return sum;
  }

  /// Drops places where a sheet has ended: two cells without it lie on its two sides, but the cells between
  /// them hold nearly nothing of it.
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

/// Joins the sides of places to regions and numbers these. Sides are joined along sheets and, where this
/// does not make both sides of a sheet one, through cells that hold nothing of the sheet.
void join_regions(const MultiMaterialData& data, const SiteValues& values, ThinSheets& sheets) {
  RegionSearch(data, values, sheets).run();
}

}  // namespace

ThinSheets find_thin_sheets(const MultiMaterialData& data, const SiteValues& values) {
  if (!data.labels.empty()) return {};
  ThinSheets sheets = SheetSearch(data, values).run();
  if (!sheets.places.empty()) join_regions(data, values, sheets);
  return sheets;
}

}  // namespace adamas::interfaces
