#include "core/picture/rasteriser.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/picture/scan_convex.h"

namespace adamas::picture {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Colour kOutline{0.07, 0.07, 0.09};

// The part of a triangle beyond the camera's near plane, with up to four corners.
struct CutTriangle {
  std::array<Vec3, 4> points;
  std::size_t count = 0;
};

CutTriangle cut_near(const Camera& camera, const std::array<Vec3, 3>& points) {
  CutTriangle result;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = points[i], &b = points[(i + 1) % 3];
    const double da = camera.distance_of(a) - camera.near(), db = camera.distance_of(b) - camera.near();
    if (da >= 0) result.points[result.count++] = a;
    if ((da >= 0) != (db >= 0) && std::isfinite(da))
      result.points[result.count++] = a + (da / (da - db)) * (b - a);
  }
  return result;
}

void blend(Raster& raster, int x, int y, const Colour& colour, double opacity) {
  Raster::Pixel& p = raster.at(x, y);
  const Colour below = p.a == 0 ? Colour{1, 1, 1} : Colour{p.r / 255.0, p.g / 255.0, p.b / 255.0};
  raster.set(x, y, mix(below, colour, opacity));
}

double distance_to_line(const Vec2& p, const Vec2& a, const Vec2& b) {
  const double length = norm(b - a);
  return length > 0 ? std::abs(cross(b - a, p - a)) / length : kInfinity;
}

}  // namespace

Rasteriser::Rasteriser(const Camera& camera, int width, int height)
    : camera_(camera), width_(width), height_(height) {
  if (width < 1 || height < 1 || width > 32767 || height > 32767) {
    fail("picture: expected sides of 1 to 32767 pixels, found {} x {}", width, height);
  }
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  triangle_.assign(pixels, kNone);
  depth_.assign(pixels, kInfinity);
}

void Rasteriser::draw(std::span<const PictureTriangle> triangles, std::span<const CornerNormals> normals) {
  ADAMAS_ASSERT(triangles_.empty() && triangles.size() < kNone);
  ADAMAS_ASSERT(normals.empty() || normals.size() == triangles.size());
  corner_normals_ = normals;
  triangles_ = triangles;
  planes_.resize(triangles.size());
  normals_.resize(triangles.size());
  turned_.resize(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const Vec3& p : triangles[i].points) {
      if (!is_finite(p)) {
        fail("picture: triangle {}: expected finite coordinates, found ({}, {}, {})", i, p.x, p.y, p.z);
      }
    }
    draw_triangle(static_cast<std::uint32_t>(i));
  }
}

void Rasteriser::draw_triangle(std::uint32_t number) {
  const std::array<Vec3, 3>& points = triangles_[number].points;
  const Vec3 normal = normalized(cross(points[1] - points[0], points[2] - points[0]));
  const Vec3 view = camera_.towards((1.0 / 3) * (points[0] + points[1] + points[2]));
  turned_[number] = dot(normal, view) < 0 ? 1 : 0;
  normals_[number] = turned_[number] != 0 ? -normal : normal;

  const CutTriangle cut = cut_near(camera_, points);
  if (cut.count < 3) return;
  std::array<Vec2, 4> corners;
  std::array<double, 4> depths{};
  double least = kInfinity, greatest = -kInfinity;
  for (std::size_t i = 0; i < cut.count; ++i) {
    const Projected p = camera_.project(cut.points[i]);
    corners[i] = p.at, depths[i] = p.depth;
    least = std::min(least, p.depth), greatest = std::max(greatest, p.depth);
  }
  const LinearField field = LinearField::fit({corners.data(), cut.count}, {depths.data(), cut.count});
  const DepthPlane plane{field.origin, field.gradient, field.value};
  planes_[number] = plane;
  scan_convex_polygon({corners.data(), cut.count}, width_, height_, [&](int x, int y) {
    const double depth = std::clamp(plane.at(x + 0.5, y + 0.5), least, greatest);
    const std::size_t pixel = index(x, y);
    if (depth < depth_[pixel]) depth_[pixel] = depth, triangle_[pixel] = number;
  });
}

const Colour& Rasteriser::facing_colour(std::uint32_t triangle) const {
  const PictureTriangle& t = triangles_[triangle];
  return t.back && turned_[triangle] != 0 ? *t.back : t.colour;
}

Rasteriser::SmoothNormal::SmoothNormal(const Rasteriser& rasteriser, std::uint32_t number) {
  const PictureTriangle& triangle = rasteriser.triangles_[number];
  const Vec3& flat = rasteriser.normals_[number];
  normals_ = rasteriser.corner_normals_[number];
  const double side = rasteriser.turned_[number] != 0 ? -1 : 1;
  for (Vec3& normal : normals_) normal = side * normal;
  for (std::size_t i = 0; i < 3; ++i) {
    if (rasteriser.camera_.distance_of(triangle.points[i]) < rasteriser.camera_.near()) {
      normals_[0] = flat;
      return;
    }
    corners_[i] = rasteriser.camera_.project(triangle.points[i]).at;
  }
  area_ = cross(corners_[1] - corners_[0], corners_[2] - corners_[0]);
}

Vec3 Rasteriser::SmoothNormal::at(const Vec2& pixel) const {
  if (!(std::abs(area_) > 0)) return normals_[0];
  const Vec2 way = pixel - corners_[0];
  const double b = std::clamp(cross(way, corners_[2] - corners_[0]) / area_, 0.0, 1.0);
  const double c = std::clamp(cross(corners_[1] - corners_[0], way) / area_, 0.0, 1.0 - b);
  const Vec3 normal = (1 - b - c) * normals_[0] + b * normals_[1] + c * normals_[2];
  return squared_norm(normal) > 0 ? normalized(normal) : normals_[0];
}

