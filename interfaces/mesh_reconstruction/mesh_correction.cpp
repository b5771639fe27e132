#include "interfaces/mesh_reconstruction/mesh_correction.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "core/base/median.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/mesh_reconstruction/mesh_dispersed.h"
#include "interfaces/mesh_reconstruction/mesh_errors.h"
#include "interfaces/mesh_reconstruction/mesh_fit.h"
#include "interfaces/mesh_reconstruction/mesh_flakes.h"
#include "interfaces/mesh_reconstruction/mesh_held_cells.h"
#include "interfaces/mesh_reconstruction/mesh_interfaces.h"
#include "interfaces/mesh_reconstruction/mesh_start.h"
#include "interfaces/mesh_reconstruction/mesh_totals.h"
#include "interfaces/mesh_reconstruction/mesh_volumes.h"
#include "interfaces/reconstruction/normal_distribution.h"
#include "interfaces/reconstruction/region_parts.h"  // drop_unused_points
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

namespace {

using Index = MeshSubdivision::Index;
using Entry = MeshValues::Entry;

/// Blurred fractions are corrected in so many rounds: more would fit noise.
constexpr int kRoundsBlurred = 3;
/// A value moves by at most this part of a cell's size in a round.
constexpr double kMostMove = 0.2;
/// A material's derivative in a cell is taken to be at least this, in cells per their size.
constexpr double kLeastGrowth = 0.5;
/// Cells whose volumes differ from the fractions by more are named: for sharp ones, and for blurred ones,
/// where neither the width nor the shape of a step is known so well.
constexpr double kTolerance = 1e-3, kToleranceBlurred = 0.03;
/// Steps that seem less wide, in sizes of cells, may be sharp; they are if values of sharp ones differ from
/// the fractions by no more than kFits in the mean.
constexpr double kSurelyBlurred = 0.7, kFits = 0.0015;
/// The greatest part of the exchange between neighbours in a step of diffusion.
constexpr double kDiffusionStep = 0.4;
/// The greatest number of steps of diffusion.
constexpr double kMostDiffusions = 64;
/// Centres of cells are taken to be at least this far apart, in sizes of cells.
constexpr double kLeastDistance = 1e-6;
/// A cell that shows nothing of a material is a hole if more than this part of it should, blurred alike.
constexpr double kHole = 0.25;
constexpr std::uint32_t kNone = 0xffffffffu;

/// Smooths parts of cells as a Gaussian does, by diffusion between neighbours. At the boundary parts are
/// continued linearly.
class Diffusion {
 public:
  /// `widths`: the standard deviations as lengths, by entry of active cells.
  Diffusion(const MeshValues& values, const MeshWalls& walls, std::vector<double> widths)
      : values_(values),
        walls_(walls),
        widths_(std::move(widths)),
        place_(values.subdivision().mesh().cell_count(), kNone) {
    const std::vector<Index>& active = values.active_cells();
    double most = 0;
    firsts_.push_back(0);
    for (std::uint32_t n = 0; n < active.size(); ++n) {
      const Index c = active[n];
      place_[c] = n;
      firsts_.push_back(firsts_.back() + values.at(c).size());
      first_sides_.push_back(sides_.size());
      rates_.push_back(add_sides(c));
      for (std::size_t e = firsts_[n]; e < firsts_[n + 1]; ++e)
        most = std::max(most, 0.5 * rates_.back() * widths_[e] * widths_[e]);
    }
    first_sides_.push_back(sides_.size());
    steps_ = static_cast<int>(std::clamp(std::ceil(most / kDiffusionStep), 1.0, kMostDiffusions));
  }

