#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/typed_id.h"

namespace adamas::interfaces {

/// Name, unit and size of a field; its values stand in a row of all fields' components from `offset` on.
struct FieldInfo {
  std::string name;
  std::string unit;
  int components = 1;
  std::size_t offset = 0;
  /// The range of the native values, or of the lengths of vectors, without those of minorities.
  double min = 0, max = 0;
};

/// The part that a material has of the place where a value of it is stated.
enum class ElementKind : std::uint8_t {
  kPure,      ///< (nearly) all of it
  kMixed,     ///< its centre, but not all of it
  kMinority,  ///< a part, while the centre is another material's
};
inline constexpr std::size_t kElementKinds = 3;

/// A place where the input states values of a material: the unit in which field errors are measured (D 3.6).
struct NativeElement {
  Vec3 position;
  MaterialId material;
  ElementKind kind;
  std::size_t site;  ///< a number for the source's own use
};

/// The fields of the input at any point, per material and from its own side (D 3.3).
class FieldSource {
 public:
  virtual ~FieldSource() = default;
  [[nodiscard]] virtual const std::vector<FieldInfo>& fields() const = 0;
  /// Components of all fields together: the length of the rows below.
  [[nodiscard]] virtual std::size_t row_size() const = 0;
  /// Values of a material's fields at p; NaN for a field that the material has not.
  virtual void values(MaterialId material, const Vec3& p, std::span<double> row) const = 0;
  /// Values and one-sided derivatives: `gradients[c]` of component c.
  virtual void values_and_gradients(MaterialId material, const Vec3& p, std::span<double> row,
                                    std::span<Vec3> gradients) const = 0;
  /// Values at p, outside of the material, of the linear functions that fit what is stated for the material
  /// round `near`, its closest point, in the sense of least squares.
  virtual void fitted_values(MaterialId material, const Vec3& p, const Vec3& near,
                             std::span<double> row) const = 0;
  [[nodiscard]] virtual const std::vector<NativeElement>& native_elements() const = 0;
  /// The values the input states at a native element; NaN where it states none for the element's material.
  virtual void native_values(const NativeElement& element, std::span<double> row) const = 0;
  /// Whether the material's field passes through the value stated at the element. It does not where the value
  /// is one for several materials.
  [[nodiscard]] virtual bool interpolates(const NativeElement& element, std::size_t field) const = 0;
};

}  // namespace adamas::interfaces
