#include "core/io/polygon_soup.h"

#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>

#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/reader_program.h"

namespace adamas::io {

template <>
inline constexpr auto kSentMembers<PolygonSoup> =
    std::tuple{&PolygonSoup::points, &PolygonSoup::corners, &PolygonSoup::offsets};

namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;

struct CgalSoup {
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
};

/// Requires a line end after the last number of a text: a number that was cut off would look like another
/// one.
void check_last_line(const std::string& name, const std::string& text) {
  if (std::isspace(static_cast<unsigned char>(text.back())) == 0) {
    fail("{}: expected a line end after the last number, found none", name);
  }
}

/// Checks that the size of a binary file fits its number of triangles, and that the solid of a text file is
/// ended.
void check_stl(const std::string& name, const std::string& content) {
  std::uint32_t triangles = 0;
  if (content.size() >= 84) std::memcpy(&triangles, content.data() + 80, sizeof(triangles));
  if (content.size() == 84 + std::size_t{50} * triangles) return;
  const bool text = content.compare(0, 5, "solid") == 0 && content.find("facet") != std::string::npos;
  if (!text) fail("{}: expected STL of {} triangles, found {} bytes", name, triangles, content.size());
  if (content.find("endsolid") == std::string::npos)
    fail("{}: expected 'endsolid', found the file's end", name);
}

CgalSoup read_with_cgal(const std::string& name, const std::string& extension) {
  CgalSoup soup;
  const std::string content = read_file(name);
  const auto quiet = CGAL::parameters::verbose(false);
  bool whole = false;
  if (extension == ".obj") {
    check_last_line(name, content);
    whole = CGAL::IO::read_OBJ(name, soup.points, soup.polygons, quiet);
  } else if (extension == ".off") {
    if (content.find("BINARY") == std::string::npos) check_last_line(name, content);
    whole = CGAL::IO::read_OFF(name, soup.points, soup.polygons, quiet);
  } else if (extension == ".ply") {
    if (content.compare(0, 3, "ply") != 0) fail("{}: expected PLY, found something else", name);
    if (content.find("format ascii") != std::string::npos) check_last_line(name, content);
    whole = CGAL::IO::read_PLY(name, soup.points, soup.polygons, quiet);
  } else if (extension == ".stl") {
    check_stl(name, content);
    whole = CGAL::IO::read_STL(name, soup.points, soup.polygons, quiet);
  } else {
    fail("{}: expected a surface as .obj, .off, .ply or .stl, found '{}'", name, extension);
  }
  if (!whole)
    fail("{}: expected a whole {} file, found a corrupt or truncated one", name, extension.substr(1));
  return soup;
}

PolygonSoup to_polygon_soup(const std::string& name, const CgalSoup& soup) {
  if (soup.points.size() >= 0xffffffffu) fail("{}: expected fewer than 2^32 points", name);
  PolygonSoup result;
  for (const Point& p : soup.points) result.points.push_back({p.x(), p.y(), p.z()});
  for (const auto& polygon : soup.polygons) {
    for (const std::size_t corner : polygon) {
      result.corners.push_back(static_cast<std::uint32_t>(std::min<std::size_t>(corner, 0xffffffffu)));
    }
    result.offsets.push_back(result.corners.size());
  }
  return result;
}

void check(const std::string& name, const PolygonSoup& soup) {
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    const Vec3& p = soup.points[i];
    if (!is_finite(p)) {
      fail("{}: point {}: expected finite coordinates, found {} {} {}", name, i, p.x, p.y, p.z);
    }
  }
  if (soup.offsets.size() < 2) fail("{}: expected a surface, found no polygon", name);
  for (std::size_t f = 0; f + 1 < soup.offsets.size(); ++f) {
    if (soup.offsets[f + 1] < soup.offsets[f] || soup.offsets[f + 1] > soup.corners.size()) {
      fail("{}: polygon {}: expected ascending offsets", name, f);
    }
    for (std::size_t i = soup.offsets[f]; i < soup.offsets[f + 1]; ++i) {
      if (soup.corners[i] >= soup.points.size()) {
        fail("{}: polygon {}: expected indices below {}, found {}", name, f, soup.points.size(),
             soup.corners[i]);
      }
    }
  }
}

}  // namespace

void send_polygons(const ReaderRequest& request, ByteSink& sink) {
  const std::string& path = request.paths.front();
  sink.put(to_polygon_soup(path, read_with_cgal(path, file_extension(path))));
}

PolygonSoup read_polygon_soup(const std::filesystem::path& path) {
  const auto soup = receive_from_child<PolygonSoup>(request_of(LibraryReader::kPolygons, path));
  check(path.string(), soup);
  return soup;
}

namespace {

struct Point2 {
  double x = 0, y = 0;
};

double turn(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Newell's normal: twice the vector area.
Vec3 vector_area(const std::vector<Vec3>& points, const std::uint32_t* corners, std::size_t count) {
  Vec3 area;
  const Vec3& origin = points[corners[0]];
  for (std::size_t i = 1; i + 1 < count; ++i) {
    area += cross(points[corners[i]] - origin, points[corners[i + 1]] - origin);
  }
  return area;
}

bool is_ear(const std::vector<Point2>& flat, const std::vector<std::size_t>& ring, std::size_t at) {
  const std::size_t n = ring.size();
  const std::size_t before = ring[(at + n - 1) % n], tip = ring[at], after = ring[(at + 1) % n];
  const Point2 &a = flat[before], &b = flat[tip], &c = flat[after];
  if (!(turn(a, b, c) > 0)) return false;
  for (const std::size_t i : ring) {
    if (i == before || i == tip || i == after) continue;
    const Point2& p = flat[i];
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate_polygon(const std::vector<Vec3>& points,
                                                              const std::uint32_t* corners,
                                                              std::size_t count) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  if (count < 3) return triangles;
  if (count == 3) return {{corners[0], corners[1], corners[2]}};
  const Vec3 area = vector_area(points, corners, count);
  // If the axis along which the normal is longest is dropped and the other two are cyclic, the orientation
  // stays.
  int drop = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(area[axis]) > std::abs(area[drop])) drop = axis;
  }
  const int u = (drop + 1) % 3, v = (drop + 2) % 3;
  std::vector<Point2> flat;
  std::vector<std::size_t> ring;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& p = points[corners[i]];
    flat.push_back(area[drop] >= 0 ? Point2{p[u], p[v]} : Point2{p[v], p[u]});
    ring.push_back(i);
  }
  while (ring.size() > 3) {
    const std::size_t n = ring.size();
    std::size_t at = 1;
    for (std::size_t i = 0; i < n; ++i) {
      if (is_ear(flat, ring, (i + 1) % n)) {
        at = (i + 1) % n;
        break;
      }
    }
    triangles.push_back({corners[ring[(at + n - 1) % n]], corners[ring[at]], corners[ring[(at + 1) % n]]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
  }
  triangles.push_back({corners[ring[0]], corners[ring[1]], corners[ring[2]]});
  return triangles;
}

}  // namespace adamas::io