  /// Smooths parts of active cells.
  void run(std::vector<double>& parts) const {
    std::vector<double> next(parts.size());
    const std::vector<Index>& active = values_.active_cells();
    for (int step = 0; step < steps_; ++step) {
      parallel_for(active.size(), 256, [&](std::size_t n) {
        const std::span<const Entry> own = values_.at(active[n]);
        for (std::size_t e = 0; e < own.size(); ++e) {
          const std::size_t at = firsts_[n] + e;
          // Cells that are so small that this would not be stable are smoothed less.
          const double wanted = 0.5 * widths_[at] * widths_[at] / steps_,
                       time = rates_[n] > 0 ? std::min(wanted, kDiffusionStep / rates_[n]) : wanted;
          double change = 0;
          for (std::size_t s = first_sides_[n]; s < first_sides_[n + 1]; ++s)
            change += sides_[s].rate * (part_of(sides_[s].cell, own[e].material, parts) - parts[at]);
          next[at] = parts[at] + time * change;
        }
      });
      parts.swap(next);
    }
  }

 private:
  /// Adds the sides of a cell; returns the sum of the rates of its faces.
  double add_sides(Index c) {
    const PolyhedralMesh& mesh = values_.subdivision().mesh();
    // Nothing passes the faces of walls.
    if (!(mesh.cell_volume(c) > 0) || walls_.fills(c)) return 0;
    const double least = kLeastDistance * values_.size(c);
    double rate = 0;
    Vec3 open;  // the area of the cell's faces at the boundary
    for (const Index f : mesh.faces_of_cell(c)) {
      const Index other = mesh.neighbour(c, f);
      if (other != PolyhedralMesh::kNone && walls_.fills(other)) continue;
      const Vec3 area = mesh.face_area(f);
      if (other == PolyhedralMesh::kNone) {
        open += area;
        continue;
      }
      // The flux that passes a face, by the difference of the two cells.
      const double away = std::max(distance(mesh.cell_center(c), mesh.cell_center(other)), least);
      sides_.push_back({other, norm(area) / (away * mesh.cell_volume(c))});
      rate += sides_.back().rate;
    }
    if (squared_norm(open) > 0) add_boundary(c, (1 / mesh.cell_volume(c)) * open);
    return rate;
  }

  /// Adds the flux through the boundary of a cell, by the gradient that the cells round it have by least
  /// squares. `open`: the area of that boundary in relation to the cell's volume.
  void add_boundary(Index c, const Vec3& open) {
    const MeshSubdivision& subdivision = values_.subdivision();
    const PolyhedralMesh& mesh = subdivision.mesh();
    std::vector<Index> ring;
    const std::array<Index, 1> self{c};
    subdivision.find_ring(self, ring);
    std::erase_if(ring, [this](Index other) { return walls_.fills(other); });
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    std::vector<Eigen::Vector3d> rows;
    for (const Index other : ring) {
      const Vec3 d = mesh.cell_center(other) - mesh.cell_center(c);
      rows.emplace_back(d.x, d.y, d.z);
      if (other != c) normal += rows.back() * rows.back().transpose() / squared_norm(d);
    }
    normal.diagonal().array() += 1e-9 * normal.trace();
    const Eigen::Vector3d along = normal.ldlt().solve(Eigen::Vector3d(open.x, open.y, open.z));
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (ring[i] != c) sides_.push_back({ring[i], along.dot(rows[i]) / rows[i].squaredNorm()});
    }
  }
  [[nodiscard]] double part_of(Index cell, std::uint16_t material, const std::vector<double>& parts) const {
    const std::span<const Entry> own = values_.at(cell);
    for (std::size_t e = 0; e < own.size(); ++e) {
      if (own[e].material == material) return place_[cell] == kNone ? 1 : parts[firsts_[place_[cell]] + e];
    }
    return 0;
  }

  struct Side {
    Index cell;
    double rate;
  };
  const MeshValues& values_;
  const MeshWalls& walls_;
  std::vector<double> widths_;
  std::vector<std::uint32_t> place_;               // by cell: its place among active ones, or kNone
  std::vector<std::size_t> firsts_, first_sides_;  // by active cell: its first entry and side
  std::vector<Side> sides_;
  std::vector<double> rates_;  // by active cell: of its faces, together
  int steps_ = 1;
};

