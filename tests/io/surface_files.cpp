#include "tests/io/surface_files.h"

#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <cstring>
#include <sstream>
#include <stdexcept>

#include "tests/support/scratch.h"

namespace adamas::test {

namespace {

Vec3 tuple(vtkDataArray& array, vtkIdType i) {
  return {array.GetComponent(i, 0), array.GetComponent(i, 1), array.GetComponent(i, 2)};
}

void require(bool law, const char* what) {
  if (!law) throw std::runtime_error(what);
}

template <class T>
T take(const std::string& bytes, std::size_t& at) {
  require(at + sizeof(T) <= bytes.size(), "a file that is too short");
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  at += sizeof(T);
  return value;
}

template <class Real>
Vec3 take_vector(const std::string& bytes, std::size_t& at) {
  const double x = take<Real>(bytes, at), y = take<Real>(bytes, at), z = take<Real>(bytes, at);
  return {x, y, z};
}

/// Returns the lines of a header, without comments, up to its last one; `at` becomes the place behind it.
std::vector<std::string> ply_lines(const std::string& bytes, std::size_t& at) {
  std::vector<std::string> lines;
  while (lines.empty() || lines.back() != "end_header") {
    const std::size_t end = bytes.find('\n', at);
    require(end != std::string::npos, "a PLY header without an end");
    const std::string line = bytes.substr(at, end - at);
    at = end + 1;
    if (!line.starts_with("comment ")) lines.push_back(line);
  }
  return lines;
}

}  // namespace

SurfaceFile read_vtp_surface(const std::filesystem::path& path) {
  const vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkPolyData& data = *reader->GetOutput();
  require(reader->GetErrorCode() == 0, "an error of VTK");
  SurfaceFile file;
  TriangleSurface& surface = file.surface;
  for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i) {
    surface.points.push_back(tuple(*data.GetPoints()->GetData(), i));
  }
  file.single = data.GetPoints() == nullptr || data.GetPoints()->GetDataType() == VTK_FLOAT;
  require(data.GetNumberOfCells() == data.GetNumberOfPolys(), "cells that are no polygons");
  const vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < data.GetNumberOfCells(); ++c) {
    data.GetCellPoints(c, corners);
    require(corners->GetNumberOfIds() == 3, "polygons that are no triangles");
    const auto corner = [&corners](vtkIdType k) { return static_cast<std::uint32_t>(corners->GetId(k)); };
    surface.triangles.push_back({corner(0), corner(1), corner(2)});
  }
  if (vtkDataArray* normals = data.GetPointData()->GetNormals()) {
    for (vtkIdType i = 0; i < normals->GetNumberOfTuples(); ++i)
      surface.normals.push_back(tuple(*normals, i));
  }
  if (vtkDataArray* values = data.GetPointData()->GetScalars()) {
    surface.value_name = values->GetName();
    for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i) {
      surface.values.push_back(static_cast<float>(values->GetComponent(i, 0)));
    }
  }
  return file;
}

SurfaceFile read_ply_surface(const std::filesystem::path& path) {
  const std::string bytes = bytes_of(path);
  std::size_t at = 0, line = 0;
  const std::vector<std::string> lines = ply_lines(bytes, at);
  const auto next = [&](const std::string& text) {
    const bool there = lines.at(line) == text;
    line += there ? 1 : 0;
    return there;
  };
  const auto count = [&](const std::string& element) {
    require(lines.at(line).starts_with("element " + element + " "), "no such element");
    return std::stoul(lines[line++].substr(9 + element.size()));
  };
  SurfaceFile file;
  require(next("ply") && next("format binary_little_endian 1.0"), "no PLY");
  const std::size_t points = count("vertex");
  file.single = next("property float x") && next("property float y") && next("property float z");
  if (!file.single) {
    require(next("property double x") && next("property double y") && next("property double z"), "no points");
  }
  const bool normals = next("property float nx") && next("property float ny") && next("property float nz");
  const bool values = next("property float value");
  const std::size_t triangles = count("face");
  require(next("property list uchar uint vertex_indices") && next("end_header"), "other faces");
  for (std::size_t i = 0; i < points; ++i) {
    file.surface.points.push_back(file.single ? take_vector<float>(bytes, at)
                                              : take_vector<double>(bytes, at));
    if (normals) file.surface.normals.push_back(take_vector<float>(bytes, at));
    if (values) file.surface.values.push_back(take<float>(bytes, at));
  }
  for (std::size_t t = 0; t < triangles; ++t) {
    require(take<std::uint8_t>(bytes, at) == 3, "other faces than triangles");
    file.surface.triangles.push_back(take<std::array<std::uint32_t, 3>>(bytes, at));
  }
  require(at == bytes.size(), "more than a surface");
  return file;
}

SurfaceFile read_obj_surface(const std::filesystem::path& path) {
  std::istringstream lines(bytes_of(path));
  SurfaceFile file;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "#") continue;
    if (keyword == "f") {
      std::array<std::uint32_t, 3> corners{};
      for (std::uint32_t& corner : corners) {
        std::string word;
        words >> word;
        const std::size_t slashes = word.find("//");
        corner = static_cast<std::uint32_t>(std::stoul(word.substr(0, slashes))) - 1;
        require(slashes == std::string::npos || std::stoul(word.substr(slashes + 2)) == corner + 1,
                "a normal of another point");
      }
      file.surface.triangles.push_back(corners);
      continue;
    }
    require(keyword == "v" || keyword == "vn", "a line of another kind");
    std::array<std::string, 3> numbers;
    words >> numbers[0] >> numbers[1] >> numbers[2];
    require(!words.fail(), "a line that is too short");
    const Vec3 v{std::stod(numbers[0]), std::stod(numbers[1]), std::stod(numbers[2])};
    (keyword == "v" ? file.surface.points : file.surface.normals).push_back(v);
  }
  return file;
}

}  // namespace adamas::test
