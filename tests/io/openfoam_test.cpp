#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "adamas/series.h"
#include "core/io/mesh_data_reader.h"
#include "core/io/mesh_file.h"
#include "tests/support/foam_case.h"
#include "tests/support/hexahedra.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::put_bytes;
using test::says;
using test::Scratch;
using test::write_foam_case;
using test::write_foam_field;

TEST(OpenFoam, ACaseIsReadAtItsLastTime) {
  const Scratch scratch;
  const PolyhedralMesh mesh =
      test::to_mesh(test::make_hexahedra({3, 2, 2}, [](const Vec3& p) { return test::jittered(p, 0.1); }));
  write_foam_case(scratch.folder(), mesh);
  std::vector<double> first, last, pressure;
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    first.push_back(1);
    last.push_back(c < 4 ? 1 : c == 4 ? 0.25 : 0);
    pressure.push_back(100 * mesh.cell_center(c).x);
  }
  write_foam_field(scratch / "0", "alpha.water", first);
  write_foam_field(scratch / "0", "p", pressure);
  write_foam_field(scratch / "0.5", "alpha.water", last);
  write_foam_field(scratch / "0.5", "p", pressure);
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
  notes.clear();
  options.time = 0;
  EXPECT_NEAR(read_mesh_data(scratch / "case.foam", options).volumes()[MaterialId(0)], 1, 1e-6);
  EXPECT_TRUE(notes.empty());
  options.time = 2;
  EXPECT_TRUE(says(error_of([&] { read_mesh_data(scratch / "case.foam", options); }),
                   "--time: expected a time from 0 to 1, found 2"));
  EXPECT_EQ(mesh_times(scratch / "case.foam"), (std::vector<double>{0, 0.5}));
  const std::vector<SeriesEntry> steps = mesh_steps(scratch / "case.foam");
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[1].time, 0.5);
  EXPECT_TRUE(steps[1].name().ends_with("case.foam: time 1"));
}

TEST(OpenFoam, ACaseWithoutAMeshIsAnError) {
  const Scratch scratch;
  put_bytes(scratch / "case.foam", "");
  EXPECT_TRUE(says(error_of([&] { read_mesh_data(scratch / "case.foam"); }), "case.foam"));
}

}  // namespace
}  // namespace adamas