class Correction {
 public:
  /// `dispersed`: the volumes that were taken out, by material of the data.
  Correction(const MeshData& data, MeshValues& values, MeshWalls walls, MeshFilms films, Steps steps,
             std::vector<double> dispersed, Progress& progress)
      : data_(data),
        values_(values),
        walls_(std::move(walls)),
        films_(std::move(films)),
        progress_(progress),
        volumes_(values),
        found_(std::move(steps.widths)),
        extents_(std::move(steps.extents)) {
    result_.agreement.volumes = volumes_without(dispersed);
    result_.agreement.findings.dispersed = std::move(dispersed);
  }

  /// `known`: whether the widths are known to be right. `error`: the standard deviation of errors of
  /// fractions, where that is known.
  MeshReconstruction run(bool known, const std::optional<double>& error) {
    const double widest = found_.empty() ? 0 : *std::ranges::max_element(found_);
    // Curved interfaces of sharp materials look blurred to coarse cells; they fit all fractions.
    const bool unsure = widest > 0 && widest < kSurelyBlurred && !known;
    const std::vector<double> sharp(found_.size(), 0.0);
    start(unsure ? sharp : found_);
    double deviation = error ? *error : deviation_of_errors();
    if (unsure && deviation > SiteValues::kLeastError) {
      // Steps are as wide as explains the fractions better.
      start(found_);
      const double of_blurred = error ? *error : deviation_of_errors();
      const bool blurred = of_blurred < deviation;
      deviation = std::min(of_blurred, deviation);
      if (!blurred || deviation <= SiteValues::kLeastError) start(sharp);
    }
    if (deviation > SiteValues::kLeastError) smooth(deviation);
    correct();
    if (unsure && deviation_ == 0 && result_.agreement.cells.mean_difference > kFits) {
      start(found_);
      correct();
    }
    result_.agreement.findings.fraction_error = error.value_or(deviation_);
    const std::vector<VolumeMove> moves = extract();
    if (values_.active_cells().empty()) return std::move(result_);
    measure(false, moves);
    find_lost();
    return std::move(result_);
  }

 private:
  /// Returns the volumes of materials after dispersed parts were given to the others in their cells.
  [[nodiscard]] IdVector<MaterialId, double> volumes_without(const std::vector<double>& dispersed) const {
    IdVector<MaterialId, double> volumes = data_.volumes();
    if (std::ranges::all_of(dispersed, [](double volume) { return volume == 0; })) return volumes;
    for (MaterialId m(0); m.value < volumes.size(); ++m.value) volumes[m] -= dispersed[m.value];
    for (std::size_t c = 0; c < data_.mesh.cell_count(); ++c) {
      const double volume = data_.mesh.cell_volume(c);
      const std::span<const Entry> own = std::as_const(values_).at(c);
      for (const Entry& entry : own) {
        if (entry.fraction <= 0) continue;
        const MaterialId m = values_.material(entry.material);
        volumes[m] += volume * static_cast<double>(entry.fraction);
        const bool counted = std::any_of(own.data(), &entry, [&](const Entry& other) {
          return other.fraction > 0 && values_.material(other.material) == m;
        });
        if (!counted) volumes[m] -= volume * static_cast<double>(data_.fraction(m, c));
      }
    }
    return volumes;
  }

  /// Sets the values from which those of steps of these widths are corrected.
  void start(const std::vector<double>& widths) {
    widths_ = widths;
    set_start_values(widths, extents_, films_, walls_, values_);
    find_blur();
    errors_.emplace(widths_, extents_, films_, values_);
  }

  [[nodiscard]] double deviation_of_errors() const {
    return errors_->deviation(result_.agreement.findings.blur_median);
  }

  /// Smooths values and fractions within the errors of the fractions.
  void smooth(double deviation) {
    for (const Index c : values_.active_cells()) {
      for (const Entry& entry : std::as_const(values_).at(c)) given_.push_back(entry.fraction);
    }
    deviation_ = deviation;
    errors_->smooth(deviation, values_);
    // The cells themselves blur sharp fractions, so that errors are not held to the end.
    for (double& width : widths_) width = std::max(width, kUniformDeviation);
  }

