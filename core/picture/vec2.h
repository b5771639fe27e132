#pragma once

#include <cmath>
#include <limits>

namespace adamas::picture {

/// A point or vector of a picture plane.
struct Vec2 {
  double x = 0, y = 0;

  constexpr bool operator==(const Vec2&) const = default;
};

constexpr Vec2 operator+(const Vec2& a, const Vec2& b) { return {a.x + b.x, a.y + b.y}; }
constexpr Vec2 operator-(const Vec2& a, const Vec2& b) { return {a.x - b.x, a.y - b.y}; }
constexpr Vec2 operator*(double s, const Vec2& a) { return {s * a.x, s * a.y}; }
constexpr double dot(const Vec2& a, const Vec2& b) { return a.x * b.x + a.y * b.y; }
constexpr double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }
inline double norm(const Vec2& a) { return std::sqrt(dot(a, a)); }

/// An axis-aligned rectangle; empty when min > max.
struct Box2 {
  Vec2 min{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Vec2 max{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  [[nodiscard]] constexpr bool empty() const { return !(min.x <= max.x && min.y <= max.y); }
  [[nodiscard]] constexpr Vec2 size() const { return max - min; }
  constexpr void extend(const Vec2& p) {
    if (p.x < min.x) min.x = p.x;
    if (p.y < min.y) min.y = p.y;
    if (p.x > max.x) max.x = p.x;
    if (p.y > max.y) max.y = p.y;
  }
};

}  // namespace adamas::picture
