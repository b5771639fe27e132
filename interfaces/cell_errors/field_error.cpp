#include "interfaces/cell_errors/field_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/box_clip.h"
#include "interfaces/cell_errors/hull_distance.h"

namespace adamas::interfaces {

namespace {

/// The least error of an element without a value to compare with.
constexpr double kNone = std::numeric_limits<double>::infinity();
/// The box round a displaced element grows by this factor, three times.
constexpr double kGrowth = 3;

class Measurer {
 public:
  Measurer(const ResamplingSource& source, const CellView& cell, double half_width,
           const CellsInBox& cells_in_box)
      : source_(source),
        cell_(cell),
        half_width_(half_width),
        cells_in_box_(cells_in_box),
        native_(source.fields->row_size()) {}

  /// Adds the errors at an element whose place the mesh gives to its own material; returns false for other
  /// elements.
  bool measure(std::uint32_t number, std::span<FieldError> errors) {
    const NativeElement& element = source_.fields->native_elements()[number];
    const Weights weights = cell_.frame.weights(element.position);
    const OwnershipProblem& problem = cell_.owners.problem;
    const BodyId owner(cell_.owners.pure() ? problem.candidates[0].owner : problem.owner(weights));
    if (material(owner) != element.material) return false;
    source_.fields->native_values(element, native_);
    const auto& fields = source_.fields->fields();
    const Rows rows = rows_of(cell_, owner);
    for (std::size_t f = 0; f < fields.size(); ++f)
      add(error_at(rows, fields[f], weights), f, number, false, errors[f]);
    return true;
  }

  /// Adds the errors at a displaced element. The box grows to its full size only while an error is above its
  /// limit.
  void measure_displaced(std::uint32_t number, std::span<const double> limits, NoPartNear no_part,
                         std::span<FieldError> errors) {
    const NativeElement& element = source_.fields->native_elements()[number];
    source_.fields->native_values(element, native_);
    const auto& fields = source_.fields->fields();
    std::vector<double> least;
    for (const FieldInfo& field : fields)
      least.push_back(std::isnan(native_[field.offset]) ? native_[field.offset] : kNone);
    for (double reach = half_width_ / kGrowth / kGrowth / kGrowth;;
         reach = std::min(kGrowth * reach, half_width_)) {
      lower_errors(element, reach, least);
      bool good = true;
      for (std::size_t f = 0; f < fields.size(); ++f) good = good && !(least[f] > limits[f]);
      if (good || reach >= half_width_) break;
    }
    for (std::size_t f = 0; f < fields.size(); ++f) {
      // If the mesh has no part of the element's material there, nothing approximates the value.
      if (least[f] == kNone && element.kind != ElementKind::kMinority &&
          no_part == NoPartNear::kCountsAsRange)
        least[f] = std::max(native_size(fields[f]), fields[f].max - fields[f].min);
      add(least[f], f, number, true, errors[f]);
    }
  }

 private:
  /// The values of a body's fields at a cell's vertices.
  using Rows = std::array<std::span<const double>, 4>;

  [[nodiscard]] MaterialId material(BodyId body) const { return source_.network->table().material(body); }

  /// Adds the error of a field to the sum. Smaller cells do not reduce the error of a displaced minority,
  /// since the input itself gives its place to another material. Fields without a value at the element or in
  /// the material have no error there.
  void add(double error, std::size_t field, std::uint32_t number, bool displaced, FieldError& sum) const {
    const NativeElement& element = source_.fields->native_elements()[number];
    if (error < kNone) {
      const bool elsewhere = displaced && element.kind == ElementKind::kMinority;
      const bool reducible = !elsewhere && source_.fields->interpolates(element, field);
      sum.add({error, number, element.kind, displaced, reducible});
    } else if (element.kind != ElementKind::kMinority || error == kNone) {
      ++sum.without_value;
    }
  }

  [[nodiscard]] static Rows rows_of(const CellView& cell, BodyId body) {
    Rows rows;
    for (std::size_t v = 0; v < 4; ++v) rows[v] = cell.vertices[v]->row(body);
    return rows;
  }

  [[nodiscard]] static double value_at(const Rows& rows, std::size_t component, const Weights& weights) {
    double value = 0;
    for (std::size_t v = 0; v < 4; ++v) value += weights[v] * rows[v][component];
    return value;
  }

  [[nodiscard]] double error_at(const Rows& rows, const FieldInfo& field, const Weights& weights) const {
    double squared = 0;
    for (std::size_t c = field.offset; c < field.end(); ++c) {
      const double value = value_at(rows, c, weights);
      squared += (value - native_[c]) * (value - native_[c]);
    }
    return std::sqrt(squared);
  }

