#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/picture/canvas.h"
#include "core/picture/legend.h"

namespace adamas::picture {

enum class AxisKind { kLinear, kLogarithmic };

/// An axis of a plot. Without a range it covers all points.
struct PlotAxis {
  std::string label{};  ///< contains the unit, as "error [cm]"
  AxisKind kind = AxisKind::kLinear;
  std::optional<double> low{}, high{};
};

/// A series of points (x[i], y[i]), joined in the order given. Points that are not finite, or not positive on
/// a logarithmic axis, are left out and interrupt the line.
struct PlotSeries {
  std::string name{};
  std::vector<double> x{}, y{};
  bool line = true;
  bool markers = true;
  bool dashed = false;             ///< whether its line is dashed; each series has a pattern of its own
  std::optional<Colour> colour{};  ///< default: by the index of the series
  std::optional<std::size_t>
      marker{};       ///< number of its shape; default: by its index among those with markers
  bool open = false;  ///< the markers are outlines, larger than filled ones
};

/// A diagram of lines and points, such as error against number of tetrahedra.
struct Plot {
  std::string title{};
  PlotAxis x{}, y{};
  std::vector<PlotSeries> series{};
};

/// Sizes in pixels (SVG and PDF: half points).
struct PlotOptions {
  double width = 1400;
  double height = 900;
  double font_size = 0;     ///< 0: derived from the width
  std::size_t columns = 0;  ///< number of plots in a row, for several plots; 0: all in one row
};

/// Draws a plot and returns the file's bytes. Throws Error if the x and y of a series differ in number, and
/// for a range that is empty or not positive on a logarithmic axis.
std::string draw_plot(const Plot& plot, PictureFormat format, const PlotOptions& options = {});
/// Draws several plots, side by side or in rows, each with the size in the options. The document's title is
/// that of the first plot.
std::string draw_plots(std::span<const Plot> plots, PictureFormat format, const PlotOptions& options = {});

}  // namespace adamas::picture
