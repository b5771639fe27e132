#include "interfaces/selection/certified_selections.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/base/parallel.h"
#include "interfaces/resampling/resampling_state.h"
#include "interfaces/selection/selection.h"

namespace adamas::interfaces {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
/// Each error is that of the previous mesh divided by `kStep`, or by less, down to `kLeastStep`, if the mesh
/// would be more than `kGrowth` times as large as the previous one. Meshes for errors in between are finer
/// than necessary.
constexpr double kStep = 1.1, kLeastStep = 1.02, kGrowth = 1.2;
constexpr int kMostRounds = 20;

class Certifier {
 public:
  Certifier(SavedHierarchy& hierarchy, const ResamplingSource& source, Progress& progress)
      : hierarchy_(hierarchy),
        network_(*source.network),
        progress_(progress),
        comparison_(source, hierarchy.interface_target),
        selection_(hierarchy),
        diamond_of_(hierarchy.tree.cells.size(), kNone),
        owners_(hierarchy.diamonds_of_split_cells()),
        split_(hierarchy.diamond_count(), 0),
        certified_(split_) {
    for (std::size_t i = 0; i < owners_.size(); ++i) diamond_of_[hierarchy.split_cells[i]] = owners_[i];
    children_.assign(hierarchy.tree.cells.size(), 0);
    for (std::size_t i = 0; i < owners_.size(); ++i)
      children_[hierarchy.split_cells[i]] = hierarchy.first_child(i);
  }

  void run() {
    least_error_ = hierarchy_.tree.box.diagonal();
    certified_size_ = hierarchy_.root_count;
    const double last = hierarchy_.interface_target;
    bool stuck = false;
    for (double step = kStep;
         least_error_ > last && std::count(certified_.begin(), certified_.end(), 0) > 0;) {
      const double target = std::max(least_error_ / step, last);
      const std::optional<InterfaceMesh> shown = split_to(target, !stuck && step > kLeastStep);
      if (!shown) {
        split_ = certified_;
        step = std::sqrt(step);
        continue;
      }
      stuck = !record();
      if (stuck && target == last) break;
      step = stuck ? step * kStep : std::min(step * step, kStep);
    }
    if (!hierarchy_.certificates.empty() && std::count(certified_.begin(), certified_.end(), 0) == 0) return;
    // The remaining diamonds were split for other reasons.
    std::fill(split_.begin(), split_.end(), 1);
    measure(last);
    if (!record()) hierarchy_.certificates.push_back(comparison_.finish(progress_));
  }

 private:
  using Found = std::vector<std::atomic<bool>>;

  /// Refines the mesh until its interfaces are within an error or it is whole; returns these interfaces. With
  /// `in_small_steps`, returns none if the mesh would grow too much for one step.
  std::optional<InterfaceMesh> split_to(double target, bool in_small_steps) {
    for (int round = 0;; ++round) {
      split_for_estimates(kEstimatePart * target);
      selection_.choose(split_);
      const double most = kGrowth * static_cast<double>(certified_size_);
      if (in_small_steps && static_cast<double>(selection_.size()) > most) return std::nullopt;
      InterfaceMesh shown = measure(target);
      if (comparison_.within() || round == kMostRounds || !split_failing_cells(shown)) return shown;
    }
  }

  /// Measures the interfaces that the mesh shows.
  InterfaceMesh measure(double target) {
    selection_.choose(split_);
    cells_ = selection_.cells();
    const ResampledMesh& tree = hierarchy_.tree;
    CellSet set = tree.cell_set();
    set.count = cells_.size();
    set.corners = [&](std::size_t i) { return tree.cells[cells_[i]].vertices; };
    InterfaceMesh shown = extract_interfaces(tree.table, set, tree.box, progress_).mesh;
    comparison_.set_target(target);
    comparison_.measure(shown, progress_);
    return shown;
  }

  /// Adds the certificate of the mesh that was measured last if it is better than all previous ones; returns
  /// whether it is.
  bool record() {
    const InterfaceCertificate certificate = comparison_.finish(progress_);
    if (!(certificate.upper() < least_error_)) return false;
    for (std::size_t d = 0; d < split_.size(); ++d) {
      if (split_[d] != 0 && certified_[d] == 0) hierarchy_.interface_errors[d] = least_error_;
    }
    // If the mesh has not changed, its new certificate, for a smaller error, has tighter bounds and replaces
    // the last one.
    if (certified_ == split_ && !hierarchy_.certificates.empty()) hierarchy_.certificates.pop_back();
    certified_ = split_;
    certified_size_ = cells_.size();
    least_error_ = certificate.upper();
    hierarchy_.certificates.push_back(certificate);
    return true;
  }

  /// Splits a diamond, after the ancestors that must be split first.
  void split(std::uint32_t diamond) {
    std::vector<std::uint32_t> waiting{diamond};
    while (!waiting.empty()) {
      const std::uint32_t d = waiting.back();
      waiting.pop_back();
      if (split_[d] != 0) continue;
      split_[d] = 1;
      for (std::uint32_t i = hierarchy_.first_cells[d]; i < hierarchy_.first_cells[d + 1]; ++i) {
        const std::uint32_t cell = hierarchy_.split_cells[i];
        if (cell >= hierarchy_.root_count) waiting.push_back(owners_[(cell - hierarchy_.root_count) / 2]);
      }
    }
  }

  [[nodiscard]] bool is_in_tree(std::uint32_t cell) const {
    return cell < hierarchy_.root_count || split_[owners_[(cell - hierarchy_.root_count) / 2]] != 0;
  }