  /// Reduces the least errors found so far to those that the element's own material has within the box.
  void lower_errors(const NativeElement& element, double half_width, std::vector<double>& least) {
    const auto& fields = source_.fields->fields();
    const Vec3 reach{half_width, half_width, half_width};
    const Box3 box{element.position - reach, element.position + reach};
    cells_in_box_(box, element.material, [&](const CellView& cell) {
      // The body of the previous piece and its values are kept, since the pieces of one owner are
      // consecutive.
      BodyId body;
      Rows rows;
      bool useful = false;
      for (const OwnedTetrahedron& piece : cell.parts) {
        if (const BodyId owner(piece.owner); owner != body) {
          body = owner;
          useful = material(body) == element.material;
          if (useful) rows = rows_of(cell, body);
        }
        useful = useful && may_lower(rows, least);
        if (!useful) continue;
        std::array<Vec3, 4> corners;
        Box3 bounds;
        for (std::size_t c = 0; c < 4; ++c) bounds.extend(corners[c] = cell.frame.point(piece.corners[c]));
        if (!bounds.touches(box)) continue;
        part_.clear();
        for (const Vec3& corner : clip_to_box(corners, box)) part_.push_back(cell.frame.weights(corner));
        if (part_.empty()) continue;
        for (std::size_t f = 0; f < fields.size(); ++f)
          least[f] = std::min(least[f], least_error(fields[f], rows));
      }
    });
  }

  /// Returns whether the values at a cell's vertices, which bound all others, allow lower errors.
  [[nodiscard]] bool may_lower(const Rows& rows, const std::vector<double>& least) const {
    const auto& fields = source_.fields->fields();
    for (std::size_t f = 0; f < fields.size(); ++f) {
      double squared = 0;
      for (std::size_t c = fields[f].offset; c < fields[f].end(); ++c) {
        const auto [low, high] = std::minmax({rows[0][c], rows[1][c], rows[2][c], rows[3][c]});
        const double outside = std::max({0.0, low - native_[c], native_[c] - high});
        squared += outside * outside;
      }
      if (squared < least[f] * least[f]) return true;
    }
    return false;
  }

  [[nodiscard]] double native_size(const FieldInfo& field) const {
    double squared = 0;
    for (std::size_t c = field.offset; c < field.end(); ++c) squared += native_[c] * native_[c];
    return std::sqrt(squared);
  }

  /// Returns the least error over the part; its values are the convex hull of the values at its corners.
  [[nodiscard]] double least_error(const FieldInfo& field, const Rows& rows) {
    differences_.clear();
    double low = kNone, high = -kNone;
    for (const Weights& w : part_) {
      for (std::size_t c = field.offset; c < field.end(); ++c) {
        differences_.push_back(value_at(rows, c, w) - native_[c]);
        low = std::min(low, differences_.back()), high = std::max(high, differences_.back());
      }
    }
    if (field.components == 1) return std::max({0.0, low, -high});
    const bool known =
        std::all_of(differences_.begin(), differences_.end(), [](double d) { return std::isfinite(d); });
    return known ? distance_from_hull(differences_, field.end() - field.offset) : kNone;
  }

  const ResamplingSource& source_;
  const CellView& cell_;
  double half_width_;
  const CellsInBox& cells_in_box_;
  std::vector<double> native_;
  std::vector<Weights> part_;        ///< the corners of a convex part of the element's material within the
                                     ///< box
  std::vector<double> differences_;  ///< the differences of the part's corner values from the native values
};

}  // namespace

std::vector<std::uint32_t> measure_field_errors(const ResamplingSource& source, const CellView& cell,
                                                std::span<const std::uint32_t> elements,
                                                std::span<FieldError> errors) {
  const CellsInBox none;
  Measurer measurer(source, cell, 0, none);
  std::vector<std::uint32_t> displaced;
  for (const std::uint32_t e : elements) {
    if (!measurer.measure(e, errors)) displaced.push_back(e);
  }
  return displaced;
}

void measure_displaced_errors(const ResamplingSource& source, const CellView& cell,
                              std::span<const std::uint32_t> displaced, double half_width,
                              const CellsInBox& cells_in_box, std::span<const double> limits,
                              std::span<FieldError> errors, NoPartNear no_part) {
  Measurer measurer(source, cell, half_width, cells_in_box);
  for (const std::uint32_t e : displaced) measurer.measure_displaced(e, limits, no_part, errors);
}

}  // namespace adamas::interfaces
