#include "isosurface/view/flight.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>
#include <string_view>

#include "core/base/error.h"

namespace adamas::isosurface {

namespace {

constexpr int kMostFrames = 100'000;

/// Returns the distance of the near plane, a small part of the box's diagonal.
double near_plane(const Box3& box) { return 1e-3 * box.diagonal(); }

/// The number of places on an orbit at which the distance is checked.
constexpr int kMarks = 72;

std::vector<Viewpoint> orbit_at(int frames, double distance, Viewpoint viewpoint, const Box3& box) {
  constexpr double kHeight = 0.45, kStart = -0.7;
  viewpoint.target = 0.5 * (box.min + box.max);
  viewpoint.up = {0, 0, 1};
  std::vector<Viewpoint> result;
  for (int n = 0; n < frames; ++n) {
    const double angle = 2 * std::numbers::pi * n / frames + kStart;
    viewpoint.eye = viewpoint.target + distance * normalized(Vec3{std::cos(angle), std::sin(angle), kHeight});
    result.push_back(viewpoint);
  }
  return result;
}

bool sees_all(const std::vector<Viewpoint>& viewpoints, const Box3& box) {
  const auto corners = box.corners();
  return std::ranges::all_of(viewpoints, [&](const Viewpoint& viewpoint) {
    const View view(viewpoint);
    return std::ranges::all_of(corners, [&](const Vec3& corner) { return view.is_visible({corner, {}}); });
  });
}

void check_frames(bool is_number, int frames, std::string_view text) {
  if (!is_number || frames < 1 || frames > kMostFrames)
    fail("orbit: expected a number of frames from 1 to {}, found '{}'", kMostFrames, text);
}

std::vector<Viewpoint> orbit(int frames, const Viewpoint& first, const Box3& box) {
  check_frames(true, frames, std::to_string(frames));
  // The camera is as near as all of the box is in sight from all places.
  double near = 0, far = 20 * box.diagonal();
  while (far - near > 1e-3 * box.diagonal()) {
    const double middle = 0.5 * (near + far);
    (sees_all(orbit_at(kMarks, middle, first, box), box) ? far : near) = middle;
  }
  constexpr double kBetweenMarks = 1.01;
  return orbit_at(frames, kBetweenMarks * far, first, box);
}

Viewpoint viewpoint_of(std::string_view line, const Viewpoint& first, const std::string& name) {
  std::vector<double> numbers;
  const char* at = line.data();
  const char* const end = at + line.size();
  while (at != end) {
    if (*at == ' ' || *at == '\t' || *at == ',' || *at == '\r') {
      ++at;
      continue;
    }
    double number = 0;
    const auto [next, code] = std::from_chars(at, end, number);
    if (code != std::errc() || !std::isfinite(number))
      fail("{}: expected nine finite numbers, found '{}'", name, line);
    numbers.push_back(number);
    at = next;
  }
  if (numbers.size() != 9) fail("{}: expected nine numbers, found {}", name, numbers.size());
  const CameraPlace place{{numbers[0], numbers[1], numbers[2]},
                          {numbers[3], numbers[4], numbers[5]},
                          {numbers[6], numbers[7], numbers[8]}};
  return viewpoint_at(place, name, first);
}

std::vector<Viewpoint> flight_of_file(const std::string& path, const Viewpoint& first) {
  std::ifstream file(path);
  if (!file) fail("{}: expected a file of viewpoints or orbit:N, found no file that can be read", path);
  return read_viewpoints(file, path, first);
}

}  // namespace

std::vector<Viewpoint> read_viewpoints(std::istream& file, const std::string& name, const Viewpoint& first) {
  std::vector<Viewpoint> result;
  std::string line;
  for (int n = 1; std::getline(file, line); ++n) {
    const std::string_view numbers = std::string_view(line).substr(0, line.find('#'));
    if (numbers.find_first_not_of(" \t\r,") == std::string_view::npos) continue;
    result.push_back(viewpoint_of(numbers, first, fmt::format("{}, line {}", name, n)));
    if (result.size() > kMostFrames) fail("{}: expected at most {} viewpoints", name, kMostFrames);
  }
  if (file.bad()) fail("{}: cannot be read to its end", name);
  if (result.empty()) fail("{}: expected viewpoints, found none", name);
  return result;
}

Viewpoint viewpoint_at(const CameraPlace& place, const std::string& name, const Viewpoint& first) {
  Viewpoint viewpoint = first;
  viewpoint.eye = place.eye;
  viewpoint.target = place.target;
  viewpoint.up = place.up;
  try {
    const View checked(viewpoint);
  } catch (const Error& error) {
    fail("{}: {}", name, error.what());
  }
  return viewpoint;
}

std::vector<Viewpoint> flight(const CameraPath& path, const Box3& box, int width_pixels, int height_pixels) {
  Viewpoint first;
  first.width_pixels = width_pixels;
  first.height_pixels = height_pixels;
  first.near = near_plane(box);
  if (const Orbit* round = std::get_if<Orbit>(&path)) return orbit(round->frames, first, box);
  return flight_of_file(std::get<std::filesystem::path>(path).string(), first);
}

Viewpoint from_everywhere(const Box3& box, int width_pixels, int height_pixels) {
  const double size = std::max(box.diagonal(), std::numeric_limits<double>::min());
  Viewpoint viewpoint;
  viewpoint.target = box.center();
  viewpoint.eye = box.center() + size * Vec3{0.6, -0.64, 0.48};
  viewpoint.up = {0, 0, 1};
  viewpoint.near = 1e-3 * size;
  viewpoint.height = 1.1 * size;
  viewpoint.width_pixels = width_pixels;
  viewpoint.height_pixels = height_pixels;
  return viewpoint;
}

}  // namespace adamas::isosurface

namespace adamas {

CameraPath parse_camera_path(const std::string& text) {
  constexpr std::string_view kOrbit = "orbit:";
  if (!text.starts_with(kOrbit)) return std::filesystem::path(text);
  const std::string_view count = std::string_view(text).substr(kOrbit.size());
  Orbit round;
  const auto [end, code] = std::from_chars(count.data(), count.data() + count.size(), round.frames);
  isosurface::check_frames(code == std::errc() && end == count.data() + count.size(), round.frames, count);
  return round;
}

CameraPlace parse_camera_place(const std::string& name, const std::string& text) {
  std::istringstream lines(text);
  try {
    const isosurface::Viewpoint first = isosurface::read_viewpoints(lines, name, {}).front();
    return {first.eye, first.target, first.up};
  } catch (const Error& error) {
    wrong_usage("{}", error.what());
  }
}

}  // namespace adamas