  /// Splits the cells whose estimates are above `most`.
  void split_for_estimates(double most) {
    for (bool again = true; again;) {
      again = false;
      for (std::uint32_t d = 0; d < split_.size(); ++d) {
        if (split_[d] != 0) continue;
        const auto begin = hierarchy_.split_cells.begin();
        if (std::none_of(begin + hierarchy_.first_cells[d], begin + hierarchy_.first_cells[d + 1],
                         [&](auto cell) {
                           return hierarchy_.tree.cells[cell].interface_error > most && is_in_tree(cell);
                         }))
          continue;
        split(d);
        again = true;
      }
    }
  }

  /// Splits the cells where the shown interfaces are too far from the input's; returns whether there are any.
  bool split_failing_cells(const InterfaceMesh& shown) {
    Found failing(split_.size());
    find_far_input(failing);
    parallel_for(comparison_.far_shown().size(), 64,
                 [&](std::size_t i) { mark(cell_at(shown.centroid(comparison_.far_shown()[i])), failing); });
    for (const auto& points : comparison_.far_junctions()) {
      for (const Vec3& p : points) mark(cell_at(p), failing);
    }
    bool any = false;
    for (std::uint32_t d = 0; d < split_.size(); ++d) {
      if (!failing[d]) continue;
      split(d);
      any = true;
    }
    return any;
  }

  /// Marks the diamond that would split a cell.
  void mark(std::uint32_t cell, Found& failing) const {
    if (diamond_of_[cell] != kNone) failing[diamond_of_[cell]] = true;
  }

  /// Finds the cells with points of a material's boundary in the input that are too far from the shown
  /// boundary.
  void find_far_input(Found& failing) const {
    parallel_for(network_.triangles().size(), 16, [&](std::size_t i) {
      const auto t = static_cast<std::uint32_t>(i);
      for (std::size_t side = 0; side < 2; ++side) {
        if (!comparison_.too_far(t, side)) continue;
        const std::vector<std::uint32_t> cells = cells_of(t);
        bool explained = false;
        for (const std::uint32_t cell : cells) {
          if (!comparison_.has_far_point(t, side, frame(cell))) continue;
          mark(cell, failing);
          explained = true;
        }
        // If a triangle is too far only between the points that were checked, all of its cells are taken.
        for (std::size_t c = 0; c < cells.size() && !explained; ++c) mark(cells[c], failing);
      }
    });
  }

  [[nodiscard]] Tetrahedron frame(std::uint32_t cell) const {
    return Tetrahedron(hierarchy_.tree.corners(cell));
  }

  [[nodiscard]] bool is_split(std::uint32_t cell) const {
    return diamond_of_[cell] != kNone && split_[diamond_of_[cell]] != 0;
  }

  /// Returns the cells of the mesh that a triangle of the input meets.
  [[nodiscard]] std::vector<std::uint32_t> cells_of(std::uint32_t triangle) const {
    const auto& corners = network_.triangle_corners(triangle);
    std::vector<std::uint32_t> result, waiting;
    for (std::uint32_t root = 0; root < hierarchy_.root_count; ++root) waiting.push_back(root);
    while (!waiting.empty()) {
      const std::uint32_t cell = waiting.back();
      waiting.pop_back();
      if (!meets(frame(cell), corners[0], corners[1], corners[2])) continue;
      if (!is_split(cell)) {
        result.push_back(cell);
      } else {
        waiting.push_back(children_[cell]);
        waiting.push_back(children_[cell] + 1);
      }
    }
    return result;
  }

  /// Returns the cell of the mesh that holds a point.
  [[nodiscard]] std::uint32_t cell_at(const Vec3& p) const {
    const auto depth = [&](std::uint32_t cell) {
      const Weights w = frame(cell).weights(p);
      return std::min({w[0], w[1], w[2], w[3]});
    };
    std::uint32_t best = 0;
    double deepest = -std::numeric_limits<double>::infinity();
    for (std::uint32_t root = 0; root < hierarchy_.root_count; ++root) {
      const double found = depth(root);
      if (found > deepest) deepest = found, best = root;
    }
    while (is_split(best)) {
      const std::uint32_t child = children_[best];
      best = depth(child) >= depth(child + 1) ? child : child + 1;
    }
    return best;
  }

  SavedHierarchy& hierarchy_;
  const InterfaceNetwork& network_;
  Progress& progress_;
  InterfaceComparison comparison_;
  Selection selection_;
  std::vector<std::uint32_t> diamond_of_;  ///< by cell; kNone if it is not split in the hierarchy
  std::vector<std::uint32_t> children_;    ///< by split cell: the first of its children
  std::vector<std::uint32_t> owners_;      ///< by index in `split_cells`: the diamond that splits it
  std::vector<char> split_, certified_;    ///< by diamond: whether it is split in the mesh, and in the last
                                           ///< certified mesh
  std::vector<std::uint32_t> cells_;       ///< the cells of the mesh
  std::size_t certified_size_ = 0;         ///< the number of tetrahedra of the last certified mesh
  double least_error_ = 0;                 ///< the least certified error so far
};

}  // namespace

void certify_selections(SavedHierarchy& hierarchy, const ResamplingSource& source, Progress& progress) {
  hierarchy.interface_errors.assign(hierarchy.diamond_count(), 0.0);
  if (!source.network->triangles().empty()) Certifier(hierarchy, source, progress).run();
}

}  // namespace adamas::interfaces
