#include "isosurface/gradients/direction_code.h"

#include <algorithm>
#include <cmath>

namespace adamas::isosurface {

namespace {

using Bytes = std::array<std::uint8_t, 3>;

/// Codes run from 1 to 255 for -1 to 1, so that 0 is exact; 0 is left for vectors without a direction.
constexpr double kSteps = 127;
constexpr int kMiddle = 128;

std::uint8_t code_of(double x) { return static_cast<std::uint8_t>(kMiddle + std::lround(kSteps * x)); }
double value_of(std::uint8_t code) { return std::max(-1.0, (code - kMiddle) / kSteps); }

/// y in seven bits: 1 to 127 for -1 to 1.
constexpr double kYSteps = 63;
constexpr int kYMiddle = 64;

double sign(double x) { return x < 0 ? -1 : 1; }

Vec3 unit(const Vec3& v) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : Vec3{};
}

/// The lower half of the octahedron is folded outwards; to do so twice gives back the first.
std::array<double, 2> folded(double u, double v) {
  return {(1 - std::abs(v)) * sign(u), (1 - std::abs(u)) * sign(v)};
}

/// The code of integers next to u and v whose direction is nearest to n; rounding u and v need not give it.
template <class Decode, class Code>
Bytes nearest(const Vec3& n, double u, double v, Decode&& decode, Code&& code) {
  Bytes best{};
  double greatest = -2;
  for (const double a : {std::floor(u), std::ceil(u)}) {
    for (const double b : {std::floor(v), std::ceil(v)}) {
      const Bytes bytes = code(a, b);
      const double cosine = dot(n, decode(bytes));
      if (cosine > greatest) greatest = cosine, best = bytes;
    }
  }
  return best;
}

Vec3 decode_octahedral(const Bytes& bytes) {
  if (bytes[0] == 0 && bytes[1] == 0) return {};
  double u = value_of(bytes[0]), v = value_of(bytes[1]);
  const double z = 1 - std::abs(u) - std::abs(v);
  if (z < 0) {
    const auto [x, y] = folded(u, v);
    u = x, v = y;
  }
  return unit({u, v, z});
}

Bytes encode_octahedral(const Vec3& n) {
  const double sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  double u = n.x / sum, v = n.y / sum;
  if (n.z < 0) {
    const auto [x, y] = folded(u, v);
    u = x, v = y;
  }
  return nearest(n, kSteps * u, kSteps * v, decode_octahedral, [](double a, double b) {
    return Bytes{code_of(a / kSteps), code_of(b / kSteps), 0};
  });
}

Vec3 decode_two_components(const Bytes& bytes) {
  const int y_code = bytes[1] >> 1;
  if (bytes[0] == 0 && y_code == 0) return {};
  const double x = value_of(bytes[0]), y = std::max(-1.0, (y_code - kYMiddle) / kYSteps);
  const double z = std::sqrt(std::max(0.0, 1 - x * x - y * y));
  return unit({x, y, (bytes[1] & 1) != 0 ? -z : z});
}

Bytes encode_two_components(const Vec3& n) {
  const unsigned below = n.z < 0 ? 1 : 0;
  return nearest(n, kSteps * n.x, kYSteps * n.y, decode_two_components, [below](double a, double b) {
    const auto y = static_cast<unsigned>(kYMiddle + std::lround(b));
    return Bytes{code_of(a / kSteps), static_cast<std::uint8_t>(y << 1 | below), 0};
  });
}

}  // namespace

Bytes encode_direction(DirectionCode code, const Vec3& direction) {
  const double scale = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  if (!(scale > 0) || !std::isfinite(direction.x + direction.y + direction.z)) return {};
  // The squares of very great or small components would not be numbers.
  const Vec3 n = unit({direction.x / scale, direction.y / scale, direction.z / scale});
  switch (code) {
    case DirectionCode::kOctahedral:
      return encode_octahedral(n);
    case DirectionCode::kComponents:
      return {code_of(n.x), code_of(n.y), code_of(n.z)};
    case DirectionCode::kTwoComponents:
      return encode_two_components(n);
  }
  return {};
}

Vec3 decode_direction(DirectionCode code, const Bytes& bytes) {
  switch (code) {
    case DirectionCode::kOctahedral:
      return decode_octahedral(bytes);
    case DirectionCode::kComponents:
      if (bytes[0] == 0 && bytes[1] == 0 && bytes[2] == 0) return {};
      return unit({value_of(bytes[0]), value_of(bytes[1]), value_of(bytes[2])});
    case DirectionCode::kTwoComponents:
      return decode_two_components(bytes);
  }
  return {};
}

}  // namespace adamas::isosurface
