#include "isosurface/gradients/octahedral_codes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/assert.h"

namespace adamas::isosurface {

namespace {

/// Two directions are encoded at once, with the vector types of g++ and clang and a select by a comparison.
using Pair [[gnu::vector_size(16)]] = double;
using Mask [[gnu::vector_size(16)]] = std::int64_t;
constexpr std::size_t kLanes = 2;

constexpr std::size_t kBlock = 256;
constexpr double kSteps = 127;
constexpr int kMiddle = 128;
/// Components within these limits have sums of squares that neither overflow nor underflow.
constexpr double kLeast = 1e-150, kMost = 1e150;
/// Squared cosines with a relative difference below this may be in another order by rounding.
constexpr double kTie = 1e-13;

/// Codes are 1 to 255 for -1 to 1, so that 0 is exact; code 0 is for vectors without a direction.
std::uint8_t code_of(double x) { return static_cast<std::uint8_t>(kMiddle + std::lround(kSteps * x)); }
double value_of(std::uint8_t code) { return std::max(-1.0, (code - kMiddle) / kSteps); }

double sign_of(double x) { return x < 0 ? -1 : 1; }

Vec3 unit(const Vec3& v) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : Vec3{};
}

/// Folds the lower half of the octahedron outwards, and back.
std::array<double, 2> folded(double u, double v) {
  return {(1 - std::abs(v)) * sign_of(u), (1 - std::abs(u)) * sign_of(v)};
}

inline Pair both(double x) { return Pair{x, x}; }
inline Pair magnitude(Pair x) { return x < both(0) ? -x : x; }
/// Returns the sign as sign_of() does: 1 for -0.
inline Pair sign(Pair x) { return x < both(0) ? both(-1) : both(1); }

/// Returns the greatest integer that is not greater; x must be small.
inline Pair floor_of(Pair x) {
  // Doubles of this size are integers.
  const Pair whole = both(6755399441055744.0);
  const Pair rounded = (x + whole) - whole;
  return rounded > x ? rounded - both(1) : rounded;
}

/// A code, and its similarity to the direction to be encoded: the cosine is sqrt(dot2 / length2).
struct Candidate {
  Pair a, b, dot2, length2;
};

/// Returns the code of the integer steps a and b, compared with (x, y, z).
inline Candidate candidate(Pair a, Pair b, Pair x, Pair y, Pair z) {
  const Pair width = magnitude(a), depth = magnitude(b);
  const Pair height = both(kSteps) - width - depth;
  const Mask below = height < both(0);
  const Pair u = below ? (both(kSteps) - depth) * sign(a) : a;
  const Pair v = below ? (both(kSteps) - width) * sign(b) : b;
  const Pair dot = x * u + y * v + z * height;
  return {a, b, dot * dot, u * u + v * v + height * height};
}

/// Keeps the better of the two. Adds lanes to `unsure` where the difference is so small that
/// encode_octahedral(Vec3) decides.
inline void keep_better(Candidate& best, const Candidate& other, Mask& unsure) {
  const Pair mine = best.dot2 * other.length2, its = other.dot2 * best.length2;
  const Mask differ = (best.a != other.a) | (best.b != other.b);
  unsure |= (magnitude(mine - its) <= both(kTie) * mine) & differ;
  const Mask better = its > mine;
  best.a = better ? other.a : best.a;
  best.b = better ? other.b : best.b;
  best.dot2 = better ? other.dot2 : best.dot2;
  best.length2 = better ? other.length2 : best.length2;
}

/// The integer steps of the best code, and the lanes in which encode_octahedral(Vec3) decides.
struct Steps {
  Pair a, b;
  Mask unsure;
};

/// Finds the best code by the formulas and candidates of encode_octahedral(Vec3).
inline Steps steps_of(Pair x, Pair y, Pair z) {
  const Pair sum = magnitude(x) + magnitude(y) + magnitude(z);
  const Mask usable = (sum > both(kLeast)) & (sum < both(kMost));
  const Pair divisor = usable ? sum : both(1);
  const Pair nx = (usable ? x : both(1)) / divisor, ny = (usable ? y : both(0)) / divisor,
             nz = (usable ? z : both(0)) / divisor;
  const Mask below = nz < both(0);
  const Pair u = both(kSteps) * (below ? (both(1) - magnitude(ny)) * sign(nx) : nx);
  const Pair v = both(kSteps) * (below ? (both(1) - magnitude(nx)) * sign(ny) : ny);
  const Pair a = floor_of(u), b = floor_of(v);
  const Pair next_a = a < u ? a + both(1) : a, next_b = b < v ? b + both(1) : b;
  Mask unsure = ~usable;
  Candidate best = candidate(a, b, nx, ny, nz);
  keep_better(best, candidate(a, next_b, nx, ny, nz), unsure);
  keep_better(best, candidate(next_a, b, nx, ny, nz), unsure);
  keep_better(best, candidate(next_a, next_b, nx, ny, nz), unsure);
  return {best.a, best.b, unsure};
}

inline Pair load(const double* from, std::size_t count) {
  Pair result = both(0);
  std::memcpy(&result, from, std::min(count, kLanes) * sizeof(double));
  return result;
}

void encode_block(const double* x, const double* y, const double* z, std::size_t count,
                  OctahedralCode* codes) {
  const auto encode = [=](std::size_t i, std::size_t lanes) {
    const Steps steps = steps_of(load(x + i, lanes), load(y + i, lanes), load(z + i, lanes));
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      codes[i + lane] = {static_cast<std::uint8_t>(kMiddle + static_cast<int>(steps.a[lane])),
                         static_cast<std::uint8_t>(kMiddle + static_cast<int>(steps.b[lane]))};
      if (steps.unsure[lane] != 0)
        codes[i + lane] = encode_octahedral(Vec3{x[i + lane], y[i + lane], z[i + lane]});
    }
  };
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) encode(i, kLanes);
  if (i < count) encode(i, count - i);
}

}  // namespace

