#include "core/picture/colour_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"

namespace adamas::picture {
namespace {

constexpr std::size_t kCells = 256;
constexpr std::size_t kSamplesPerSpan = 512;

LabColour lch(double lightness, double chroma, double hue) {
  const double angle = hue * std::numbers::pi / 180;
  return {lightness, chroma * std::cos(angle), chroma * std::sin(angle)};
}

double cubic(double before, double from, double to, double after, double t) {
  const double m0 = 0.5 * (to - before), m1 = 0.5 * (after - from), t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * from + (t3 - 2 * t2 + t) * m0 + (3 * t2 - 2 * t3) * to + (t3 - t2) * m1;
}

// The curve through the control points: a and b are smooth (Catmull-Rom), lightness is linear so that it
// stays monotone.
LabColour point_on_curve(const std::vector<LabColour>& points, std::size_t span, double t) {
  const LabColour &from = points[span], &to = points[span + 1];
  const LabColour& before = points[span > 0 ? span - 1 : 0];
  const LabColour& after = points[std::min(span + 2, points.size() - 1)];
  return {from.lightness + t * (to.lightness - from.lightness), cubic(before.a, from.a, to.a, after.a, t),
          cubic(before.b, from.b, to.b, after.b, t)};
}

double lab_distance(const LabColour& p, const LabColour& q) {
  return std::sqrt((p.lightness - q.lightness) * (p.lightness - q.lightness) + (p.a - q.a) * (p.a - q.a) +
                   (p.b - q.b) * (p.b - q.b));
}

/// A map of other authors, by colours at equal distances: 0xrrggbb.
struct KnownMap {
  std::string name;
  std::vector<std::uint32_t> colours;
};

const std::vector<KnownMap>& known_maps() {
  static const std::vector<KnownMap> kMaps{
      {"viridis",
       {0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6ece58, 0xb5de2b, 0xfde725}},
      {"magma",
       {0x000004, 0x180f3d, 0x440f76, 0x721f81, 0x9e2f7f, 0xcd4071, 0xf1605d, 0xfd9668, 0xfeca8d, 0xfcfdbf}},
      {"inferno",
       {0x000004, 0x1b0c41, 0x4a0c6b, 0x781c6d, 0xa52c60, 0xcf4446, 0xed6925, 0xfb9b06, 0xf7d13d, 0xfcffa4}},
      {"plasma",
       {0x0d0887, 0x46039f, 0x7201a8, 0x9c179e, 0xbd3786, 0xd8576b, 0xed7953, 0xfb9f3a, 0xfdca26, 0xf0f921}},
      {"cividis",
       {0x00204d, 0x00336f, 0x39486b, 0x575c6d, 0x707173, 0x8a8779, 0xa69d75, 0xc4b56c, 0xe4cf5b, 0xffea46}},
      {"cool-warm",
       {0x3b4cc0, 0x6282ea, 0x8db0fe, 0xb8d0f9, 0xdddddd, 0xf5c4ad, 0xf49a7b, 0xde604d, 0xb40426}},
  };
  return kMaps;
}

}  // namespace

ColourMap::ColourMap(const std::vector<LabColour>& control_points, std::size_t arms) {
  const std::size_t spans = control_points.size() - 1;
  for (std::size_t arm = 0; arm < arms; ++arm) {
    std::vector<LabColour> samples;
    for (std::size_t span = arm * spans / arms; span < (arm + 1) * spans / arms; ++span) {
      for (std::size_t k = 0; k <= kSamplesPerSpan; ++k) {
        const double t = static_cast<double>(k) / static_cast<double>(kSamplesPerSpan);
        samples.push_back(point_on_curve(control_points, span, t));
      }
    }
    if (arm == 0) table_.push_back(from_lab(samples.front()));
    append_arm(samples, kCells / arms);
  }
}

void ColourMap::append_arm(const std::vector<LabColour>& samples, std::size_t cells) {
  std::vector<double> length(samples.size(), 0);
  for (std::size_t i = 1; i < samples.size(); ++i)
    length[i] = length[i - 1] + lab_distance(samples[i - 1], samples[i]);
  std::size_t i = 0;
  for (std::size_t k = 1; k <= cells; ++k) {
    const double wanted = length.back() * static_cast<double>(k) / static_cast<double>(cells);
    while (i + 2 < samples.size() && length[i + 1] < wanted) ++i;
    const double t = (wanted - length[i]) / (length[i + 1] - length[i]);
    const LabColour &p = samples[i], &q = samples[i + 1];
    table_.push_back(from_lab(
        {p.lightness + t * (q.lightness - p.lightness), p.a + t * (q.a - p.a), p.b + t * (q.b - p.b)}));
  }
}

ColourMap ColourMap::sequential() {
  return ColourMap({lch(15, 40, 312), lch(33, 40, 288), lch(53, 29, 212), lch(74, 54, 148), lch(92, 80, 99)},
                   1);
}

ColourMap ColourMap::diverging() {
  return ColourMap({lch(30, 38, 278), lch(60, 34, 268), lch(93, 0, 0), lch(60, 44, 36), lch(30, 46, 33)}, 2);
}

ColourMap ColourMap::grey() { return ColourMap({lch(12, 0, 0), lch(97, 0, 0)}, 1); }

ColourMap::ColourMap(const std::vector<std::uint32_t>& colours) {
  std::vector<LabColour> known;
  for (const std::uint32_t rgb : colours) {
    const auto part = [rgb](unsigned shift) { return ((rgb >> shift) & 0xffu) / 255.0; };
    known.push_back(to_lab({part(16), part(8), part(0)}));
  }
  for (std::size_t k = 0; k <= kCells; ++k) {
    const double place = static_cast<double>(k * (known.size() - 1)) / static_cast<double>(kCells);
    const std::size_t span = std::min(static_cast<std::size_t>(place), known.size() - 2);
    const double t = place - static_cast<double>(span);
    const LabColour &p = known[span], &q = known[span + 1];
    table_.push_back(from_lab(
        {p.lightness + t * (q.lightness - p.lightness), p.a + t * (q.a - p.a), p.b + t * (q.b - p.b)}));
  }
}

const std::vector<std::string>& ColourMap::names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names{"sequential", "diverging", "grey"};
    for (const KnownMap& map : known_maps()) names.push_back(map.name);
    return names;
  }();
  return kNames;
}

ColourMap ColourMap::by_name(std::string_view name) {
  if (name == "sequential") return sequential();
  if (name == "diverging") return diverging();
  if (name == "grey") return grey();
  for (const KnownMap& map : known_maps()) {
    if (map.name == name) return ColourMap(map.colours);
  }
  fail("colour map: expected one of {}, found '{}'", fmt::join(names(), ", "), name);
}

Colour ColourMap::at(double t) const {
  if (std::isnan(t)) return no_data();
  const double position = std::clamp(t, 0.0, 1.0) * static_cast<double>(table_.size() - 1);
  const std::size_t cell = std::min(static_cast<std::size_t>(position), table_.size() - 2);
  return mix(table_[cell], table_[cell + 1], position - static_cast<double>(cell));
}

}  // namespace adamas::picture