  /// Corrects values: those of sharp fractions alone until cells hold them, others in rounds.
  void correct() {
    blurs_.clear();
    diffusion_.reset();
    if (values_.active_cells().empty()) return;
    if (std::ranges::any_of(widths_, [](double width) { return width > 0; })) return correct_blurred();
    fit_volumes(extents_, values_, volumes_, progress_);
    measure(false);
  }

  void correct_blurred() {
    // The cells themselves are a part of the width.
    for (const double width : widths_)
      blurs_.push_back(std::sqrt(std::max(0.0, width * width - kCellVariance)));
    std::vector<double> lengths;
    for (const Index c : values_.active_cells()) {
      for (const Entry& entry : std::as_const(values_).at(c))
        lengths.push_back(blurs_[entry.material] * extents_[lengths.size()]);
    }
    diffusion_.emplace(values_, walls_, std::move(lengths));
    double before = std::numeric_limits<double>::infinity();
    std::vector<double> best;
    for (int round = 0; round <= kRoundsBlurred; ++round) {
      progress_.step("correcting volumes", static_cast<double>(round) / kRoundsBlurred);
      measure(true);
      if (result_.agreement.cells.mean_difference >= before) {
        restore(best);
        return measure(false);
      }
      if (round == kRoundsBlurred) return;
      before = result_.agreement.cells.mean_difference;
      best = kept();
      move();
    }
  }

  /// Measures parts of cells, those that blurred fractions show, and how far they are from the fractions
  /// after these moves.
  void measure(bool growth, const std::vector<VolumeMove>& moves = {}) {
    values_.interpolate();
    volumes_.measure(growth);
    const std::vector<Index>& active = values_.active_cells();
    shown_.clear();
    for (std::size_t n = 0; n < active.size(); ++n)
      shown_.insert(shown_.end(), volumes_.parts(n).begin(), volumes_.parts(n).end());
    if (diffusion_) diffusion_->run(shown_);
    std::map<std::pair<Index, MaterialId>, double> gained;
    for (const auto& [cell, from, to, part] : moves) {
      gained[{cell, from}] -= part;
      gained[{cell, to}] += part;
    }
    CellAgreement& found = result_.agreement.cells;
    found = {.tolerance = std::max(diffusion_ ? kToleranceBlurred : kTolerance, 3 * deviation_)};
    double sum = 0;
    std::size_t first = 0;
    std::vector<double> differences;
    for (const Index c : active) {
      const std::span<const Entry> own = std::as_const(values_).at(c);
      differences.assign(own.size(), 0);
      bool is_mixed = false;
      for (std::size_t e = 0; e < own.size(); ++e) {
        const float given = given_.empty() ? own[e].fraction : given_[first + e];
        double shown = shown_[first + e];
        if (own[e].fraction > 0 && own[e].fraction < 1) is_mixed = true;
        // Regions of a material count together.
        const std::size_t row = first_of_material(values_, own, own[e].material);
        if (row == e && !gained.empty()) {
          const auto gain = gained.find({c, values_.material(own[e].material)});
          if (gain != gained.end()) shown += gain->second;
        }
        differences[row] += shown - static_cast<double>(given);
      }
      first += own.size();
      double off = 0;
      for (const double difference : differences) off = std::max(off, std::abs(difference));
      if (!is_mixed) {
        found.full_cells_off += off > kTolerance ? 1 : 0;
        found.greatest_in_full_cell = std::max(found.greatest_in_full_cell, off);
        continue;
      }
      found.greatest_difference = std::max(found.greatest_difference, off);
      sum += off;
      ++found.mixed_cells;
      found.cells_off += off > found.tolerance ? 1 : 0;
    }
    found.mean_difference = found.mixed_cells > 0 ? sum / static_cast<double>(found.mixed_cells) : 0;
    result_.agreement.findings.mixed_cells = found.mixed_cells;
    result_.agreement.findings.cells_off = found.cells_off;
    result_.agreement.findings.tolerance = found.tolerance;
    result_.agreement.findings.greatest_difference = found.greatest_difference;
  }

