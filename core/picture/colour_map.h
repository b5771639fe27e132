#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/picture/colour.h"

namespace adamas::picture {

/// A continuous colour map. Those of our own are in equal steps of CIE L*a*b* distance; those that people
/// know from elsewhere are linear in L*a*b* between some of their colours.
class ColourMap {
 public:
  /// Dark violet over blue and green to yellow, lightness rising throughout: the default for fields.
  static ColourMap sequential();
  /// Blue over near-white to red, symmetric in lightness: for signed quantities about a middle value.
  static ColourMap diverging();
  /// Dark to light grey, lightness linear.
  static ColourMap grey();
  /// Our own, then viridis, magma, inferno, plasma (Smith and van der Walt 2015), cividis (Nunez, Anderton
  /// and Renslow 2018) and cool-warm (Moreland 2009). Throws Error for another name than those of names().
  static ColourMap by_name(std::string_view name);
  static const std::vector<std::string>& names();

  /// The colour at t in 0..1; values outside take the ends. NaN takes `no_data()`.
  [[nodiscard]] Colour at(double t) const;
  /// The colour of missing values, which occurs in no map.
  static constexpr Colour no_data() { return {0.80, 0.76, 0.78}; }

 private:
  /// `arms`: 1, or 2 for maps whose middle control point belongs in the middle; steps are equal within an
  /// arm.
  ColourMap(const std::vector<LabColour>& control_points, std::size_t arms);
  explicit ColourMap(const std::vector<std::uint32_t>& colours);
  void append_arm(const std::vector<LabColour>& samples, std::size_t cells);

  std::vector<Colour> table_;
};

}  // namespace adamas::picture
