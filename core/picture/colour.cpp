#include "core/picture/colour.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace adamas::picture {
namespace {

using Matrix3 = std::array<std::array<double, 3>, 3>;
using Triple = std::array<double, 3>;

// The primaries of IEC 61966-2-1, with white D65.
constexpr Matrix3 kRgbToXyz{{{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}}};
constexpr Matrix3 kXyzToRgb{{{3.2406254773200533, -1.5372079722103187, -0.4986285986982479},
                             {-0.9689307147293197, 1.8757560608852415, 0.0415175238429540},
                             {0.0557101204455106, -0.2040210505984867, 1.0569959422543882}}};
constexpr Triple kWhite{0.9505, 1.0, 1.0890};
constexpr double kEpsilon = 216.0 / 24389.0;
constexpr double kKappa = 24389.0 / 27.0;

Triple operator*(const Matrix3& m, const Triple& v) {
  Triple result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return result;
}

double decode(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }
double encode(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }

Triple to_linear(const Colour& c) { return {decode(c.r), decode(c.g), decode(c.b)}; }

Colour from_linear(const Triple& v) {
  return {encode(std::clamp(v[0], 0.0, 1.0)), encode(std::clamp(v[1], 0.0, 1.0)),
          encode(std::clamp(v[2], 0.0, 1.0))};
}

double lab_curve(double v) { return v > kEpsilon ? std::cbrt(v) : (kKappa * v + 16) / 116; }
double lab_inverse(double f) { return f * f * f > kEpsilon ? f * f * f : (116 * f - 16) / kKappa; }

Triple linear_of(const LabColour& lab) {
  const double fy = (lab.lightness + 16) / 116;
  const Triple xyz{kWhite[0] * lab_inverse(fy + lab.a / 500), kWhite[1] * lab_inverse(fy),
                   kWhite[2] * lab_inverse(fy - lab.b / 200)};
  return kXyzToRgb * xyz;
}

bool can_be_shown(const Triple& linear) {
  return std::all_of(linear.begin(), linear.end(), [](double v) { return v >= -1e-9 && v <= 1 + 1e-9; });
}

}  // namespace

LabColour to_lab(const Colour& colour) {
  const Triple xyz = kRgbToXyz * to_linear(colour);
  const double fx = lab_curve(xyz[0] / kWhite[0]), fy = lab_curve(xyz[1] / kWhite[1]),
               fz = lab_curve(xyz[2] / kWhite[2]);
  return {116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)};
}

Colour from_lab(const LabColour& lab) {
  const double lightness = std::clamp(lab.lightness, 0.0, 100.0);
  const Triple whole = linear_of({lightness, lab.a, lab.b});
  if (can_be_shown(whole)) return from_linear(whole);
  // Parts of the chroma: with the first the colour can be shown, with the second it cannot.
  double low = 0, high = 1;
  for (int step = 0; step < 40; ++step) {
    const double middle = 0.5 * (low + high);
    (can_be_shown(linear_of({lightness, middle * lab.a, middle * lab.b})) ? low : high) = middle;
  }
  return from_linear(linear_of({lightness, low * lab.a, low * lab.b}));
}

Colour from_lch(double lightness, double chroma, double hue) {
  const double angle = hue * std::numbers::pi / 180;
  return from_lab({lightness, chroma * std::cos(angle), chroma * std::sin(angle)});
}

Colour seen_by(Vision vision, const Colour& colour) {
  constexpr Matrix3 kProtan{
      {{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}};
  constexpr Matrix3 kDeutan{
      {{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}};
  if (vision == Vision::kNormal) return colour;
  return from_linear((vision == Vision::kProtanope ? kProtan : kDeutan) * to_linear(colour));
}

std::array<std::uint8_t, 3> to_bytes(const Colour& colour) {
  const auto byte = [](double v) { return static_cast<std::uint8_t>(255 * std::clamp(v, 0.0, 1.0) + 0.5); };
  return {byte(colour.r), byte(colour.g), byte(colour.b)};
}

}  // namespace adamas::picture