  /// Sets the findings about widths of steps in mixed cells.
  void find_blur() {
    FractionFindings& findings = result_.agreement.findings;
    findings = {.dispersed = std::move(findings.dispersed)};
    std::vector<double> of_cells;
    std::size_t mixed = 0;
    for (const Index c : values_.active_cells()) {
      double width = 0;
      bool is_mixed = false;
      for (const Entry& entry : std::as_const(values_).at(c)) {
        if (entry.fraction <= 0 || entry.fraction >= 1) continue;
        is_mixed = true;
        width = std::max(width, widths_[entry.material]);
      }
      mixed += is_mixed ? 1 : 0;
      if (width > 0) of_cells.push_back(width);
    }
    if (of_cells.empty()) return;
    findings.blur_share = static_cast<double>(of_cells.size()) / static_cast<double>(mixed);
    findings.blur_greatest = *std::ranges::max_element(of_cells);
    findings.blur_median = median(of_cells);
  }

  [[nodiscard]] std::vector<double> kept() const {
    std::vector<double> result;
    for (const Index c : values_.active_cells()) {
      for (const Entry& entry : std::as_const(values_).at(c)) result.push_back(entry.value);
    }
    return result;
  }
  void restore(const std::vector<double>& kept) {
    auto next = kept.begin();
    for (const Index c : values_.active_cells()) {
      for (Entry& entry : values_.at(c)) entry.value = *next++;
    }
  }

  /// Moves values towards what the differences ask for, where some are blurred.
  void move() {
    const std::vector<Index>& active = values_.active_cells();
    std::vector<double> moves;
    std::size_t at = 0;
    for (std::size_t n = 0; n < active.size(); ++n) {
      const std::span<const double> growths = volumes_.growths(n);
      const std::span<const Entry> own = std::as_const(values_).at(active[n]);
      for (std::size_t e = 0; e < own.size(); ++e, ++at) {
        const double missing = static_cast<double>(own[e].fraction) - shown_[at], extent = extents_[at];
        const double width = widths_[own[e].material];
        const double by = missing == 0 ? 0
                          : width > 0  ? width * extent * std::sqrt(2 * std::numbers::pi) * missing
                                       : missing / std::max(growths[e], kLeastGrowth / extent);
        moves.push_back(std::clamp(by, -kMostMove * extent, kMostMove * extent));
      }
    }
    errors_->take_means(moves);
    continue_moves(moves);
    at = 0;
    for (const Index c : active) {
      for (Entry& entry : values_.at(c)) entry.value += moves[at++];
    }
    walls_.set_values(values_);
  }

