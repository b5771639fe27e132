#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/picture/colour.h"

namespace adamas::picture {

/// A continuous colour map. Our own maps have equal steps of CIE L*a*b* distance; well-known maps of other
/// authors are linear in L*a*b* between some of their colours.
class ColourMap {
 public:
  /// Dark violet through blue and green to yellow, with lightness rising throughout: the default for fields.
  static ColourMap sequential();
  /// Blue through near-white to red, symmetric in lightness: for signed quantities about a middle value.
  static ColourMap diverging();
  /// Dark to light grey, with linear lightness.
  static ColourMap grey();
  /// A map by its name: our own, viridis, magma, inferno, plasma (Smith and van der Walt 2015), cividis
  /// (Nunez, Anderton and Renslow 2018) and cool-warm (Moreland 2009). Throws Error for a name that is not
  /// among names().
  static ColourMap by_name(std::string_view name);
  static const std::vector<std::string>& names();

  /// The colour at t in 0..1; values outside get the colour of the nearer end, NaN gets `no_data()`.
  [[nodiscard]] Colour at(double t) const;
  /// The colour of missing values, which occurs in no map.
  static constexpr Colour no_data() { return {0.80, 0.76, 0.78}; }

 private:
  /// `arms`: 1, or 2 for maps whose middle control point is at t = 1/2; steps are equal within an arm.
  ColourMap(const std::vector<LabColour>& control_points, std::size_t arms);
  explicit ColourMap(const std::vector<std::uint32_t>& colours);
  void append_arm(const std::vector<LabColour>& samples, std::size_t cells);

  std::vector<Colour> table_;
};

}  // namespace adamas::picture
