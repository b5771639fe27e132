#include "interfaces/errors/field_error.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/geometry/box_clip.h"

namespace adamas {

namespace {

class Measurer {
 public:
  Measurer(const ResamplingSource& source, const Tetrahedron& cell, const CellOwnership& ownership,
           const std::array<const VertexRecord*, 4>& vertices, double warp)
      : source_(source), cell_(cell), ownership_(ownership), vertices_(vertices), warp_(warp) {
    native_.resize(source.fields->row_size());
  }

  void measure(const NativeElement& element, std::span<FieldError> errors) {
    source_.fields->native_values(element, native_);
    const Weights weights = cell_.weights(element.position);
    const BodyId owner(ownership_.pure() ? ownership_.problem.candidates[0].owner
                                         : ownership_.problem.owner(weights));
    const bool own = material(owner) == element.material;
    const auto& fields = source_.fields->fields();
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (std::isnan(native_[fields[f].offset])) continue;
      const double error =
          own ? error_at(fields[f], owner, weights) : error_nearby(fields[f], element, weights);
      if (!std::isnan(error)) errors[f].add(error);
    }
  }

 private:
  [[nodiscard]] MaterialId material(BodyId body) const { return source_.network->table().material(body); }

  [[nodiscard]] double error_at(const FieldInfo& field, BodyId body, const Weights& weights) const {
    double squared = 0;
    for (std::size_t c = field.offset; c < field.offset + static_cast<std::size_t>(field.components); ++c) {
      double value = 0;
      for (std::size_t v = 0; v < 4; ++v) value += weights[v] * vertices_[v]->row(body)[c];
      squared += (value - native_[c]) * (value - native_[c]);
    }
    return std::sqrt(squared);
  }

  /// The element's place went to another material: the best its own material does within the box.
  double error_nearby(const FieldInfo& field, const NativeElement& element, const Weights& weights) {
    if (!parts_) {
      parts_.emplace();
      if (!ownership_.pure()) partition_tetrahedron(ownership_.problem, *parts_);
    }
    std::optional<double> best;
    const Box3 box{element.position - Vec3{warp_, warp_, warp_},
                   element.position + Vec3{warp_, warp_, warp_}};
    for (const OwnedTetrahedron& part : *parts_) {
      const BodyId body(part.owner);
      if (material(body) != element.material) continue;
      const std::vector<Vec3> corners = corners_within(part, box);
      if (corners.empty()) continue;
      const double error = least_error(field, body, corners);
      best = best ? std::min(*best, error) : error;
    }
    if (best) return *best;
    // None of the material within the box: its field as continued to the element's place.
    best.reset();
    for (const auto& candidate : ownership_.problem.candidates) {
      if (material(BodyId(candidate.owner)) != element.material) continue;
      const double error = error_at(field, BodyId(candidate.owner), weights);
      best = best ? std::min(*best, error) : error;
    }
    return best.value_or(native_size(field));
  }

  /// Where the material is unknown to the cell nothing approximates the value.
  [[nodiscard]] double native_size(const FieldInfo& field) const {
    double squared = 0;
    for (std::size_t c = field.offset; c < field.offset + static_cast<std::size_t>(field.components); ++c) {
      squared += native_[c] * native_[c];
    }
    return std::max(std::sqrt(squared), field.max - field.min);
  }

  [[nodiscard]] std::vector<Vec3> corners_within(const OwnedTetrahedron& part, const Box3& box) const {
    std::array<Vec3, 4> corners;
    for (std::size_t c = 0; c < 4; ++c) corners[c] = cell_.point(part.corners[c]);
    return clip_to_box(corners, box);
  }

  /// Least error over a convex set given by its corners. Scalars: nothing if the value lies between the
  /// corners' values.
  [[nodiscard]] double least_error(const FieldInfo& field, BodyId body,
                                   const std::vector<Vec3>& corners) const {
    double least = std::numeric_limits<double>::infinity();
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& corner : corners) {
      const Weights w = cell_.weights(corner);
      least = std::min(least, error_at(field, body, w));
      if (field.components > 1) continue;
      double value = 0;
      for (std::size_t v = 0; v < 4; ++v) value += w[v] * vertices_[v]->row(body)[field.offset];
      low = std::min(low, value), high = std::max(high, value);
    }
    const double native = native_[field.offset];
    return field.components == 1 && low <= native && native <= high ? 0 : least;
  }

  const ResamplingSource& source_;
  const Tetrahedron& cell_;
  const CellOwnership& ownership_;
  const std::array<const VertexRecord*, 4>& vertices_;
  double warp_;
  std::vector<double> native_;
  std::optional<std::vector<OwnedTetrahedron>> parts_;
};

}  // namespace

void measure_field_errors(const ResamplingSource& source, const Tetrahedron& cell,
                          const CellOwnership& ownership, const std::array<const VertexRecord*, 4>& vertices,
                          std::span<const std::uint32_t> elements, double warp,
                          std::span<FieldError> errors) {
  Measurer measurer(source, cell, ownership, vertices, warp);
  const auto& all = source.fields->native_elements();
  for (const std::uint32_t e : elements) measurer.measure(all[e], errors);
}

}  // namespace adamas
