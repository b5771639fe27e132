#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/data/polyhedral_mesh.h"
#include "tests/support/scratch.h"

namespace adamas::test {

namespace foam {

inline std::string header(const char* type, const char* object) {
  return fmt::format("FoamFile\n{{\n version 2.0;\n format ascii;\n class {};\n object {};\n}}\n", type,
                     object);
}

template <class Items, class Text>
std::string list(const Items& items, Text&& text) {
  std::string result = fmt::format("{}\n(\n", items.size());
  for (const auto& item : items) result += text(item) + "\n";
  return result + ")\n";
}

}  // namespace foam

/// Writes a case of a mesh: inner faces first, those of the boundary in one patch.
inline void write_foam_case(const std::filesystem::path& folder, const PolyhedralMesh& mesh) {
  const std::filesystem::path where = folder / "constant" / "polyMesh";
  std::filesystem::create_directories(where);
  std::filesystem::create_directories(folder / "system");
  put_bytes(folder / "case.foam", "");
  put_bytes(folder / "system" / "controlDict",
            foam::header("dictionary", "controlDict") +
                "startFrom startTime;\nstartTime 0;\nstopAt endTime;\nendTime 1;\n"
                "deltaT 0.5;\nwriteControl timeStep;\nwriteInterval 1;\n");
  std::vector<std::size_t> faces;
  std::size_t inner = 0;
  for (const bool boundary : {false, true}) {
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      if ((mesh.cells_of_face(f)[1] == PolyhedralMesh::kNone) == boundary) faces.push_back(f);
    }
    if (!boundary) inner = faces.size();
  }
  const std::vector<std::size_t> inside(faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(inner));
  // The owner of a face is the lower of its cells, from which the face points to the other one.
  put_bytes(where / "points",
            foam::header("vectorField", "points") + foam::list(mesh.points(), [](const Vec3& p) {
              return fmt::format("({:.17g} {:.17g} {:.17g})", p.x, p.y, p.z);
            }));
  put_bytes(where / "faces", foam::header("faceList", "faces") + foam::list(faces, [&](std::size_t f) {
                               std::string points;
                               for (const auto p : mesh.face(f)) points += fmt::format(" {}", p);
                               return fmt::format("{}({})", mesh.face(f).size(), points.substr(1));
                             }));
  put_bytes(where / "owner", foam::header("labelList", "owner") + foam::list(faces, [&](std::size_t f) {
                               return std::to_string(mesh.cells_of_face(f)[0]);
                             }));
  put_bytes(where / "neighbour",
            foam::header("labelList", "neighbour") +
                foam::list(inside, [&](std::size_t f) { return std::to_string(mesh.cells_of_face(f)[1]); }));
  put_bytes(where / "boundary",
            foam::header("polyBoundaryMesh", "boundary") +
                fmt::format("1\n(\nwalls\n{{\n type wall;\n nFaces {};\n startFace {};\n}}\n)\n",
                            faces.size() - inner, inner));
}

/// Writes the values of cells at a time of a case.
inline void write_foam_field(const std::filesystem::path& time, const char* name,
                             const std::vector<double>& values) {
  std::filesystem::create_directories(time);
  put_bytes(time / name, foam::header("volScalarField", name) +
                             "dimensions [0 0 0 0 0 0 0];\ninternalField nonuniform List<scalar>\n" +
                             foam::list(values, [](double v) { return fmt::format("{:.17g}", v); }) +
                             ";\nboundaryField\n{\n walls\n {\n  type zeroGradient;\n }\n}\n");
}

}  // namespace adamas::test