  /// Replaces the moves of blurred materials near the boundary, beyond which nobody knows what blurred
  /// fractions would be, by those of the nearest cells inside.
  void continue_moves(std::vector<double>& moves) const {
    const std::vector<Index>& active = values_.active_cells();
    const MeshSubdivision& subdivision = values_.subdivision();
    const PolyhedralMesh& mesh = subdivision.mesh();
    std::vector<std::size_t> firsts{0};
    std::vector<std::uint32_t> place(mesh.cell_count(), kNone);
    for (std::uint32_t n = 0; n < active.size(); ++n) {
      place[active[n]] = n;
      firsts.push_back(firsts.back() + values_.at(active[n]).size());
    }
    std::vector<Index> open, ring;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      if (mesh.cells_of_face(f)[1] == PolyhedralMesh::kNone) open.push_back(mesh.cells_of_face(f)[0]);
    }
    sort_unique(open);
    const int layers = static_cast<int>(std::ceil(*std::ranges::max_element(blurs_)));
    for (int layer = 1; layer < layers; ++layer) {
      subdivision.find_ring(open, ring);
      open.swap(ring);
    }
    std::vector<char> known(mesh.cell_count(), 1);
    for (const Index c : open) known[c] = 0;
    for (int layer = 0; layer < layers; ++layer) {
      std::vector<Index> settled;
      for (const Index c : open) {
        if (known[c] != 0 || place[c] == kNone) continue;
        const std::array<Index, 1> self{c};
        subdivision.find_ring(self, ring);
        std::erase_if(ring, [&](Index other) { return known[other] == 0 || place[other] == kNone; });
        if (ring.empty()) continue;
        settled.push_back(c);
        const std::span<const Entry> own = std::as_const(values_).at(c);
        for (std::size_t e = 0; e < own.size(); ++e) {
          if (widths_[own[e].material] == 0) continue;
          double sum = 0;
          int count = 0;
          for (const Index other : ring) {
            const std::span<const Entry> there = std::as_const(values_).at(other);
            const auto found = std::ranges::find(there, own[e].material, &Entry::material);
            if (found == there.end()) continue;
            sum += moves[firsts[place[other]] + static_cast<std::size_t>(found - there.begin())];
            ++count;
          }
          if (count > 0) moves[firsts[place[c]] + e] = sum / count;
        }
      }
      for (const Index c : settled) known[c] = 1;
    }
  }

  /// Extracts interfaces without flakes. Returns what cells of the flakes' neighbours get.
  std::vector<VolumeMove> extract() {
    const auto find = [&] { return find_flakes(data_, values_, result_.mesh, result_.bodies); };
    const auto close = [&](const IdVector<MaterialId, double>& wanted) {
      IdVector<MaterialId, double> volumes = close_totals(data_, wanted, values_, volumes_, progress_);
      result_.mesh = interfaces_of_values(data_, values_, progress_);
      result_.bodies = find_bodies(result_.mesh, &data_.mesh.box());
      return volumes;
    };
    const IdVector<MaterialId, double>& wanted = result_.agreement.volumes;
    IdVector<MaterialId, double> given = close(wanted);
    double domain = 0;
    for (const double volume : given) domain += volume;
    const std::vector<Flake> flakes = settle_flakes(wanted, domain, find, close, given);
    drop_flakes(flakes, result_.mesh, result_.bodies.sides, result_.bodies.materials);
    drop_unused_points(result_.mesh);
    std::vector<VolumeMove> moves;
    for (const Flake& flake : flakes) moves.push_back(flake.move);
    return moves;
  }

  /// Finds the groups of cells that hold a material of which no part is shown there, and such holes in what
  /// others show.
  void find_lost() {
    const MeshHeldCells held(values_);
    for (std::uint32_t group = 0; group < held.group_count(); ++group) {
      const auto is_shown = [&](const MeshHeldCells::Place& place) { return part(place) > 0; };
      if (std::ranges::none_of(held.places(group), is_shown)) add_lost(held.places(group));
    }
    const std::vector<std::uint32_t> firsts = first_active_entries(values_);
    const MeshHeldCells holes(values_, [&](const MeshHeldCells::Place& place) {
      const Entry& entry = this->entry(place);
      if (values_.is_part(entry.material) || part(place) > 0) return false;
      return static_cast<double>(entry.fraction) > shown_[firsts[place.n] + place.entry] + kHole;
    });
    for (std::uint32_t group = 0; group < holes.group_count(); ++group) {
      // What is lost as a whole is known.
      const MeshHeldCells::Place first = holes.places(group)[0];
      const std::uint32_t of_first = held.group(values_.active_cells()[first.n], entry(first).material);
      if (std::ranges::any_of(held.places(of_first), [&](const auto& place) { return part(place) > 0; }))
        add_lost(holes.places(group));
    }
  }
  [[nodiscard]] const Entry& entry(const MeshHeldCells::Place& place) const {
    return std::as_const(values_).at(values_.active_cells()[place.n])[place.entry];
  }
  [[nodiscard]] double part(const MeshHeldCells::Place& place) const {
    return volumes_.parts(place.n)[place.entry];
  }

  void add_lost(std::span<const MeshHeldCells::Place> places) {
    LostPlace lost;
    for (const MeshHeldCells::Place& place : places) {
      const Index cell = values_.active_cells()[place.n];
      const auto fraction = static_cast<double>(entry(place).fraction);
      const double volume = fraction * data_.mesh.cell_volume(cell);
      lost.material = values_.material(entry(place).material).value;
      lost.volume += volume;
      ++lost.cells;
      lost.greatest_fraction = std::max(lost.greatest_fraction, fraction);
      lost.place += volume * data_.mesh.cell_center(cell);
    }
    if (!(lost.volume > 0)) return;
    lost.place *= 1 / lost.volume;
    lost.within_one_step = lost.greatest_fraction <= data_.report.step;
    result_.agreement.lost.push_back(lost);
  }

  const MeshData& data_;
  MeshValues& values_;
  MeshWalls walls_;
  MeshFilms films_;
  Progress& progress_;
  MeshVolumes volumes_;
  std::vector<double> found_, extents_;  // widths and extents (Steps)
  std::vector<double> widths_;           // by material, in extents of cells; 0 for a sharp one
  std::vector<double> blurs_;            // those without the part of the cells
  std::optional<Diffusion> diffusion_;
  std::optional<MeshErrors> errors_;
  double deviation_ = 0;       // of errors of fractions, if they were smoothed
  std::vector<float> given_;   // by entry of active cells: fractions before they were smoothed
  std::vector<double> shown_;  // by entry of active cells
  MeshReconstruction result_;
};

