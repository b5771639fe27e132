#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/io/mesh_data_reader.h"
#include "core/io/mesh_file.h"
#include "tests/support/hexahedra.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::put_bytes;
using test::says;
using test::Scratch;

std::string header(const char* type, const char* object) {
  return fmt::format("FoamFile\n{{\n version 2.0;\n format ascii;\n class {};\n object {};\n}}\n", type,
                     object);
}

template <class Items, class Text>
std::string list(const Items& items, Text&& text) {
  std::string result = fmt::format("{}\n(\n", items.size());
  for (const auto& item : items) result += text(item) + "\n";
  return result + ")\n";
}

/// Writes a case of a mesh: inner faces first, those of the boundary in one patch.
void write_case(const std::filesystem::path& folder, const PolyhedralMesh& mesh) {
  const std::filesystem::path where = folder / "constant" / "polyMesh";
  std::filesystem::create_directories(where);
  std::filesystem::create_directories(folder / "system");
  put_bytes(folder / "case.foam", "");
  put_bytes(folder / "system" / "controlDict",
            header("dictionary", "controlDict") +
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
  put_bytes(where / "points", header("vectorField", "points") + list(mesh.points(), [](const Vec3& p) {
                                return fmt::format("({:.17g} {:.17g} {:.17g})", p.x, p.y, p.z);
                              }));
  put_bytes(where / "faces", header("faceList", "faces") + list(faces, [&](std::size_t f) {
                               std::string points;
                               for (const auto p : mesh.face(f)) points += fmt::format(" {}", p);
                               return fmt::format("{}({})", mesh.face(f).size(), points.substr(1));
                             }));
  put_bytes(where / "owner", header("labelList", "owner") + list(faces, [&](std::size_t f) {
                               return std::to_string(mesh.cells_of_face(f)[0]);
                             }));
  put_bytes(where / "neighbour", header("labelList", "neighbour") + list(inside, [&](std::size_t f) {
                                   return std::to_string(mesh.cells_of_face(f)[1]);
                                 }));
  put_bytes(where / "boundary",
            header("polyBoundaryMesh", "boundary") +
                fmt::format("1\n(\nwalls\n{{\n type wall;\n nFaces {};\n startFace {};\n}}\n)\n",
                            faces.size() - inner, inner));
}

void write_field(const std::filesystem::path& time, const char* name, const std::vector<double>& values) {
  std::filesystem::create_directories(time);
  put_bytes(time / name, header("volScalarField", name) +
                             "dimensions [0 0 0 0 0 0 0];\ninternalField nonuniform List<scalar>\n" +
                             list(values, [](double v) { return fmt::format("{:.17g}", v); }) +
                             ";\nboundaryField\n{\n walls\n {\n  type zeroGradient;\n }\n}\n");
}

TEST(OpenFoam, ACaseIsReadAtItsLastTime) {
  const Scratch scratch;
  const PolyhedralMesh mesh =
      test::to_mesh(test::make_hexahedra({3, 2, 2}, [](const Vec3& p) { return test::jittered(p, 0.1); }));
  write_case(scratch.folder(), mesh);
  std::vector<double> first, last, pressure;
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    first.push_back(1);
    last.push_back(c < 4 ? 1 : c == 4 ? 0.25 : 0);
    pressure.push_back(100 * mesh.cell_center(c).x);
  }
  write_field(scratch / "0", "alpha.water", first);
  write_field(scratch / "0", "p", pressure);
  write_field(scratch / "0.5", "alpha.water", last);
  write_field(scratch / "0.5", "p", pressure);
  MaterialDataOptions options;
  options.fractions = {{"water", "alpha.water"}};
  options.rest = "air";
  std::vector<std::string> notes;
  options.note = [&](const std::string& text) { notes.push_back(text); };
  const MeshData data = read_mesh_data(scratch / "case.foam", options);
  ASSERT_EQ(data.mesh.cell_count(), mesh.cell_count());
  EXPECT_TRUE(data.mesh.fills_box());
  double wanted = 0.25 * mesh.cell_volume(4);
  for (std::size_t c = 0; c < 4; ++c) wanted += mesh.cell_volume(c);
  EXPECT_NEAR(data.volumes()[MaterialId(0)], wanted, 1e-6);
  ASSERT_EQ(data.fields.size(), 1u);
  EXPECT_EQ(data.fields[0].name, "p");
  for (std::size_t c = 0; c < mesh.cell_count(); ++c)
    EXPECT_NEAR(data.fields[0].values[c], pressure[c], 1e-4);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(says(notes[0], "of 2 times the last one is read, 0.5"));
}

TEST(OpenFoam, ACaseWithoutAMeshIsAnError) {
  const Scratch scratch;
  put_bytes(scratch / "case.foam", "");
  EXPECT_TRUE(says(error_of([&] { read_mesh_data(scratch / "case.foam"); }), "case.foam"));
}

}  // namespace
}  // namespace adamas