Colour Rasteriser::shaded_colour(std::uint32_t number, const Vec3& normal) const {
  const PictureTriangle& triangle = triangles_[number];
  const Vec3 centre = (1.0 / 3) * (triangle.points[0] + triangle.points[1] + triangle.points[2]);
  const double head = std::abs(dot(normal, camera_.towards(centre)));
  // The light is soft and comes from above on the left; surfaces that face away from it are dimmest.
  const Vec3 lamp = normalized(0.8 * camera_.up() - 0.6 * camera_.right() - 0.5 * camera_.forward());
  const double fill = 0.5 + 0.5 * dot(normal, lamp);
  const double light = 0.46 + 0.32 * head + 0.34 * fill * fill;
  const Colour& c = facing_colour(number);
  if (light <= 1) return {light * c.r, light * c.g, light * c.b};
  return mix(c, {1, 1, 1}, std::min(1.0, 3 * (light - 1)));
}

Raster Rasteriser::shade(const RasteriserStyle& style) const {
  Raster raster(width_, height_);
  std::uint32_t last = kNone;
  Colour colour;
  std::optional<SmoothNormal> smooth;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const std::uint32_t number = triangle_at(x, y);
      if (number == kNone) continue;
      if (number != last) {
        last = number;
        if (corner_normals_.empty()) {
          colour = shaded_colour(number, normals_[number]);
        } else {
          smooth.emplace(*this, number);
        }
      }
      if (smooth) colour = shaded_colour(number, smooth->at({x + 0.5, y + 0.5}));
      raster.set(x, y, colour);
    }
  }
  if (style.triangle_edges) draw_edges(raster, style);
  if (style.outlines) draw_outlines(raster, style);
  return raster;
}

void Rasteriser::draw_edges(Raster& raster, const RasteriserStyle& style) const {
  std::uint32_t last = kNone;
  std::array<Vec2, 3> corners;
  bool whole = false;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const std::uint32_t number = triangle_at(x, y);
      if (number == kNone) continue;
      if (number != last) {
        last = number;
        whole = true;
        for (std::size_t i = 0; i < 3; ++i) {
          const Vec3& p = triangles_[number].points[i];
          if (camera_.distance_of(p) < camera_.near())
            whole = false;
          else
            corners[i] = camera_.project(p).at;
        }
      }
      if (!whole) continue;
      const Vec2 p{x + 0.5, y + 0.5};
      const double nearest =
          std::min({distance_to_line(p, corners[0], corners[1]), distance_to_line(p, corners[1], corners[2]),
                    distance_to_line(p, corners[2], corners[0])});
      if (nearest < 0.5 * style.edge_width) blend(raster, x, y, kOutline, 0.4);
    }
  }
}

bool Rasteriser::outline_between(int x, int y, int u, int v, const RasteriserStyle& style,
                                 double least_cosine) const {
  const std::uint32_t a = triangle_at(x, y), b = triangle_at(u, v);
  if (a == b) return false;
  if (a == kNone || b == kNone) return true;
  if (!(facing_colour(a) == facing_colour(b))) return true;
  if (dot(normals_[a], normals_[b]) < least_cosine) return true;
  // The depth has a step if neither triangle's plane, extended, comes near the other's depth.
  const double at_b = camera_.distance_at_depth(depth_at(u, v)),
               at_a = camera_.distance_at_depth(depth_at(x, y));
  const double step = std::min(std::abs(camera_.distance_at_depth(planes_[a].at(u + 0.5, v + 0.5)) - at_b),
                               std::abs(camera_.distance_at_depth(planes_[b].at(x + 0.5, y + 0.5)) - at_a));
  return step > style.depth_jump;
}

void Rasteriser::draw_outlines(Raster& raster, const RasteriserStyle& style) const {
  const double least_cosine = std::cos(style.crease_angle * std::numbers::pi / 180);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const bool right = x + 1 < width_ && outline_between(x, y, x + 1, y, style, least_cosine);
      const bool down = y + 1 < height_ && outline_between(x, y, x, y + 1, style, least_cosine);
      if (!right && !down) continue;
      raster.set(x, y, kOutline);
      if (right) raster.set(x + 1, y, kOutline);
      if (down) raster.set(x, y + 1, kOutline);
    }
  }
}

void Rasteriser::draw_line(Raster& raster, const Vec3& from, const Vec3& to, double width,
                           const Colour& colour) const {
  Vec3 a = from, b = to;
  const double da = camera_.distance_of(a) - camera_.near(), db = camera_.distance_of(b) - camera_.near();
  if (da < 0 && db < 0) return;
  if (da < 0) a = a + (da / (da - db)) * (b - a);
  if (db < 0) b = b + (db / (db - da)) * (a - b);
  const Projected p = camera_.project(a), q = camera_.project(b);
  const Vec2 along = q.at - p.at;
  const double length = norm(along);
  if (!(length > 0)) return;
  const Vec2 side = (0.5 * width / length) * Vec2{-along.y, along.x};
  const std::array<Vec2, 4> quad{p.at + side, q.at + side, q.at - side, p.at - side};
  scan_convex_polygon(quad, width_, height_, [&](int x, int y) {
    const double t = std::clamp(dot(Vec2{x + 0.5, y + 0.5} - p.at, along) / (length * length), 0.0, 1.0);
    const double behind = depth_at(x, y), depth = p.depth + t * (q.depth - p.depth);
    // Lines that lie on a surface are drawn in front of it.
    const bool hidden = behind < kInfinity &&
                        camera_.distance_at_depth(behind) < camera_.distance_at_depth(depth) * (1 - 2e-3);
    if (!hidden) raster.set(x, y, colour);
  });
}

}  // namespace adamas::picture