OctahedralCode encode_octahedral(const Vec3& direction) {
  const double scale = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  if (!(scale > 0) || !std::isfinite(direction.x + direction.y + direction.z)) return {};
  // The squares of very great or small components would overflow or underflow.
  const Vec3 n = unit({direction.x / scale, direction.y / scale, direction.z / scale});
  const double sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  double u = n.x / sum, v = n.y / sum;
  if (n.z < 0) {
    const auto [x, y] = folded(u, v);
    u = x, v = y;
  }
  // The best code is one of those next to u and v, but not always the one that rounding gives.
  u = kSteps * u, v = kSteps * v;
  OctahedralCode best{};
  double greatest = -2;
  for (const double a : {std::floor(u), std::ceil(u)}) {
    for (const double b : {std::floor(v), std::ceil(v)}) {
      const OctahedralCode code{code_of(a / kSteps), code_of(b / kSteps)};
      const double cosine = dot(n, decode_octahedral(code));
      if (cosine > greatest) greatest = cosine, best = code;
    }
  }
  return best;
}

Vec3 decode_octahedral(const OctahedralCode& code) {
  if (code[0] == 0 && code[1] == 0) return {};
  double u = value_of(code[0]), v = value_of(code[1]);
  const double z = 1 - std::abs(u) - std::abs(v);
  if (z < 0) {
    const auto [x, y] = folded(u, v);
    u = x, v = y;
  }
  return unit({u, v, z});
}

void encode_octahedral(std::span<const double> x, std::span<const double> y, std::span<const double> z,
                       std::span<OctahedralCode> codes) {
  ADAMAS_ASSERT(x.size() == codes.size() && y.size() == codes.size() && z.size() == codes.size());
  encode_block(x.data(), y.data(), z.data(), codes.size(), codes.data());
}

void encode_octahedral(std::span<const Gradient> gradients, std::span<OctahedralCode> codes) {
  ADAMAS_ASSERT(gradients.size() == codes.size());
  std::array<double, kBlock> x, y, z;
  for (std::size_t begin = 0; begin < codes.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, codes.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      const Gradient& g = gradients[begin + i];
      x[i] = g[0], y[i] = g[1], z[i] = g[2];
    }
    encode_block(x.data(), y.data(), z.data(), count, codes.data() + begin);
  }
}

}  // namespace adamas::isosurface