/// Makes materials sharp that have at most half of every cell, as a thin film: blurred, they would own
/// nothing. So are those with no other steps than round such ones that are the only other material there.
void set_faint_sharp(const MeshValues& values, std::vector<double>& widths) {
  std::vector<float> most(widths.size(), 0);
  for (const Index c : values.active_cells()) {
    for (const Entry& entry : values.at(c))
      most[entry.material] = std::max(most[entry.material], entry.fraction);
  }
  const auto is_faint = [&](const Entry& entry) {
    return entry.fraction > 0 && most[entry.material] <= 0.5f;
  };
  std::vector<char> has_own_step(widths.size(), 0);
  for (const Index c : values.active_cells()) {
    if (values.at(c).size() == 2 && std::ranges::any_of(values.at(c), is_faint)) continue;
    for (const Entry& entry : values.at(c)) {
      if (entry.fraction > 0 && entry.fraction < 1) has_own_step[entry.material] = 1;
    }
  }
  for (std::size_t n = 0; n < widths.size(); ++n)
    widths[n] = most[n] > 0.5f && has_own_step[n] != 0 ? widths[n] : 0;
}

}  // namespace

MeshReconstruction reconstruct_fractions(const MeshData& data, const FractionOptions& options,
                                         MeshValues& values, Progress& progress) {
  MeshWalls walls;
  MeshFilms films;
  Steps steps = find_steps(walls, films, values);
  std::vector<double> dispersed(data.materials.size(), 0);
  if (!options.keep_dispersed) dispersed = take_dispersed(steps.widths, values);
  films = MeshFilms(values);
  if (films.any() || std::ranges::any_of(dispersed, [](double volume) { return volume > 0; }))
    steps = find_steps(walls, films, values);
  set_faint_sharp(values, steps.widths);
  const auto is_blurred = [](double width) { return width >= kSurelyBlurred; };
  if (std::ranges::any_of(steps.widths, is_blurred)) walls = MeshWalls(values);
  if (walls.any()) {
    steps = find_steps(walls, films, values);
    set_faint_sharp(values, steps.widths);
  }
  const std::optional<double> known = options.known_blur();
  if (known)
    steps.widths.assign(steps.widths.size(), *known > 0 ? std::sqrt(*known * *known + kCellVariance) : 0);
  return Correction(data, values, std::move(walls), std::move(films), std::move(steps), std::move(dispersed),
                    progress)
      .run(known.has_value(), options.known_error());
}

}  // namespace adamas::interfaces
