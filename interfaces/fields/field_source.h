#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/typed_id.h"

namespace adamas::interfaces {

/// The name, unit and size of a field. Its values begin at `offset` in a row of all fields' components.
struct FieldInfo {
  std::string name;
  std::string unit;
  int components = 1;
  std::size_t offset = 0;
  /// The range of the native values, or of the lengths of vectors, without those of minorities.
  double min = 0, max = 0;

  /// Returns the index after its last component in a row.
  [[nodiscard]] std::size_t end() const { return offset + static_cast<std::size_t>(components); }
};

/// The part of a native element that its material has.
enum class ElementKind : std::uint8_t {
  kPure,      ///< the material has nearly all of it
  kMixed,     ///< the material has its centre, but not all of it
  kMinority,  ///< the material has a part, but another one has the centre
};
inline constexpr std::size_t kElementKinds = 3;

/// A place where the input states values of a material: the unit in which field errors are measured (D 3.6).
struct NativeElement {
  Vec3 position;
  MaterialId material;
  ElementKind kind;
  std::size_t site;  ///< a number for the source's internal use
};

/// Evaluates the fields of the input at any point, for each material from its own side (D 3.3).
class FieldSource {
 public:
  virtual ~FieldSource() = default;
  [[nodiscard]] virtual const std::vector<FieldInfo>& fields() const = 0;
  /// Returns the number of components of all fields, which is the length of rows.
  [[nodiscard]] virtual std::size_t row_size() const = 0;
  /// Evaluates a material's fields at p; the value is NaN for a field that the material does not have.
  virtual void values(MaterialId material, const Vec3& p, std::span<double> row) const = 0;
  /// Evaluates values and one-sided derivatives; `gradients[c]` belongs to component c.
  virtual void values_and_gradients(MaterialId material, const Vec3& p, std::span<double> row,
                                    std::span<Vec3> gradients) const = 0;
  /// Evaluates, at a point p outside the material, the linear functions that fit, by least squares, the
  /// values stated for the material round `near`, its closest point.
  virtual void fitted_values(MaterialId material, const Vec3& p, const Vec3& near,
                             std::span<double> row) const = 0;
  [[nodiscard]] virtual const std::vector<NativeElement>& native_elements() const = 0;
  /// Returns the values that the input states at a native element; NaN if it states none for the element's
  /// material.
  virtual void native_values(const NativeElement& element, std::span<double> row) const = 0;
  /// Returns whether the material's field has the stated value at the element. This is false if one value
  /// holds for several materials.
  [[nodiscard]] virtual bool interpolates(const NativeElement& element, std::size_t field) const = 0;
};

}  // namespace adamas::interfaces
